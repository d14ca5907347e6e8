#include <cstdint>
#include <vector>

#include "check_reading.hpp"

// Each magic number in turn is prepended to the input.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using Bytes = std::vector<std::uint8_t>;
  for (Bytes file :
       {Bytes{0x1F, 0x8B, 8}, Bytes{0xFD, '7', 'z', 'X', 'Z', 0}, Bytes{0x28, 0xB5, 0x2F, 0xFD}}) {
    file.insert(file.end(), data, data + size);
    check_reading(std::as_bytes(std::span(file)));
  }
  return 0;
}
