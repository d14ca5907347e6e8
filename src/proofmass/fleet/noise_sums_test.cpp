#include "proofmass/fleet/noise_sums.hpp"

#include <gtest/gtest.h>

#include "proofmass/core/state_bytes.hpp"

namespace proofmass::fleet::noise_sums_test {
namespace {

RecordingSums recording(const std::string& file, double start_s, std::size_t samples) {
  RecordingSums sums;
  sums.key = "0123456789abcdef";
  sums.sha256 = std::string(64, 'a');
  sums.file = file;
  sums.bytes = 1234;
  sums.options = "--statistic oadev --taus 16-per-decade";
  sums.rate_hz = 10.0;
  sums.clock_s = start_s;
  sums.samples = samples;
  sums.channels.push_back({.name = "acc_z",
                           .unit = *parse_unit("m/s^2"),
                           .refused = {},
                           .lsb = 0.01,
                           .first_valid = 3,
                           .sums = std::string("\0\1\2 sums", 8)});
  sums.channels.push_back({.name = "acc_x",
                           .unit = *parse_unit("m/s^2"),
                           .refused = "clipped",
                           .lsb = {},
                           .first_valid = {},
                           .sums = {}});
  sums.notes.push_back({Severity::warning, file + ": 3 gaps"});
  return sums;
}

TEST(NoiseSums, AreReadAsTheyWereWritten) {
  RecordingSums written = recording("h00.csv", 5.5, 300);
  written.place = SumsPlace{.first = 7, .digits = 27, .origins = {3, 0}};
  const std::string text = text_of(written);
  EXPECT_TRUE(is_sums(text));
  const RecordingSums read = sums_of_text(text).value();
  EXPECT_EQ(read.key, written.key);
  EXPECT_EQ(read.sha256, written.sha256);
  ASSERT_TRUE(read.place);
  EXPECT_EQ(read.place->word(), "7:27:3,0");
  EXPECT_EQ(read.file, "h00.csv");
  EXPECT_EQ(read.bytes, 1234U);
  EXPECT_EQ(read.options, written.options);
  EXPECT_EQ(read.rate_hz, 10.0);
  EXPECT_EQ(read.clock_s, 5.5);
  EXPECT_EQ(read.samples, 300U);
  ASSERT_EQ(read.channels.size(), 2U);
  EXPECT_EQ(read.channels[0].unit, written.channels[0].unit);
  EXPECT_EQ(read.channels[0].lsb, 0.01);
  EXPECT_EQ(read.channels[0].first_valid, 3U);
  EXPECT_EQ(read.channels[0].sums, written.channels[0].sums);
  EXPECT_EQ(read.channels[1].refused, "clipped");
  EXPECT_FALSE(read.channels[1].first_valid);
  ASSERT_EQ(read.notes.size(), 1U);
  EXPECT_EQ(read.notes[0].severity, Severity::warning);
  EXPECT_EQ(read.notes[0].text, "h00.csv: 3 gaps");
}

TEST(NoiseSums, AreRefusedWhereverTheyAreCutOff) {
  const std::string text = text_of(recording("h00.csv", 0.0, 300));
  for (std::size_t length = 0; length < text.size(); ++length) {
    const auto read = sums_of_text(std::string_view(text).substr(0, length));
    ASSERT_FALSE(read) << length;
    EXPECT_EQ(read.error().code, Errc::corrupt);
    EXPECT_EQ(read.error().message.find('\n'), std::string::npos);
  }
  EXPECT_FALSE(sums_of_text(text + "\n"));
}

TEST(NoiseSums, AreRefusedWithAnyByteChanged) {
  const std::string text = text_of(recording("h00.csv", 0.0, 300));
  for (std::size_t at = 0; at < text.size(); ++at)
    for (const char change : {'\1', '\x20', '\x80'}) {
      std::string changed = text;
      changed[at] = static_cast<char>(changed[at] ^ change);
      EXPECT_FALSE(sums_of_text(changed)) << at;
    }
}

TEST(NoiseSums, APlaceIsAWord) {
  EXPECT_EQ((SumsPlace{.as_samples = true, .first = 12, .origins = {}}).word(), "samples:12");
  EXPECT_EQ(SumsPlace::parse("samples:12")->first, 12U);
  EXPECT_EQ(SumsPlace::parse("12:21:0,5,7")->origins, (std::vector<std::size_t>{0, 5, 7}));
  for (const char* none : {"", "none", "12", "12:21", "12:0:1", "12:99:1", "-1:21:0", "1:21:a",
                           "samples:", "1:21:", "99999999999999999:21:0"})
    EXPECT_FALSE(SumsPlace::parse(none)) << none;
}

std::vector<std::size_t> firsts_of(const std::vector<SumsPlace>& places) {
  std::vector<std::size_t> firsts;
  for (const SumsPlace& place : places) firsts.push_back(place.first);
  return firsts;
}

TEST(PlacesOfRecordings, LieOnTheGridOfTheFirst) {
  // The third starts as its clock says, 2 s after the end of the second; a clock known to the
  // second only puts the second one before the end of the first.
  const std::vector<RecordingSums> parts{recording("a", 100.0, 300), recording("b", 129.6, 300),
                                         recording("c", 162.0, 100)};
  const auto places = places_of(parts, {}).value();
  EXPECT_EQ(firsts_of(places), (std::vector<std::size_t>{0, 300, 620}));
  EXPECT_TRUE(places[0].as_samples);
}

TEST(PlacesOfRecordings, OneThatIsMissingIsAGap) {
  std::vector<RecordingSums> parts{recording("a", 0.0, 500'000), recording("b", 50'000.0, 500'000),
                                   recording("c", 100'000.0, 500'000)};
  EXPECT_EQ(firsts_of(places_of(parts, {}).value()),
            (std::vector<std::size_t>{0, 500'000, 1'000'000}));
  parts.erase(parts.begin() + 1);
  const auto places = places_of(parts, {}).value();
  EXPECT_EQ(firsts_of(places), (std::vector<std::size_t>{0, 1'000'000}));
  EXPECT_FALSE(places[0].as_samples);
  EXPECT_EQ(places[0].digits, 21U);
  EXPECT_EQ(places[1].origins, (std::vector<std::size_t>{3, 0}));
}

TEST(PlacesOfRecordings, ByGivenStartsWhereTheFilesBeginAtZero) {
  const std::vector<RecordingSums> parts{recording("a", 0.0, 300), recording("b", 0.0, 300)};
  EXPECT_EQ(firsts_of(places_of(parts, {1000.0, 1031.0}).value()),
            (std::vector<std::size_t>{0, 310}));
  // A clock that agrees with a rounded date is more precise.
  const std::vector<RecordingSums> clocked{recording("a", 7.0, 300), recording("b", 37.4, 300)};
  EXPECT_EQ(firsts_of(places_of(clocked, {1000.0, 1031.0}).value()),
            (std::vector<std::size_t>{0, 304}));
}

TEST(PlacesOfRecordings, CountAGapOfWeeksAsLongAsAllOfThem) {
  const std::vector<RecordingSums> parts{recording("a", 0.0, 300), recording("b", 6e5, 200)};
  EXPECT_EQ(firsts_of(places_of(parts, {}).value()), (std::vector<std::size_t>{0, 800}));
}

void expect_refused(const std::vector<RecordingSums>& parts, const std::string& why) {
  const auto places = places_of(parts, {});
  ASSERT_FALSE(places) << why;
  EXPECT_EQ(places.error().code, Errc::invalid_argument);
  EXPECT_NE(places.error().message.find(why), std::string::npos) << places.error().message;
}

TEST(PlacesOfRecordings, AreNoneOfWhatDoesNotFitTogether) {
  const RecordingSums first = recording("a", 0.0, 300);
  RecordingSums other = recording("b", 30.0, 300);
  expect_refused({other, first}, "a: --as-one: starts 60 s before the end");
  RecordingSums fast = other;
  fast.rate_hz = 50.0;
  expect_refused({first, fast}, "b: --as-one: it has 50 Hz, a has 10 Hz");
  RecordingSums renamed = other;
  renamed.channels[0].name = "acc_y";
  expect_refused({first, renamed}, "b: --as-one: it has no channel acc_z, which a has");
  RecordingSums in_volts = other;
  in_volts.channels[1].unit = *parse_unit("V");
  expect_refused({first, in_volts}, "b: --as-one: acc_x is in V, in a in m/s^2");
  RecordingSums without_clock = other;
  without_clock.clock_s.reset();
  expect_refused({first, without_clock}, "it has no clock");
}

}  // namespace
}  // namespace proofmass::fleet::noise_sums_test
