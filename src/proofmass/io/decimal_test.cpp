#include "proofmass/io/decimal.hpp"

#include <bit>
#include <charconv>
#include <cmath>
#include <fast_float/fast_float.h>
#include <gtest/gtest.h>
#include <optional>
#include <random>
#include <string>

namespace proofmass::io::decimal_test {
namespace {

/// The value from the row loop's parser, or nullopt if that leaves the text to the slow path.
std::optional<double> scanned(std::string text, std::size_t* used = nullptr) {
  const std::size_t size = text.size();
  text += ',';
  text.append(decimal_padding, '\0');
  Decimal decimal;
  const char* end = scan_decimal(text.data(), '.', decimal);
  if (end == nullptr) return std::nullopt;
  if (used != nullptr) *used = static_cast<std::size_t>(end - text.data());
  EXPECT_LE(static_cast<std::size_t>(end - text.data()), size);
  double value = 0.0;
  return to_double_exactly(decimal, value) ? value : to_double(decimal);
}

double reference(const std::string& text) {
  const std::size_t plus = text.starts_with('+') ? 1 : 0;
  double value = 0.0;
  fast_float::from_chars(text.data() + plus, text.data() + text.size(), value);
  return value;
}

void expect_same_bits(const std::string& text) {
  const auto value = scanned(text);
  ASSERT_TRUE(value.has_value()) << text;
  EXPECT_EQ(std::bit_cast<std::uint64_t>(*value), std::bit_cast<std::uint64_t>(reference(text)))
      << text;
}

TEST(Decimal, IsTheNearestDoubleForWhatPeopleLog) {
  for (const char* text : {"0",
                           "-0",
                           "0.0",
                           "-0.00666",
                           "9.660994529724121",
                           "1e5",
                           "1.75E-1",
                           "+3.5",
                           ".5",
                           "5.",
                           "2167082953",
                           "0.0000000000000000000012345",
                           "123456789012345678",
                           "1.7976931348623157e308",
                           "2e308",
                           "4.9e-324",
                           "1e-400",
                           "3e34",
                           "1.401298464324817e-45",
                           "9007199254740993",
                           "10.332114257812501",
                           "0.30000000000000004"})
    expect_same_bits(text);
}

TEST(Decimal, IsTheNearestDoubleForRandomDoublesInEverySpelling) {
  std::mt19937_64 random(20100401);
  for (int i = 0; i < 200'000; ++i) {
    const double value = std::bit_cast<double>(random());
    if (!std::isfinite(value)) continue;
    std::array<char, 64> text;
    const auto end = i % 2 == 0 ? std::to_chars(text.data(), text.data() + text.size(), value)
                                : std::to_chars(text.data(), text.data() + text.size(), value,
                                                std::chars_format::scientific, i % 17);
    const std::string figure(text.data(), end.ptr);
    const bool fits = std::abs(value) < 1e19 || figure.find('e') != std::string::npos;
    if (end.ec == std::errc{} && fits) expect_same_bits(figure);
  }
}

TEST(Decimal, IsTheNearestDoubleForRandomDigits) {
  std::mt19937_64 random(7);
  const auto up_to = [&](unsigned most) { return static_cast<int>(random() % (most + 1)); };
  for (int i = 0; i < 200'000; ++i) {
    std::string text = up_to(1) != 0 ? "-" : "";
    const int whole = up_to(9);
    const int decimals = up_to(10);
    for (int d = 0; d < whole; ++d) text += static_cast<char>('0' + up_to(9));
    if (decimals > 0 || whole == 0) text += '.';
    for (int d = 0; d < decimals + (whole == 0 ? 1 : 0); ++d)
      text += static_cast<char>('0' + up_to(9));
    if (up_to(3) == 0) text += "e" + std::to_string(up_to(640) - 320);
    expect_same_bits(text);
  }
}

TEST(Decimal, LeavesWhatItCannotHoldToOthers) {
  EXPECT_FALSE(scanned("12345678901234567890"));  // 20 digits
  EXPECT_FALSE(scanned(""));
  EXPECT_FALSE(scanned("-"));
  EXPECT_FALSE(scanned("."));
  EXPECT_FALSE(scanned("nan"));
  EXPECT_FALSE(scanned("1e"));
  EXPECT_FALSE(scanned("1e+"));
}

TEST(Decimal, StopsBehindTheNumber) {
  std::size_t used = 0;
  EXPECT_EQ(scanned("0x10", &used), 0.0);
  EXPECT_EQ(used, 1u);
  EXPECT_EQ(scanned("12345678 9", &used), 12345678.0);
  EXPECT_EQ(used, 8u);
}

TEST(Decimal, CountsDigitsWithoutLeadingZeros) {
  expect_same_bits("0.00041418756618863384");
  expect_same_bits("000000000000000000000000001.5");
}

}  // namespace
}  // namespace proofmass::io::decimal_test
