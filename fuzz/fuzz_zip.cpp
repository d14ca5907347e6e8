#include <cstdint>
#include <vector>

#include "check_reading.hpp"

// Prepends the magic number, which the fuzzer would rarely find.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::vector<std::uint8_t> file{'P', 'K', 3, 4};
  file.insert(file.end(), data, data + size);
  check_reading(std::as_bytes(std::span(file)));
  return 0;
}
