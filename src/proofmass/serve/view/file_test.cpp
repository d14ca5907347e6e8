#include "proofmass/serve/view/file.hpp"

#include <chrono>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>

#include "proofmass/serve/temporary.hpp"

namespace proofmass::serve::view_file_test {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

TimeBase at_rate(double rate_hz) {
  TimeBase time;
  time.source = TimeSource::given_rate;
  time.rate_hz = rate_hz;
  return time;
}

class ViewFileTest : public testing::Test {
 protected:
  /// Two channels at 100 Hz: a ramp and zeros, with a spike where one is asked for.
  ViewFile view_of(std::size_t samples,
                   std::optional<std::size_t> spike = {},
                   bool stamped = false) {
    Recording recording;
    recording.time = at_rate(100.0);
    recording.channels = {{"x", *parse_unit("m/s^2"), {}}, {"y", *parse_unit("g"), {}}};
    for (std::size_t k = 0; k < samples; ++k) {
      recording.channels[0].values.edit().push_back(static_cast<double>(k));
      recording.channels[1].values.edit().push_back(spike == k ? 1000.0 : 0.0);
      if (stamped)
        recording.time.stamps_s.push_back(0.01 * static_cast<double>(k) +
                                          (k >= samples / 2 ? 50.0 : 0.0));
    }
    return stored(recording);
  }
  ViewFile stored(const Recording& recording) {
    Recording head = recording;
    for (Channel& channel : head.channels) channel.values = {};
    head.time.stamps_s.clear();
    auto writer =
        ViewWriter::create(folder_.path(), head, !recording.time.stamps_s.empty()).value();
    Block all;
    for (const Channel& channel : recording.channels) all.channels.emplace_back(channel.values);
    all.stamps_s = recording.time.stamps_s;
    EXPECT_TRUE(writer.add(all));
    EXPECT_TRUE(writer.finish(head));
    return ViewFile::open(folder_.path()).value();
  }

  TemporaryFolder folder_ = TemporaryFolder::make(testing::TempDir()).value();
};

TEST_F(ViewFileTest, KeepsNamesUnitsAndTimes) {
  const ViewFile view = view_of(1000);
  EXPECT_EQ(view.head().samples, 1000U);
  EXPECT_DOUBLE_EQ(view.head().end_s, 9.99);
  EXPECT_EQ(view.head().channels[1].name, "y");
  EXPECT_EQ(view.head().channels[1].unit, *parse_unit("g"));
}

TEST_F(ViewFileTest, FewSamplesAreShownAsTheyAre) {
  const ViewWindow window = view_of(1000).window({2.0, 2.1}, 100);
  EXPECT_TRUE(window.are_samples);
  // One more on either side, so that the line does not end within the picture.
  EXPECT_EQ(window.time_s.size(), 13U);
  EXPECT_DOUBLE_EQ(window.time_s.front(), 1.99);
  EXPECT_DOUBLE_EQ(window.min[0].back(), 211.0);
}

TEST_F(ViewFileTest, NoSpikeIsLostAtAnyZoom) {
  const std::size_t place = 1'234'567;
  const ViewFile view = view_of(3'000'000, place);
  const double at_s = 0.01 * static_cast<double>(place);
  for (double half_s = 15'000.0; half_s > 0.01; half_s /= 3.0) {
    const ViewWindow window = view.window({at_s - half_s, at_s + half_s * 0.9}, 500);
    const auto& high = window.are_samples ? window.min[1] : window.max[1];
    EXPECT_DOUBLE_EQ(*std::ranges::max_element(high), 1000.0) << half_s;
    EXPECT_LE(window.time_s.size(), 4U * 500U + 8U) << half_s;
  }
}

TEST_F(ViewFileTest, RunsCoverTheStretchWithoutAHole) {
  const ViewWindow window = view_of(100'000).window({100.0, 900.0}, 400);
  ASSERT_FALSE(window.are_samples);
  EXPECT_LE(window.time_s.front(), 100.0);
  for (std::size_t k = 1; k < window.time_s.size(); ++k)
    EXPECT_DOUBLE_EQ(window.min[0][k], window.max[0][k - 1] + 1.0);
  EXPECT_GE(window.max[0].back(), 90'000.0);
}

TEST_F(ViewFileTest, StampsAreFollowedAcrossAGap) {
  const ViewFile view = view_of(1000, {}, true);
  const ViewWindow window = view.window({4.98, 55.02}, 100);
  ASSERT_TRUE(window.are_samples);
  EXPECT_EQ(window.min[0], (std::vector<double>{497, 498, 499, 500, 501, 502, 503}));
  EXPECT_DOUBLE_EQ(window.time_s[3], 55.0);
}

TEST_F(ViewFileTest, AStretchBeyondTheEndIsEmptyOrItsLastSample) {
  const ViewFile view = view_of(1000);
  EXPECT_LE(view.window({100.0, 200.0}, 100).time_s.size(), 1U);
  EXPECT_LE(view.window({-20.0, -10.0}, 100).time_s.size(), 1U);
}

TEST_F(ViewFileTest, FiguresAreOfTheFiniteValues) {
  Recording recording;
  recording.time = at_rate(1.0);
  recording.channels = {{"x", {}, {3.0, nan, 5.0, 7.0}}};
  const ViewFile view = stored(recording);
  const StretchFigures all = view.figures({0.0, 3.0}).front();
  EXPECT_EQ(all.count, 3U);
  EXPECT_DOUBLE_EQ(all.mean, 5.0);
  EXPECT_DOUBLE_EQ(all.std, 2.0);
  EXPECT_DOUBLE_EQ(all.rms, std::sqrt((9.0 + 25.0 + 49.0) / 3.0));
  EXPECT_DOUBLE_EQ(all.min, 3.0);
  EXPECT_DOUBLE_EQ(all.max, 7.0);
  EXPECT_EQ(view.figures({0.5, 1.5}).front().count, 0U);
}

TEST_F(ViewFileTest, CutsOneChannelAndRefusesTooMuch) {
  const ViewFile view = view_of(1000);
  const Recording cut = view.cut({1.0, 2.0}, 1, 1000).value();
  EXPECT_EQ(cut.samples(), 101U);
  EXPECT_EQ(cut.channels.front().name, "y");
  EXPECT_EQ(view.cut({1.0, 2.0}, 1, 100).error().code, Errc::invalid_argument);
  EXPECT_EQ(view.cut({1.0, 1.05}, 1, 100).error().code, Errc::too_few_samples);
  EXPECT_EQ(view.cut({1.0, 2.0}, 2, 100).error().code, Errc::invalid_argument);
}

TEST_F(ViewFileTest, MarksRestsAndTheOutlierWithinOne) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0.0, 0.01);
  Recording recording;
  recording.time = at_rate(100.0);
  for (const char* name : {"ax", "ay", "az"})
    recording.channels.push_back({name, *parse_unit("m/s^2"), {}});
  for (int k = 0; k < 6000; ++k)
    for (std::size_t c = 0; c < 3; ++c) {
      const bool moves = k >= 2000 && k < 3000;
      double value =
          (c == 2 ? 9.81 : 0.0) + noise(random) + (moves ? 3.0 * std::sin(0.05 * k) : 0.0);
      if (k >= 4500 && k < 4503 && c == 0) value += 0.15;
      recording.channels[c].values.edit().push_back(value);
    }
  const ViewFile view = stored(recording);
  const ViewHead& head = view.head();
  ASSERT_EQ(head.rests.size(), 2U) << head.why_no_rests;
  EXPECT_NEAR(head.rests[0].to_s, 20.0, 0.5);
  EXPECT_NEAR(head.rests[1].from_s, 30.0, 0.5);
  ASSERT_EQ(head.outliers_s.size(), 1U);
  EXPECT_NEAR(head.outliers_s[0], 45.01, 0.05);
}

TEST_F(ViewFileTest, AnIncompleteFolderIsNoView) {
  EXPECT_FALSE(ViewFile::open(folder_.path()));
}

}  // namespace
}  // namespace proofmass::serve::view_file_test
