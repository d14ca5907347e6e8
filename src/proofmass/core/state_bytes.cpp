#include "proofmass/core/state_bytes.hpp"

#include <cstring>

namespace proofmass {

void StateBytes::copy(void* value, std::size_t count) {
  if (count == 0) return;
  if (!reading_) {
    written_.append(static_cast<const char*>(value), count);
    return;
  }
  if (failed_ || count > left_.size()) {
    failed_ = true;
    std::memset(value, 0, count);
    return;
  }
  std::memcpy(value, left_.data(), count);
  left_.remove_prefix(count);
}

std::size_t StateBytes::size(std::size_t count, std::size_t least_bytes) {
  std::uint64_t stored = count;
  (*this)(stored);
  if (reading_ && stored > left_.size() / least_bytes) failed_ = true;
  return failed_ ? 0 : static_cast<std::size_t>(stored);
}

}  // namespace proofmass
