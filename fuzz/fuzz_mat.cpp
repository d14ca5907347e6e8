#include <cstdint>
#include <string>
#include <zlib.h>

#include "check_reading.hpp"

namespace {

using namespace std::literals;

void check(const std::string& file) {
  check_reading(std::as_bytes(std::span(file)));
}

std::string packed(const std::string& variable) {
  std::string data(compressBound(variable.size()), '\0');
  uLongf size = data.size();
  compress2(reinterpret_cast<Bytef*>(data.data()), &size,
            reinterpret_cast<const Bytef*>(variable.data()), variable.size(), 1);
  data.resize(size);
  std::string tag{15, 0, 0, 0};
  for (int shift = 0; shift < 32; shift += 8) tag += static_cast<char>(size >> shift & 0xFF);
  return tag + data;
}

}  // namespace

// The input is used as a file of version 4, and as variables of version 5 in either byte order,
// also compressed, with a valid checksum, which the fuzzer would not find.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  std::string text = "MATLAB 5.0 MAT-file";
  text.resize(124, ' ');
  check(bytes);
  check(text + "\0\1IM"s + bytes);
  check(text + "\1\0MI"s + bytes);
  check(text + "\0\1IM"s + packed(bytes));
  return 0;
}
