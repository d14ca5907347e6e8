#include <cstdint>
#include <string>

#include "check_reading.hpp"

// The bytes follow a whole sentence, so that they are read as a log.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string file = "$GPGGA,123519,4807.038,N,01131.000,E,1,08,0.9,545.4,M,46.9,M,,*47\r\n" +
                           std::string(reinterpret_cast<const char*>(data), size);
  check_reading(std::as_bytes(std::span(file)));
  return 0;
}
