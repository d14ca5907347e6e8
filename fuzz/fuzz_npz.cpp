#include <cstdint>
#include <string>
#include <vector>

#include "check_reading.hpp"
#include "proofmass/io/numpy/npz_specimens.hpp"

// The input is used as arrays without their magic numbers, separated by the word NEXT, in an
// archive with valid checksums, which the fuzzer would not find.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string rest(reinterpret_cast<const char*>(data), size);
  std::vector<proofmass::io::specimen::ZipMember> members;
  for (const char* name : {"imu/acc.npy", "imu/t.npy", "fs.npy", "more.npy"}) {
    const std::size_t end = rest.find("NEXT");
    members.push_back({name, "\x93NUMPY" + rest.substr(0, end)});
    if (end == std::string::npos) break;
    rest.erase(0, end + 4);
  }
  const std::string file = proofmass::io::specimen::zip(members);
  check_reading(std::as_bytes(std::span(file)));
  return 0;
}
