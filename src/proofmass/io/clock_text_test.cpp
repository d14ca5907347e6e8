#include "proofmass/io/clock_text.hpp"

#include <gtest/gtest.h>

namespace proofmass::io::clock_text_test {
namespace {

constexpr std::int64_t ns_per_s = 1'000'000'000;

/// Nanoseconds since 1970, of a date with a time.
std::optional<std::int64_t> epoch_ns(std::string_view text) {
  const auto reading = read_clock(text);
  if (!reading || !reading->days || !reading->ns) return std::nullopt;
  return *reading->days * 86'400 * ns_per_s + *reading->ns;
}

// date -u -d @1705479286 is 2024-01-17 08:14:46.
constexpr std::int64_t moment = 1'705'479'286 * ns_per_s;

TEST(ClockText, ReadsIso8601InItsSpellings) {
  for (const char* text : {"2024-01-17T08:14:46Z", "2024-01-17 08:14:46", "2024/01/17 08:14:46",
                           "\"2024-01-17T08:14:46\"", "17.01.2024 08:14:46", "2024-1-17 8:14:46",
                           "2024-01-17 08:14:46 UTC", "2024-01-17T08:14:46+00:00"})
    EXPECT_EQ(epoch_ns(text), moment) << text;
}

TEST(ClockText, KeepsNanosecondsWithPointOrComma) {
  EXPECT_EQ(epoch_ns("2024-01-17T08:14:46.069Z"), moment + 69'000'000);
  EXPECT_EQ(epoch_ns("2024-01-17T08:14:46,000000001"), moment + 1);
  EXPECT_EQ(epoch_ns("2024-01-17T08:14:46.0000000019"), moment + 1);
}

TEST(ClockText, TakesTheZoneOff) {
  EXPECT_EQ(epoch_ns("2024-01-17 10:14:46 UTC+02:00"), moment);
  EXPECT_EQ(epoch_ns("2024-01-17T02:44:46-0530"), moment);
  EXPECT_TRUE(read_clock("2024-01-17T08:14:46Z")->zone_given);
  EXPECT_FALSE(read_clock("2024-01-17T08:14:46")->zone_given);
}

TEST(ClockText, ReadsDateAndTimeOfDayAlone) {
  EXPECT_FALSE(read_clock("2024-01-17")->ns.has_value());
  EXPECT_EQ(read_clock("2024-01-17")->days, 19'739);
  EXPECT_FALSE(read_clock("08:14")->days.has_value());
  EXPECT_EQ(read_clock("00:01:02.5")->ns, 62'500'000'000);
}

TEST(ClockText, RefusesWhatIsNoTime) {
  for (const char* text : {"", "12", "1.5", "2024-13-01", "2023-02-29", "25:61", "1:2:3", "abc",
                           "2024-01-17T08:14:46 noon", "99:00:00", "12:30:61", "-08:14"})
    EXPECT_FALSE(read_clock(text).has_value()) << text;
}

}  // namespace
}  // namespace proofmass::io::clock_text_test
