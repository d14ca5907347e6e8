#include <cstdint>
#include <vector>

#include "check_reading.hpp"

// The magic is put before the bytes, so that none of them is spent on finding it.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::vector<std::uint8_t> file{0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n'};
  file.insert(file.end(), data, data + size);
  check_reading(std::as_bytes(std::span(file)));
  return 0;
}
