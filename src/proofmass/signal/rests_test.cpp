#include "proofmass/signal/rests.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>

#include "proofmass/signal/rests_test_support.hpp"

namespace proofmass::signal::rests_test {
namespace {

using namespace rests_test;

/// The same rests, each at most `margin` samples shorter at either end, and not longer.
void expect_rests(const std::vector<Rest>& found,
                  const std::vector<Rest>& truth,
                  std::size_t margin) {
  ASSERT_EQ(found.size(), truth.size());
  for (std::size_t k = 0; k < truth.size(); ++k) {
    EXPECT_GE(found[k].first, truth[k].first) << k;
    EXPECT_LE(found[k].first, truth[k].first + margin) << k;
    EXPECT_LE(found[k].last, truth[k].last) << k;
    EXPECT_GE(found[k].last + margin, truth[k].last) << k;
  }
}

class RestsAtRate : public testing::TestWithParam<double> {};

TEST_P(RestsAtRate, AreFoundWithinATenthOfASecondOrEightSamples) {
  Noise noise(1);
  Session made = session(GetParam(), {4.0, 2.0, 3.0, 2.5, 6.0, 2.0, 3.5}, noise);
  made.add_noise(noise_std, noise);
  const RestSearch search = made.search();
  expect_rests(search.rests, made.rests, std::max<std::size_t>(8, made.samples(0.13)));
  ASSERT_EQ(search.noise_std.size(), 3U);
  const double tolerance = 3.5 / std::sqrt(2.0 * 18.0 * GetParam());
  for (const double std : search.noise_std) EXPECT_NEAR(std / noise_std, 1.0, tolerance);
  EXPECT_TRUE(search.why_none.empty());
}

INSTANTIATE_TEST_SUITE_P(Rates, RestsAtRate, testing::Values(20.0, 50.0, 100.0, 204.8, 1000.0));

TEST(Rests, OfOneSecondAreFoundAfterOneOfFifty) {
  Noise noise(2);
  std::vector<double> lengths(25, 1.0);
  lengths[0] = 50.0;
  Session made = session(100.0, lengths, noise);
  made.add_noise(noise_std, noise);
  expect_rests(made.search().rests, made.rests, 15);
}

TEST(Rests, AreTheSameInAnyUnitFromAnyOffset) {
  Noise noise(3);
  Session made = session(100.0, {3.0, 2.0, 4.0, 2.0}, noise);
  made.add_noise(noise_std, noise);
  for (std::vector<double>& values : made.axis)
    for (double& value : values) value = std::round(value * 0x1p16) * 0x1p-16;
  const std::vector<Rest> rests = made.search().rests;
  expect_rests(rests, made.rests, 15);
  for (const double factor : {0x1p-30, 0x1p9, -0x1p30})
    for (const double offset : {0.0, 32768.0}) {
      Session other = made;
      for (std::vector<double>& values : other.axis)
        for (double& value : values) value = factor * (value + offset);
      const RestSearch search = other.search();
      expect_rests(search.rests, rests, 0);
      EXPECT_NEAR(search.noise_std[0], std::abs(factor) * noise_std,
                  0.06 * std::abs(factor) * noise_std);
    }
}

TEST(Rests, AreFoundOnOneAxisAndOnTwo) {
  Noise noise(4);
  Session made = session(100.0, {3.0, 2.0, 4.0, 2.0, 3.0}, noise);
  made.add_noise(noise_std, noise);
  for (const std::size_t axes : {1U, 2U}) expect_rests(made.search(axes).rests, made.rests, 15);
}

TEST(Rests, MayHaveDifferentNoiseInEachPosition) {
  Noise noise(5);
  Session made = session(100.0, std::vector<double>(12, 3.0), noise);
  made.add_noise(noise_std, noise);
  for (const Rest& rest : made.rests)
    for (std::vector<double>& values : made.axis) {
      const double more = 1.5 * noise.uniform() * noise_std;
      for (std::size_t k = rest.first; k <= rest.last; ++k) values[k] += more * noise.normal();
    }
  expect_rests(made.search().rests, made.rests, 15);
}

TEST(Rests, OutliveBadSamplesAndSingleOutliers) {
  Noise noise(6);
  Session made = session(100.0, {6.0, 5.0, 6.0}, noise);
  made.add_noise(noise_std, noise);
  const std::vector<Rest>& rests = made.rests;
  made.axis[0][rests[0].first + 200] = 3e34;
  made.axis[1][rests[0].first + 300] = 25.0;
  made.axis[2][rests[1].first + 100] = -infinity;
  made.axis[2][rests[1].first + 250] += 20.0 * noise_std;
  for (std::size_t k = 0; k < 30; ++k) made.axis[0][rests[2].first + 250 + k] = nan;
  expect_rests(made.search().rests, made.rests, 15);
}

TEST(Rests, EndWhereNothingWasMeasuredForLongerThanAWindow) {
  Noise noise(7);
  Session made;
  made.rest(10.0);
  made.add_noise(noise_std, noise);
  for (std::size_t k = 400; k < 500; ++k) made.axis[1][k] = nan;
  const std::vector<Rest> rests = made.search().rests;
  ASSERT_EQ(rests.size(), 2U);
  EXPECT_LE(rests[0].last, 399U);
  EXPECT_GE(rests[1].first, 500U);
}

TEST(Rests, BeginAfterAFirstSampleThatIsZero) {
  Noise noise(8);
  Session made;
  made.rest(10.0);
  made.add_noise(noise_std, noise);
  for (std::vector<double>& values : made.axis) values[0] = 0.0;
  const std::vector<Rest> rests = made.search().rests;
  ASSERT_EQ(rests.size(), 1U);
  EXPECT_GE(rests[0].first, 1U);
  EXPECT_LE(rests[0].first, 8U);
}

TEST(Rests, AreTwoWhereAQuickTurnDividesThem) {
  Noise noise(9);
  for (const double turn_s : {0.0, 0.02, 0.2}) {
    Session made;
    made.rest(3.0);
    made.turn(turn_s, noise);
    made.rest(3.0);
    made.add_noise(noise_std, noise);
    expect_rests(made.search().rests, made.rests, 25);
  }
}

TEST(Rests, AreTwoWhereTheLevelStepsByTwiceTheNoise) {
  Noise noise(10);
  Session made;
  made.rest(20.0);
  made.add_noise(noise_std, noise);
  for (std::size_t k = 1000; k < 2000; ++k) made.axis[0][k] += 2.0 * noise_std;
  const std::vector<Rest> rests = made.search().rests;
  ASSERT_EQ(rests.size(), 2U);
  EXPECT_NEAR(static_cast<double>(rests[0].last), 1000.0, 60.0);
  EXPECT_NEAR(static_cast<double>(rests[1].first), 1000.0, 60.0);
}

TEST(Rests, AreOneWhereAnOutlierLeavesTheLevelAsItWas) {
  Noise noise(11);
  Session made;
  made.rest(8.0);
  made.add_noise(noise_std, noise);
  for (std::size_t k = 0; k < 15; ++k)
    made.axis[2][400 + k] += 0.5 * std::sin(pi * static_cast<double>(k) / 2.5);
  expect_rests(made.search().rests, made.rests, 0);
}

TEST(Rests, DoNotHoldASlowTurn) {
  Noise noise(12);
  for (const double turn_radps : {1e-3, 3e-3, 1e-2, 0.1}) {
    Session made = session(100.0, {6.0, 6.0}, noise);
    const Vector level{made.axis[0].back(), made.axis[1].back(), made.axis[2].back()};
    const std::size_t first = made.size();
    for (std::size_t k = 0; k < 2000; ++k) {
      const double angle = turn_radps * static_cast<double>(k) / 100.0;
      made.add({level[0] + 9.81 * std::sin(angle), level[1], level[2]});
    }
    made.add_noise(noise_std, noise);
    const std::vector<Rest> rests = made.search().rests;
    std::size_t taken = 0;
    for (const Rest& rest : rests)
      if (rest.last >= first) taken += rest.last - std::max(rest.first, first) + 1;
    EXPECT_GE(rests.size(), 2U);
    EXPECT_LE(taken, 300U) << turn_radps;
  }
}

TEST(Rests, BeginWhenTheSensorHasSettled) {
  Noise noise(13);
  Session made = session(100.0, std::vector<double>(8, 6.0), noise);
  for (const Rest& rest : made.rests)
    for (std::size_t k = rest.first; k <= rest.last; ++k) {
      const double t = static_cast<double>(k - rest.first) / 100.0;
      made.axis[0][k] += 10.0 * noise_std * std::exp(-t / 0.4);
      made.axis[1][k] += 100.0 * noise_std * std::exp(-t / 0.1) * std::cos(2.0 * pi * 12.0 * t);
    }
  made.add_noise(noise_std, noise);
  const RestSearch search = made.search();
  ASSERT_EQ(search.rests.size(), made.rests.size());
  for (std::size_t k = 0; k < search.rests.size(); ++k) {
    const double start_s = static_cast<double>(search.rests[k].first - made.rests[k].first) / 100.0;
    const double rest_s =
        static_cast<double>(search.rests[k].last - search.rests[k].first + 1) / 100.0;
    // The remaining settling shifts the mean by less than five of its standard deviations.
    const double bias = 10.0 * 0.4 / rest_s * std::exp(-start_s / 0.4);
    EXPECT_LT(bias, 5.0 / std::sqrt(100.0 * rest_s)) << start_s;
    EXPECT_LT(start_s, 2.0);
  }
}

TEST(Rests, DoNotHoldASensorThatIsHeld) {
  Noise noise(14);
  Session made;
  std::vector<Rest> held;
  for (int k = 0; k < 6; ++k) {
    made.rest(4.0);
    made.turn(1.0, noise);
    held.push_back({made.size(), made.size() + 399});
    double sway = 0.0;
    for (int i = 0; i < 400; ++i) {
      sway = 0.99 * sway + 0.005 * noise.normal();
      const double tremor = 0.05 * std::sin(2.0 * pi * 9.0 * i / 100.0);
      made.add({9.81 * made.up[0] + sway, 9.81 * made.up[1] + tremor, 9.81 * made.up[2] - sway});
    }
    made.turn(1.0, noise);
  }
  made.add_noise(noise_std, noise);
  expect_rests(made.search().rests, made.rests, 15);
}

/// Ten seconds to three minutes, entirely at rest.
struct Still {
  const char* name;
  double seconds;
  /// The measurement in units of white noise, given its index and the noise.
  double (*reading)(std::size_t k, Noise& noise, double& state);
};

// GoogleTest requires a printer of exactly this name.
// NOLINTNEXTLINE(readability-identifier-naming)
void PrintTo(const Still& still, std::ostream* out) {
  *out << still.name;
}

class WholeRecording : public testing::TestWithParam<Still> {};

TEST_P(WholeRecording, IsOneRest) {
  Noise noise(15);
  Session made;
  made.rest(GetParam().seconds);
  for (std::vector<double>& values : made.axis) {
    double state = 0.0;
    for (std::size_t k = 0; k < values.size(); ++k)
      values[k] += GetParam().reading(k, noise, state);
  }
  expect_rests(made.search().rests, made.rests, 0);
}

INSTANTIATE_TEST_SUITE_P(
    Noises,
    WholeRecording,
    testing::Values(
        Still{"white", 60.0, [](std::size_t, Noise& noise, double&) { return noise.normal(); }},
        Still{"random walk", 180.0,
              [](std::size_t, Noise& noise, double& state) {
                return (state += 0.02 * noise.normal()) + noise.normal();
              }},
        Still{"low-passed", 60.0,
              [](std::size_t, Noise& noise, double& state) {
                return state = 0.8 * state + noise.normal();
              }},
        Still{"a building's line", 180.0,
              [](std::size_t k, Noise& noise, double&) {
                return std::sin(2.0 * pi * 0.0056 * static_cast<double>(k)) + noise.normal();
              }},
        Still{"an engine", 30.0,
              [](std::size_t k, Noise& noise, double&) {
                return 20.0 * std::sin(2.0 * pi * 0.2504 * static_cast<double>(k)) + noise.normal();
              }},
        Still{"half a step of a converter", 60.0,
              [](std::size_t, Noise& noise, double&) { return std::round(0.5 * noise.normal()); }},
        Still{"a tenth of a step of a converter", 60.0,
              [](std::size_t k, Noise& noise, double&) {
                return std::round(0.1 * noise.normal() + 1e-4 * static_cast<double>(k));
              }},
        Still{"none at all", 10.0, [](std::size_t, Noise&, double&) { return 0.0; }}));

TEST(Rests, AreFoundBetweenExactSteps) {
  Session made;
  for (const Vector& up : {Vector{1, 0, 0}, Vector{-1, 0, 0}, Vector{0, 1, 0}, Vector{0, -1, 0},
                           Vector{0, 0, 1}, Vector{0, 0, -1}}) {
    made.up = up;
    made.rest(2.0);
  }
  expect_rests(made.search().rests, made.rests, 20);
}

TEST(Rests, AreNoneOnATurningWheel) {
  Noise noise(16);
  for (const double turn_hz : {0.1, 0.5, 1.0, 3.0, 7.0}) {
    Session made;
    for (std::size_t k = 0; k < 4000; ++k) {
      const double angle = 2.0 * pi * turn_hz * static_cast<double>(k) / 100.0;
      made.add({9.81 * std::sin(angle), 9.81 * std::cos(angle), 0.0});
    }
    made.add_noise(0.05, noise);
    const RestSearch search = made.search();
    EXPECT_TRUE(search.rests.empty()) << turn_hz;
    EXPECT_TRUE(search.noise_std.empty());
    EXPECT_NE(search.why_none.find("was never at rest"), std::string::npos) << search.why_none;
  }
}

TEST(Rests, AreNoneInAHand) {
  Noise noise(17);
  Session made;
  Vector speed{}, place{};
  for (std::size_t k = 0; k < 6000; ++k) {
    for (std::size_t a = 0; a < 3; ++a) {
      speed[a] += 0.05 * (noise.normal() - speed[a]);
      place[a] += 0.05 * (speed[a] - place[a]);
    }
    made.add(place);
  }
  made.add_noise(noise_std, noise);
  const RestSearch search = made.search();
  EXPECT_TRUE(search.rests.empty());
  EXPECT_FALSE(search.why_none.empty());
}

TEST(Rests, AreNoneWhereOneReadingIsRepeated) {
  Noise noise(18);
  Session made = session(100.0, {4.0, 3.0, 4.0}, noise);
  made.add_noise(noise_std, noise);
  for (std::vector<double>& values : made.axis)
    std::fill_n(values.begin() + static_cast<std::ptrdiff_t>(made.rests[1].first), 300,
                values[made.rests[1].first]);
  made.rests.erase(made.rests.begin() + 1);
  expect_rests(made.search().rests, made.rests, 15);
}

TEST(Rests, AreFoundWhereALoggerRepeatedSomeRows) {
  Noise noise(18);
  Session made = session(100.0, {6.0, 4.0, 4.0, 4.0, 4.0, 4.0}, noise);
  made.add_noise(noise_std, noise);
  // Windows that are constant in part are quieter than any rest.
  for (std::size_t k = 0; k < made.rests.size(); ++k)
    for (std::vector<double>& values : made.axis)
      std::fill_n(values.begin() + static_cast<std::ptrdiff_t>(made.rests[k].last - 50 - 40 * k),
                  51 + 40 * k, values[made.rests[k].last - 50 - 40 * k]);
  for (std::size_t k = 0; k < made.rests.size(); ++k) made.rests[k].last -= 50 + 40 * k;
  expect_rests(made.search().rests, made.rests, 15);
}

TEST(Rests, SayWhyThereAreNone) {
  Session made;
  EXPECT_NE(made.search().why_none.find("0 usable samples are too few"), std::string::npos);
  made.rest(0.5);
  EXPECT_NE(made.search().why_none.find("50 usable samples are too few"), std::string::npos);
  made.rest(5.0);
  for (double& value : made.axis[1]) value = nan;
  EXPECT_NE(made.search().why_none.find("0 usable samples are too few"), std::string::npos);
}

TEST(Rests, LastAsLongAsWasAskedFor) {
  Noise noise(19);
  Session made = session(100.0, {8.0, 2.0, 9.0, 3.0}, noise);
  made.add_noise(noise_std, noise);
  const std::vector<View<double>> axes(made.axis.begin(), made.axis.end());
  const RestSearch search = find_rests(axes, {.rate_hz = 100.0, .shortest_s = 5.0});
  expect_rests(search.rests, {made.rests[0], made.rests[2]}, 15);
  const RestSearch none = find_rests(axes, {.rate_hz = 100.0, .shortest_s = 20.0});
  EXPECT_TRUE(none.rests.empty());
  EXPECT_NE(none.why_none.find("2000 samples"), std::string::npos) << none.why_none;
}

TEST(Rests, AreFoundWithoutARate) {
  Noise noise(20);
  Session made = session(60.0, {5.0, 3.0, 4.0, 3.0}, noise);
  made.add_noise(noise_std, noise);
  const std::vector<View<double>> axes(made.axis.begin(), made.axis.end());
  const RestSearch search = find_rests(axes, {});
  expect_rests(search.rests, made.rests, 15);
  EXPECT_EQ(search.window, 48U);
}

}  // namespace
}  // namespace proofmass::signal::rests_test
