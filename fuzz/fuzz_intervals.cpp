#include <cstdint>
#include <cstdlib>
#include <span>

#include "proofmass/io/positions/interval_list.hpp"

/// Reads arbitrary bytes as a list of intervals, and checks the guarantees of the result.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto require = [](bool kept) {
    if (!kept) std::abort();
  };
  const auto read = proofmass::io::read_intervals(std::as_bytes(std::span(data, size)), "fuzz");
  if (!read) {
    require(read.error().message.find('\n') == std::string::npos);
    return 0;
  }
  require(!read->empty());
  for (std::size_t i = 0; i < read->size(); ++i) {
    const auto& interval = (*read)[i];
    require(interval.in_samples ? interval.end >= interval.start : interval.end > interval.start);
    require(i == 0 || interval.start >= (*read)[i - 1].end);
    require(interval.line > 0);
  }
  return 0;
}
