#include <bit>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <limits>
#include <random>

#include "proofmass/io/test_support.hpp"
#include "proofmass/io/write_recording.hpp"

namespace proofmass::io::round_trip_test {
namespace {

/// A temporary folder, removed after the test.
class RoundTrip : public testing::Test {
 public:
  ~RoundTrip() override { std::filesystem::remove_all(folder_); }

 protected:
  RoundTrip() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() / ("proofmass_" + std::string(test->name()));
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directory(folder_);
  }

  [[nodiscard]] std::string path(const std::string& name) const { return folder_ / name; }

  Result<Recording> through(const Recording& recording, const std::string& name) const {
    if (const Status written = write_recording(recording, path(name)); !written)
      return written.error();
    return read_recording(path(name), {});
  }

 private:
  std::filesystem::path folder_;
};

void expect_same_bits(View<double> a, View<double> b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    if (std::isnan(a[k]) && std::isnan(b[k])) continue;
    ASSERT_EQ(std::bit_cast<std::uint64_t>(a[k]), std::bit_cast<std::uint64_t>(b[k]))
        << "sample " << k << ": " << a[k] << " and " << b[k];
  }
}

void expect_same_times(const Recording& a, const Recording& b) {
  ASSERT_EQ(a.samples(), b.samples());
  for (std::size_t k = 0; k < a.samples(); ++k) ASSERT_EQ(a.time.at(k), b.time.at(k)) << k;
}

/// Random doubles of every magnitude with faults of every kind, on a clock with jitter.
Recording troubled(std::optional<std::int64_t> start_ns) {
  std::mt19937_64 random(11);
  Recording recording;
  recording.time = {TimeSource::stamps, "t", 100.0, {}, start_ns};
  for (const char* name : {"acc_x", "acc_y", "odd, name"})
    recording.channels.push_back({name, *parse_unit("m/s^2"), {}});
  std::uniform_real_distribution<double> jitter(0.0, 0.004);
  for (int k = 0; k < 3000; ++k) {
    recording.time.stamps_s.push_back(k == 0 ? 0.0 : 0.01 * k + jitter(random));
    for (Channel& channel : recording.channels)
      channel.values.edit().push_back(std::bit_cast<double>(random()));
  }
  recording.channels[0].values.edit()[5] = std::numeric_limits<double>::quiet_NaN();
  recording.channels[0].values.edit()[6] = -std::numeric_limits<double>::infinity();
  recording.channels[0].values.edit()[7] = 5e-324;
  recording.channels[0].values.edit()[8] = -0.0;
  recording.channels[0].values.edit()[9] = 3e34;
  return recording;
}

TEST_F(RoundTrip, CsvKeepsEveryBit) {
  for (const auto start_ns :
       {std::optional<std::int64_t>{}, std::optional<std::int64_t>{1'705'479'286'000'000'123},
        std::optional<std::int64_t>{2'167'082'953'000}}) {
    const Recording recording = troubled(start_ns);
    for (const char* name : {"a.csv", "a.csv.gz"}) {
      const auto back = through(recording, name);
      ASSERT_TRUE(back.has_value()) << back.error().message;
      ASSERT_EQ(back->channels.size(), 3u);
      for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_EQ(back->channels[c].name, recording.channels[c].name);
        EXPECT_EQ(back->channels[c].unit, recording.channels[c].unit);
        expect_same_bits(recording.channels[c].values, back->channels[c].values);
      }
      expect_same_times(recording, *back);
      EXPECT_EQ(back->time.start_ns.value_or(0), start_ns.value_or(0));
    }
  }
}

TEST_F(RoundTrip, AUniformBaseStaysUniform) {
  for (const double rate_hz : {200.0, 120.005, 1000.0, 204.8, 100.0 / 3.0}) {
    Recording recording;
    recording.time = {TimeSource::given_rate, "", rate_hz, {}, {}};
    recording.channels.push_back({"a", *parse_unit("V"), {}});
    for (int k = 0; k < 500; ++k) recording.channels[0].values.edit().push_back(std::sin(k));
    for (const char* name : {"u.csv", "u.npy"}) {
      const auto back = through(recording, name);
      ASSERT_TRUE(back.has_value()) << back.error().message;
      expect_same_times(recording, *back);
      EXPECT_TRUE(back->time.is_uniform()) << rate_hz << " " << name;
    }
  }
}

TEST_F(RoundTrip, NpyKeepsEveryBit) {
  const Recording recording = troubled({});
  const auto back = through(recording, "a.npy");
  ASSERT_TRUE(back.has_value()) << back.error().message;
  ASSERT_EQ(back->channels.size(), 3u);
  for (std::size_t c = 0; c < 3; ++c)
    expect_same_bits(recording.channels[c].values, back->channels[c].values);
  expect_same_times(recording, *back);
}

TEST_F(RoundTrip, CsvBeginsWithTimeAndUnits) {
  Recording recording;
  recording.time = {TimeSource::stamps, "t", 10.0, {0.0, 0.125}, 2'167'082'953'000};
  recording.channels.push_back({"acc_x", *parse_unit("g"), {1.5, std::nan("")}});
  recording.channels.push_back({"note", {}, {-0.0, 1e-7}});
  ASSERT_TRUE(write_recording(recording, path("a.csv")).has_value());
  std::ifstream file(path("a.csv"));
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}),
            "time (s),acc_x (g),note\n2167.082953,1.5,-0\n2167.207953,nan,1e-07\n");
}

TEST_F(RoundTrip, CsvKeepsLabels) {
  for (const bool timed : {true, false}) {
    Recording recording;
    if (timed) recording.time = {TimeSource::given_rate, "", 100.0, {}, {}};
    recording.channels.push_back({"a", *parse_unit("g"), std::vector<double>(3000, 1.5)});
    recording.labels = {{"#1", 5, 7}, {"x, up", 8, 8}, {"it's", 700, 2000}, {"x, up", 2998, 2999}};
    recording.label_channel = "part; of";
    for (const char* name : {"l.csv", "l.csv.gz"}) {
      const auto back = through(recording, name);
      ASSERT_TRUE(back.has_value()) << back.error().message;
      EXPECT_EQ(back->labels, recording.labels);
      EXPECT_EQ(back->label_channel, recording.label_channel);
      ASSERT_EQ(back->channels.size(), 1u);
      EXPECT_EQ(back->channels[0].values, recording.channels[0].values);
      EXPECT_EQ(back->time.source, timed ? TimeSource::stamps : TimeSource::none);
    }
  }
}

TEST_F(RoundTrip, RefusesWhatItCannotWrite) {
  const Recording recording = troubled({});
  EXPECT_EQ(write_recording(recording, path("a.wav")).error().code, Errc::unsupported);
  EXPECT_EQ(write_recording(recording, path("no/such/folder.csv")).error().code, Errc::unwritable);
  EXPECT_EQ(write_recording({}, path("a.csv")).error().code, Errc::too_few_samples);
}

TEST_F(RoundTrip, CsvNeedsNoTimeColumn) {
  Recording recording;
  recording.channels.push_back({"acc_x", *parse_unit("g"), {1.5, 2.5, 1.0}});
  for (const char* name : {"n.csv", "n.npy"}) {
    const auto back = through(recording, name);
    ASSERT_TRUE(back.has_value());
    ASSERT_EQ(back->channels.size(), 1u);
    EXPECT_EQ(back->time.source, TimeSource::none);
    EXPECT_EQ(back->channels[0].values, recording.channels[0].values);
  }
}

}  // namespace
}  // namespace proofmass::io::round_trip_test
