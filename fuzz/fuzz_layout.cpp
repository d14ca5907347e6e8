// The files of an export, stored in a zip archive made here, so that the fuzzer acts on their
// contents and not on the archive. The input is split at zero bytes.
#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "check_reading.hpp"
#include "proofmass/io/archive/zip_specimens.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::array<const char*, 9> names{"Accelerometer.csv",
                                             "meta/time.csv",
                                             "meta/device.csv",
                                             "r_CalInertialAndMag.csv",
                                             "r_DateTime.csv",
                                             "r_Registers.csv",
                                             "Metadata.csv",
                                             "record.properties",
                                             "r.BIN"};
  std::string_view rest(reinterpret_cast<const char*>(data), size);
  std::vector<proofmass::io::specimen::ZipFile> files;
  for (const char* name : names) {
    const std::size_t end = std::min(rest.find('\0'), rest.size());
    if (end > 0) files.push_back({name, std::string(rest.substr(0, end))});
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  const std::string archive = proofmass::io::specimen::zip(files);
  check_reading(std::as_bytes(std::span(archive)));
  return 0;
}
