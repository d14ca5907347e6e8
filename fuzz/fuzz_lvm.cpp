#include <cstdint>
#include <string>

#include "check_reading.hpp"

// The first words are put before the bytes, so that none of them is spent on finding them.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string file =
      "LabVIEW Measurement" + std::string(reinterpret_cast<const char*>(data), size);
  check_reading(std::as_bytes(std::span(file)));
  return 0;
}
