#include <cstdint>

#include "check_reading.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  check_reading(std::as_bytes(std::span(data, size)));
  return 0;
}
