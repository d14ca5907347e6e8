#include "proofmass/io/bytes/crc32.hpp"

#include <gtest/gtest.h>
#include <random>
#include <string>
#include <zlib.h>

namespace proofmass::io::crc32_test {
namespace {

TEST(Crc32, OfTheNineDigitsIsThePublishedCheck) {
  EXPECT_EQ(crc32(0, "123456789"), 0xCBF43926u);
}

TEST(Crc32, IsZlibsForEveryLengthAndAlignment) {
  std::mt19937 random(5);
  std::string bytes(3000, '\0');
  for (char& byte : bytes) byte = static_cast<char>(random());
  for (std::size_t start : {0, 1, 7}) {
    for (std::size_t size = 0; size < 1500; ++size) {
      const std::string_view part = std::string_view(bytes).substr(start, size);
      const auto seed = static_cast<std::uint32_t>(size * 2654435761u);
      ASSERT_EQ(crc32(seed, part), ::crc32(seed, reinterpret_cast<const Bytef*>(part.data()),
                                           static_cast<uInt>(part.size())))
          << size;
    }
  }
}

TEST(Crc32, IsCarriedOnOverPieces) {
  const std::string bytes(1000, 'x');
  EXPECT_EQ(
      crc32(crc32(0, std::string_view(bytes).substr(0, 333)), std::string_view(bytes).substr(333)),
      crc32(0, bytes));
}

}  // namespace
}  // namespace proofmass::io::crc32_test
