#include "proofmass/signal/unusable.hpp"

#include <algorithm>
#include <cmath>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "proofmass/core/random.hpp"

namespace proofmass::signal {
namespace {

std::vector<double> swings(double noise, double step, double limit) {
  std::vector<double> out;
  Random random(1, "noise");
  for (int k = 0; k < 2000; ++k) {
    const double value = std::sin(0.02 * k) * std::cos(0.0031 * k) + noise * random.normal();
    out.push_back(std::clamp(std::round(value / step) * step, -limit - step, limit));
  }
  return out;
}

/// At rest with noise, and one stroke that accelerates and brakes by 1.3.
std::vector<double> stroke(std::size_t begins, double noise, double step, double limit) {
  std::vector<double> out;
  Random random(2, "noise");
  for (std::size_t k = 0; k < 4000; ++k) {
    const double t = (static_cast<double>(k) - static_cast<double>(begins)) / 200.0;
    const double pulse = t < 0.0 || t > 1.0 ? 0.0 : std::sin(6.283185307179586 * t);
    const double value = std::clamp(1.3 * pulse + noise * random.normal(), -limit, limit);
    out.push_back(step > 0.0 ? std::round(value / step) * step : value);
  }
  return out;
}

Recording of(std::vector<double> values) {
  Recording recording;
  recording.time = {TimeSource::given_rate, "", 100.0, {}, {}};
  recording.channels.push_back({"acc_x", *parse_unit("m/s^2"), std::move(values)});
  return recording;
}

/// Beside another axis of the same sensor.
RangeEnds ends_of(std::vector<double> values, const std::vector<double>& other) {
  return range_ends(of(std::move(values)).channels.front(), {other});
}

/// The axis across a stroke, which moves less.
std::vector<double> across(std::vector<double> stroke, double share) {
  Random random(3, "noise");
  for (double& value : stroke) value = share * value + 1e-3 * random.normal();
  return stroke;
}

TEST(Saturation, OfAConverterWhoseNegativeEndIsOneCodeFarther) {
  const std::vector<double> series = swings(1e-3, 1e-3, 0.7);
  const RangeEnds ends = range_ends(of(series).channels.front(), {});
  ASSERT_TRUE(ends.low && ends.high);
  EXPECT_DOUBLE_EQ(*ends.low, -0.701);
  EXPECT_DOUBLE_EQ(*ends.high, 0.7);
}

TEST(Saturation, OfOneStrokeForAnyStep) {
  for (const double step : {0.0, 0.0005, 0.005, 0.01})
    for (const std::size_t begins :
         {500U, 980U, 1100U, 2000U}) {  // some across pieces of the audit
      const RangeEnds ends =
          ends_of(stroke(begins, 1e-3, step, 1.0), across(stroke(begins, 1e-3, 0.0, 2.0), 0.1));
      EXPECT_EQ(ends.low, -1.0) << step << ", " << begins;
      EXPECT_EQ(ends.high, 1.0) << step << ", " << begins;
    }
}

TEST(Saturation, IsNoCrestOfACoarseConverterAndNoRest) {
  const std::vector<double> beside = across(swings(0.0, 0.05, 2.0), 1.0);
  EXPECT_FALSE(ends_of(swings(0.0, 0.05, 2.0), beside).reached());
  EXPECT_FALSE(ends_of(swings(1e-4, 0.01, 2.0), beside).reached());
  EXPECT_FALSE(ends_of(std::vector<double>(2000, 3.0), beside).reached());
  EXPECT_FALSE(ends_of({}, {}).reached());
  // At rest at its lowest value, and turned in one direction; from one position to another.
  std::vector<double> turned(300, 0.02), positions(300, -1.0);
  for (std::size_t k = 0; k < 100; ++k) {
    turned[100 + k] = 0.02 + std::sin(0.0314 * static_cast<double>(k));
    positions[100 + k] = 1.0;
  }
  EXPECT_FALSE(ends_of(turned, across(turned, 0.5)).reached());
  EXPECT_FALSE(ends_of(positions, across(positions, 0.5)).reached());
}

TEST(Saturation, DropsTheValuesOfTheChannelsThatAreNamed) {
  Recording recording = of(stroke(1000, 1e-3, 0.0, 1.0));
  recording.channels.push_back(recording.channels.front());
  const std::vector<double> before = recording.channels.front().values.copy();
  const std::vector<Note> notes = drop_saturated({1}, recording);
  EXPECT_EQ(recording.channels[0].values.copy(), before);
  std::size_t dropped = 0;
  for (std::size_t k = 0; k < before.size(); ++k) {
    const bool at_end = std::abs(before[k]) == 1.0;
    dropped += at_end ? 1U : 0U;
    EXPECT_EQ(std::isnan(recording.channels[1].values[k]), at_end) << k;
  }
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_EQ(notes[0].severity, Severity::warning);
  EXPECT_THAT(notes[0].text,
              testing::StartsWith("acc_x: " + std::to_string(dropped) +
                                  " of 4000 samples are at the limits of the range (-1 and 1 "
                                  "m/s^2), from 10.2"));
  EXPECT_TRUE(drop_saturated({1}, recording).empty());
}

/// Rests of 3 s at -1.3, 0.6, 1.02 and 0.2, with noise, in steps of 0.002, between limits.
std::vector<double> positions(double limit, std::uint64_t seed) {
  std::vector<double> out;
  Random random(seed, "noise");
  for (const double level : {-1.3, 0.6, 1.02, 0.2})
    for (int k = 0; k < 300; ++k)
      out.push_back(
          std::clamp(std::round((level + 0.02 * random.normal()) / 0.002) * 0.002, -limit, limit));
  return out;
}

TEST(Saturation, OfRestsNearTheLimitTakesTheirSurroundings) {
  Recording recording = of(positions(1.0, 1));
  recording.channels.push_back({"acc_y", *parse_unit("m/s^2"), positions(10.0, 2)});
  Recording unlimited = of(positions(10.0, 1));
  unlimited.channels.push_back(recording.channels[1]);
  EXPECT_TRUE(drop_saturated_rests({0, 1}, unlimited).empty());
  const std::vector<Note> notes = drop_saturated_rests({0, 1}, recording);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_THAT(notes[0].text, testing::HasSubstr("limits of the range (-1 and 1 m/s^2)"));
  const View<double> values = recording.channels[0].values;
  EXPECT_TRUE(std::isfinite(values[400]));
  EXPECT_TRUE(std::isfinite(values[1000]));
  // At the third level the noise itself reaches below the limit in one of six.
  EXPECT_EQ(
      std::ranges::count_if(values.subspan(550, 400), [](double v) { return !std::isnan(v); }), 0);
}

TEST(Saturation, OfAShortMotionBetweenRestsConcernsNone) {
  Recording recording = of(stroke(1000, 1e-3, 0.0, 1.0));
  recording.channels.push_back(
      {"acc_y", *parse_unit("m/s^2"), across(stroke(1000, 1e-3, 0.0, 2.0), 0.1)});
  recording.time.rate_hz = 1000.0;
  EXPECT_TRUE(drop_saturated_rests({0, 1}, recording).empty());
  EXPECT_FALSE(drop_saturated({0, 1}, recording).empty());
}

/// At rest with noise and in motion by turns, in steps; from `stuck` on the same value for 3 s.
std::vector<double> logged(double noise, double step, std::uint64_t seed, std::size_t stuck) {
  std::vector<double> out;
  Random random(seed, "noise");
  for (std::size_t k = 0; k < 3000; ++k) {
    const double t = 0.01 * static_cast<double>(k), phase = std::fmod(t, 6.0) - 3.0;
    const double moved = phase < 0.0 ? 0.0 : std::sin(6.283185307179586 * phase);
    const double value = std::round((moved + noise * random.normal()) / step) * step;
    out.push_back(k > stuck && k < stuck + 300 ? out.back() : value);
  }
  return out;
}

Recording sensor(double noise, double step, std::size_t stuck) {
  Recording recording = of(logged(noise, step, 1, stuck));
  recording.channels.push_back(of(logged(noise, step, 2, stuck)).channels.front());
  return recording;
}

TEST(Stuck, ValuesAreDroppedButForTheFirst) {
  for (const std::size_t stuck : {300U, 1000U, 1620U}) {
    Recording recording = sensor(0.01, 1e-3, stuck);
    const std::vector<Note> notes = drop_stuck({{0, 1}}, recording);
    ASSERT_EQ(notes.size(), 1U) << stuck;
    EXPECT_THAT(notes[0].text,
                testing::StartsWith("acc_x and the sensor's other axes repeat one value in 299 of "
                                    "3000 samples"));
    for (const Channel& channel : recording.channels)
      for (std::size_t k = 0; k < channel.values.size(); ++k)
        EXPECT_EQ(std::isnan(channel.values[k]), k > stuck && k < stuck + 300)
            << stuck << ", " << k;
  }
}

TEST(Stuck, IsNoRestOfASensorWithoutNoiseAndNoAxisAlone) {
  Recording coarse = sensor(1e-4, 0.01, 5000);
  EXPECT_TRUE(drop_stuck({{0, 1}}, coarse).empty());
  Recording one = sensor(0.01, 1e-3, 1000);
  one.channels[1] = of(logged(0.01, 1e-3, 2, 5000)).channels.front();
  EXPECT_TRUE(drop_stuck({{0, 1}}, one).empty());
}

// A gyroscope on a table of which the noise is never seen: its bias wanders.
TEST(Stuck, IsALoggerThatRepeatsTheRowsOfAllSensors) {
  Recording recording = sensor(0.01, 1e-3, 1000);
  std::vector<double> rate;
  for (std::size_t k = 0; k < 3000; ++k)
    rate.push_back(k > 1000 && k < 1300 ? rate.back() : std::sin(0.05 * static_cast<double>(k)));
  recording.channels.push_back(of(rate).channels.front());
  recording.channels.back().name = "gyr_x";
  EXPECT_TRUE(drop_stuck({{2}}, recording).empty());
  EXPECT_EQ(drop_stuck({{0, 1}, {2}}, recording).size(), 2U);
  for (std::size_t k = 0; k < rate.size(); ++k)
    EXPECT_EQ(std::isnan(recording.channels[2].values[k]), k > 1000 && k < 1300) << k;
}

}  // namespace
}  // namespace proofmass::signal
