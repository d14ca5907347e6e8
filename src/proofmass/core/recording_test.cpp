#include "proofmass/core/recording.hpp"

#include <cmath>
#include <gtest/gtest.h>

#include "proofmass/core/repeated_rows.hpp"

namespace proofmass::recording_test {
namespace {

Recording with_channels(const std::vector<std::string>& names, std::string_view unit) {
  Recording recording;
  for (const std::string& name : names)
    recording.channels.push_back({name, parse_unit(unit).value(), {0.0, 1.0, 2.0, 3.0}});
  recording.time = {.source = TimeSource::given_rate,
                    .channel = "",
                    .rate_hz = 10.0,
                    .stamps_s = {},
                    .start_ns = 0};
  return recording;
}

TEST(AccelerometerTriads, AreFoundByName) {
  for (const auto& names : {std::vector<std::string>{"Acc_X", "Acc_Y", "Acc_Z"},
                            {"ax", "ay", "az"},
                            {"Accelerometer X", "Accelerometer Y", "Accelerometer Z"},
                            {"acc_x_g", "acc_y_g", "acc_z_g"},
                            {"x", "y", "z"}}) {
    const auto triads = accelerometer_triads(with_channels(names, "g"));
    ASSERT_EQ(triads.size(), 1U) << names[0];
    EXPECT_EQ(triads[0].x, 0U);
    EXPECT_EQ(triads[0].y, 1U);
    EXPECT_EQ(triads[0].z, 2U);
  }
}

TEST(AccelerometerTriads, OfTwoSensorsStayApart) {
  for (const auto& names : {std::vector<std::string>{"x1", "y1", "x2", "y2"},
                            {"acc1_x", "acc1_y", "acc2_x", "acc2_y"},
                            {"ax1", "ay1", "ax2", "ay2"}}) {
    const auto triads = accelerometer_triads(with_channels(names, "m/s^2"));
    ASSERT_EQ(triads.size(), 2U) << names[0];
    EXPECT_EQ(triads[1].x, 2U);
    EXPECT_EQ(triads[1].y, 3U);
    EXPECT_FALSE(triads[1].z);
  }
}

TEST(AccelerometerTriads, LeaveOtherQuantitiesOut) {
  Recording recording = with_channels({"Acc_X", "Acc_Y", "Acc_Z"}, "m/s^2");
  recording.channels.push_back({"Gyr_X", parse_unit("deg/s").value(), {0, 0, 0, 0}});
  EXPECT_EQ(accelerometer_triads(recording).size(), 1U);
}

TEST(Cut, KeepsTheLabelsOfTheWindow) {
  Recording recording = with_channels({"x"}, "g");
  recording.labels = {{"before", 0, 0}, {"into", 1, 1}, {"out of", 2, 3}};
  recording.label_channel = "part";
  const Recording part = cut(recording, 0.1, 0.3).value();
  EXPECT_EQ(part.label_channel, "part");
  EXPECT_EQ(part.labels, (std::vector<Label>{{"into", 0, 0}, {"out of", 1, 1}}));
}

TEST(Cut, CountsLabelsByTheSamplesThatAreKept) {
  Recording recording = with_channels({"x"}, "g");
  recording.time.stamps_s = {0.0, 5.0, 0.2, 0.3};  // an outlying stamp, outside the window
  recording.labels = {{"a", 0, 2}, {"b", 3, 3}};
  const Recording part = cut(recording, 0.0, 1.0).value();
  EXPECT_EQ(part.labels, (std::vector<Label>{{"a", 0, 1}, {"b", 2, 2}}));
}

TEST(Cut, KeepsTheWindowAndItsTime) {
  const Recording part = cut(with_channels({"x"}, "g"), 0.1, 0.3).value();
  ASSERT_EQ(part.samples(), 2U);
  EXPECT_EQ(part.channels[0].values, (std::vector{1.0, 2.0}));
  EXPECT_EQ(part.time.start_ns, 100'000'000);
  EXPECT_FALSE(cut(with_channels({"x"}, "g"), 5.0, 6.0));
  EXPECT_FALSE(cut(with_channels({"x"}, "g"), 0.3, 0.1));
}

Recording stamped(std::vector<double> stamps_s, std::vector<double> values) {
  Recording recording;
  recording.channels.push_back({"x", parse_unit("g").value(), std::move(values)});
  recording.time = {.source = TimeSource::stamps,
                    .channel = "t",
                    .rate_hz = 10.0,
                    .stamps_s = std::move(stamps_s),
                    .start_ns = 0};
  return recording;
}

TEST(RepeatedRows, WrittenTwiceAreLeftOut) {
  const double nan = std::nan("");
  const Recording once = without_repeated_rows(
      stamped({0.0, 0.1, 0.1, 0.2, 0.3, 0.3, 0.4}, {1.0, 2.0, 2.0, 3.0, nan, nan, 5.0}));
  ASSERT_EQ(once.samples(), 5U);
  EXPECT_EQ(once.time.stamps_s, (std::vector{0.0, 0.1, 0.2, 0.3, 0.4}));
  EXPECT_EQ(once.channels[0].values[2], 3.0);
  EXPECT_EQ(once.channels[0].values[4], 5.0);
  ASSERT_EQ(once.notes.size(), 1U);
  EXPECT_TRUE(once.notes[0].text.starts_with("2 rows repeat the one before")) << once.notes[0].text;
}

TEST(RepeatedRows, OfOneStampThatDifferAreKept) {
  EXPECT_EQ(without_repeated_rows(stamped({0.0, 0.1, 0.1, 0.2}, {1.0, 2.0, 3.0, 4.0})).samples(),
            4U);
}

TEST(RepeatedRows, OfACoarseSensorAreSamplesOfTheirOwn) {
  // Two samples for each stamp, of a sensor that changes now and then.
  std::vector<double> stamps_s, values;
  for (int k = 0; k < 40; ++k) {
    stamps_s.push_back(0.2 * (k / 2));
    values.push_back(k / 10);
  }
  EXPECT_EQ(without_repeated_rows(stamped(stamps_s, values)).samples(), 40U);
}

}  // namespace
}  // namespace proofmass::recording_test
