#include <cstdint>
#include <string>

#include "check_reading.hpp"

// Prepends the file's first words, which the fuzzer would rarely find.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string file =
      "LabVIEW Measurement" + std::string(reinterpret_cast<const char*>(data), size);
  check_reading(std::as_bytes(std::span(file)));
  return 0;
}
