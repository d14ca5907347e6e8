#include <cstdint>
#include <string>

#include "check_reading.hpp"

// The input is used as the chunks of a file, in either byte order and with 64-bit lengths.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  for (const char* form : {"RIFF", "RIFX", "RF64"}) {
    const std::string file =
        form + std::string("sizeWAVE") + std::string(reinterpret_cast<const char*>(data), size);
    check_reading(std::as_bytes(std::span(file)));
  }
  return 0;
}
