#include "proofmass/signal/audit/subsample.hpp"

#include <algorithm>
#include <cstdint>

namespace proofmass::signal {
namespace {

// SplitMix64: G. L. Steele, D. Lea, C. H. Flood, Fast splittable pseudorandom number generators,
// OOPSLA (2014).
std::uint64_t hash(std::uint64_t place, std::uint64_t level) {
  std::uint64_t z = (place + (level << 56) + 1) * 0x9e3779b97f4a7c15;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
  z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
  return z ^ (z >> 31);
}

}  // namespace

void Subsample::add(View<double> values) {
  const std::size_t end = seen_ + values.size();
  while (next_ < end) {
    if (level_ == 0) {
      const View<double> taken =
          values.subspan(next_ - seen_, std::min(end - next_, capacity_ - kept_.size()));
      kept_.insert(kept_.end(), taken.begin(), taken.end());
    } else {
      kept_.push_back(values[next_ - seen_]);
    }
    if (kept_.size() == capacity_) halve();
    const std::size_t window = kept_.size();
    const std::size_t mask = (std::size_t{1} << level_) - 1;
    next_ = (window << level_) + (hash(window, level_) & mask);
  }
  seen_ = end;
}

void Subsample::append(const Subsample& part) {
  Subsample other = part;
  while (level_ < other.level_) halve();
  while (other.level_ < level_) other.halve();
  kept_.insert(kept_.end(), other.kept_.begin(), other.kept_.end());
  while (kept_.size() >= capacity_) halve();
  seen_ += other.seen_;
  next_ = std::max(seen_, kept_.size() << level_);
}

void Subsample::exchange(StateBytes& bytes, std::size_t most) {
  while (!bytes.reading() && kept_.size() > most) halve();
  bytes(kept_);
  bytes(seen_);
  bytes(level_);
  constexpr unsigned highest_level = 40;
  if (kept_.size() > most || kept_.size() > seen_ || level_ > highest_level) bytes.fail();
  next_ = std::max(seen_, kept_.size() << std::min(level_, highest_level));
}

void Subsample::halve() {
  for (std::size_t k = 0; k < kept_.size() / 2; ++k)
    kept_[k] = kept_[2 * k + (hash(k, level_) >> 63)];
  kept_.resize(kept_.size() / 2);
  ++level_;
}

}  // namespace proofmass::signal
