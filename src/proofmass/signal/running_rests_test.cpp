#include "proofmass/signal/running_rests.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

#include "proofmass/signal/rests_test_support.hpp"

namespace proofmass::signal::running_rests_test {
namespace {

using namespace rests_test;

constexpr double window_s = 0.5;

/// A rest as last reported, and the state at its end.
struct Found {
  RestState state;
  std::vector<AllanLevel> levels;
};

struct Follower {
  explicit Follower(double rate_hz, std::size_t axes = 3) : rests(axes, {.rate_hz = rate_hz}) {}

  void add(double time_s, View<double> values) {
    if (!rests.add(time_s, values)) return;
    const RestState& now = rests.state();
    phases.push_back(now.phase);
    if (now.phase != RestPhase::resting) return;
    if (found.empty() || found.back().state.since_s + 1.0 < now.since_s) found.emplace_back();
    found.back() = {now, rests.levels(0)};
  }
  void follow(const Session& made) {
    for (std::size_t k = 0; k < made.size(); ++k)
      add(static_cast<double>(k) / made.rate_hz,
          std::array{made.axis[0][k], made.axis[1][k], made.axis[2][k]});
  }
  [[nodiscard]] bool ever(RestPhase phase) const {
    return std::ranges::find(phases, phase) != phases.end();
  }

  RunningRests rests;
  std::vector<Found> found;
  std::vector<RestPhase> phases;
};

Follower followed(const Session& made) {
  Follower out(made.rate_hz);
  out.follow(made);
  return out;
}

void expect_near(const std::vector<Found>& found, const Session& made, double margin_s) {
  ASSERT_EQ(found.size(), made.rests.size());
  for (std::size_t k = 0; k < found.size(); ++k) {
    const double first_s = static_cast<double>(made.rests[k].first) / made.rate_hz;
    const double last_s = static_cast<double>(made.rests[k].last) / made.rate_hz;
    const RestState& rest = found[k].state;
    EXPECT_GE(rest.since_s, first_s) << k;
    EXPECT_LE(rest.since_s, first_s + margin_s + (first_s > 0.0 ? window_s : 0.0)) << k;
    EXPECT_LE(rest.until_s, last_s) << k;
    EXPECT_GE(rest.until_s, last_s - margin_s) << k;
  }
}

class RunningRestsAtRate : public testing::TestWithParam<double> {};

TEST_P(RunningRestsAtRate, AreThoseOfTheWholeRecording) {
  Noise noise(1);
  Session made = session(GetParam(), {8.0, 2.0, 3.0, 2.5, 6.0, 2.0, 3.5}, noise);
  made.add_noise(noise_std, noise);
  const Follower live = followed(made);
  expect_near(live.found, made, std::max(20.0 / GetParam(), 0.3));
  EXPECT_EQ(live.found.size(), made.search().rests.size());
}

INSTANTIATE_TEST_SUITE_P(Rates,
                         RunningRestsAtRate,
                         testing::Values(20.0, 50.0, 100.0, 204.8, 1000.0));

TEST(RunningRests, AreTheSameInAnyUnitFromAnyOffset) {
  Noise noise(3);
  Session made = session(100.0, {7.0, 3.0, 4.0, 3.0}, noise);
  made.add_noise(noise_std, noise);
  Session counts = made;
  for (std::vector<double>& values : counts.axis)
    for (double& value : values) value = 2048.0 * value + 2097152.0;
  const Follower one = followed(made), other = followed(counts);
  EXPECT_EQ(one.phases, other.phases);
  ASSERT_EQ(one.found.size(), other.found.size());
  for (std::size_t k = 0; k < one.found.size(); ++k) {
    EXPECT_EQ(one.found[k].state.since_s, other.found[k].state.since_s);
    EXPECT_NEAR(2048.0 * one.found[k].state.noise_std[1], other.found[k].state.noise_std[1], 1e-6);
  }
}

TEST(RunningRests, ListenForThreeSecondsBeforeTheyTell) {
  Noise noise(4);
  Session made;
  made.rest(12.0);
  made.add_noise(noise_std, noise);
  const Follower live = followed(made);
  const auto blocks_a_second = 100.0 / static_cast<double>(live.rests.samples_a_block());
  for (std::size_t k = 0; static_cast<double>(k) < 2.8 * blocks_a_second; ++k)
    EXPECT_EQ(live.phases[k], RestPhase::listening);
  ASSERT_EQ(live.found.size(), 1U);
  EXPECT_EQ(live.found[0].state.since_s, 0.0);
}

TEST(RunningRests, OutliveTheirOwnMemory) {
  Noise noise(5);
  Session made;
  made.rest(120.0);
  made.turn(1.0, noise);
  made.rest(5.0);
  made.add_noise(noise_std, noise);
  const Follower live = followed(made);
  expect_near(live.found, made, 0.3);
  EXPECT_LE(live.found[0].state.samples, 512U * live.rests.samples_a_block());
}

TEST(RunningRests, AreNoneInAHandNorOnAWheel) {
  Noise noise(17);
  Session hand, wheel;
  Vector speed{}, place{};
  for (std::size_t k = 0; k < 12000; ++k) {
    for (std::size_t a = 0; a < 3; ++a) {
      speed[a] += 0.05 * (noise.normal() - speed[a]);
      place[a] += 0.05 * (speed[a] - place[a]);
    }
    hand.add(place);
    const double angle = 2.0 * pi * 0.5 * static_cast<double>(k) / 100.0;
    wheel.add({9.81 * std::sin(angle), 9.81 * std::cos(angle), 0.0});
  }
  hand.add_noise(noise_std, noise);
  wheel.add_noise(0.05, noise);
  EXPECT_TRUE(followed(hand).found.empty());
  EXPECT_TRUE(followed(wheel).found.empty());
}

TEST(RunningRests, AreFoundAfterAHandThatCameFirst) {
  Noise noise(18);
  Session made;
  for (std::size_t k = 0; k < 3000; ++k) {
    const double t = static_cast<double>(k) / 100.0;
    made.add({std::sin(4.0 * t), std::cos(7.0 * t), 9.81 + 0.5 * std::sin(11.0 * t)});
  }
  made.rest(6.0);
  made.turn(1.0, noise);
  made.rest(4.0);
  made.add_noise(noise_std, noise);
  expect_near(followed(made).found, made, 0.3);
}

TEST(RunningRests, EndWithAnOutlierAndBeginAnew) {
  Noise noise(11);
  Session made;
  made.rest(16.0);
  made.add_noise(noise_std, noise);
  for (std::size_t k = 0; k < 15; ++k)
    made.axis[2][900 + k] += 0.5 * std::sin(pi * static_cast<double>(k) / 2.5);
  const Follower live = followed(made);
  ASSERT_EQ(live.found.size(), 2U);
  EXPECT_LT(live.found[0].state.until_s, 9.0);
  EXPECT_GT(live.found[1].state.since_s, 9.15);
}

TEST(RunningRests, OutliveBadSamplesAndSingleOutliers) {
  Noise noise(6);
  Session made = session(100.0, {8.0, 5.0, 6.0}, noise);
  made.add_noise(noise_std, noise);
  const std::vector<Rest>& rests = made.rests;
  made.axis[0][rests[1].first + 200] = 3e34;
  made.axis[1][rests[1].first + 300] = 25.0;
  made.axis[2][rests[1].first + 100] = -infinity;
  made.axis[2][rests[2].first + 250] += 20.0 * noise_std;
  for (std::size_t k = 0; k < 30; ++k) made.axis[0][rests[2].first + 200 + k] = nan;
  expect_near(followed(made).found, made, 0.3);
}

TEST(RunningRests, EndWhereTheStampsStepByMoreThanAWindow) {
  Noise noise(7);
  for (const double step_s : {0.3, 2.0, -5.0}) {
    Follower live(100.0, 1);
    double time_s = 0.0;
    for (std::size_t k = 0; k < 2000; ++k) {
      time_s += k == 1000 ? step_s : 0.01;
      live.add(time_s, std::array{noise_std * noise.normal()});
    }
    EXPECT_EQ(live.ever(RestPhase::moving), step_s != 0.3) << step_s;
    EXPECT_EQ(live.phases.back(), RestPhase::resting);
    const RestState& last = live.rests.state();
    if (step_s != 0.3) {
      EXPECT_NEAR(last.until_s - last.since_s, 9.9 - window_s, 0.15);
    }
  }
}

TEST(RunningRests, AreNoneWhereOneReadingIsRepeated) {
  Noise noise(19);
  Session made = session(100.0, {8.0, 4.0, 4.0}, noise);
  made.add_noise(noise_std, noise);
  for (std::vector<double>& values : made.axis)
    std::fill_n(values.begin() + static_cast<std::ptrdiff_t>(made.rests[1].first), 400,
                values[made.rests[1].first]);
  const Follower live = followed(made);
  EXPECT_TRUE(live.ever(RestPhase::stuck));
  EXPECT_FALSE(followed(session(100.0, {8.0, 4.0}, noise)).ever(RestPhase::stuck));
  made.rests.erase(made.rests.begin() + 1);
  expect_near(live.found, made, 0.3);
}

TEST(RunningRests, FollowANoiseThatIsAnother) {
  Noise noise(20);
  for (const double factor : {0.1, 8.0}) {
    Session made;
    made.rest(20.0);
    made.turn(1.0, noise);
    made.add_noise(noise_std, noise);
    Session later;
    later.up = made.up;
    later.rest(80.0);
    later.add_noise(factor * noise_std, noise);
    for (std::size_t a = 0; a < 3; ++a)
      made.axis[a].insert(made.axis[a].end(), later.axis[a].begin(), later.axis[a].end());
    const Follower live = followed(made);
    EXPECT_EQ(live.phases.back(), RestPhase::resting) << factor;
    EXPECT_NEAR(live.rests.state().noise_std[0] / (factor * noise_std), 1.0, 0.1) << factor;
  }
}

TEST(RunningRests, MeasureTheRateWhereNobodySaysIt) {
  Noise noise(21);
  Session made = session(60.0, {8.0, 3.0, 4.0}, noise);
  made.add_noise(noise_std, noise);
  Follower live(0.0);
  live.follow(made);
  expect_near(live.found, made, 0.4);
  EXPECT_EQ(live.rests.samples_a_block(), 4U);
  // A clock that does not advance must not cause an endless wait.
  Follower dead(0.0, 1);
  for (std::size_t k = 0; k < 6000; ++k) dead.add(0.0, std::array{noise_std * noise.normal()});
  EXPECT_FALSE(dead.phases.empty());
}

TEST(RunningRests, KnowTheMeanAndTheNoiseOfEachOctave) {
  double squares = 0.0, count = 0.0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    Noise noise(100 + seed);
    Session made;
    made.rest(12.0);
    made.add_noise(noise_std, noise);
    const Follower live = followed(made);
    ASSERT_EQ(live.found.size(), 1U);
    const RestState& rest = live.found[0].state;
    const double std = noise_std / std::sqrt(static_cast<double>(rest.samples));
    const double error = (rest.mean[0] - 9.81 * made.up[0]) / std;
    squares += error * error;
    count += 1.0;
    EXPECT_NEAR(rest.noise_std[2] / noise_std, 1.0, 0.1);
    for (const AllanLevel& level : live.found[0].levels) {
      constexpr double enough = 8.0;  // for chi-square to be approximately normal
      if (level.pairs < enough) continue;
      EXPECT_NEAR(level.variance * level.samples / (noise_std * noise_std), 1.0,
                  5.0 * std::sqrt(2.0 / level.pairs))
          << level.samples;
    }
  }
  EXPECT_NEAR(squares / count, 1.0, 4.0 * std::sqrt(2.0 / count));
}

TEST(DyadicAllan, IsTheAllanVarianceOfEachOctave) {
  Noise noise(22);
  std::vector<double> values;
  DyadicAllan ladder;
  for (int k = 0; k < 100; ++k) {
    values.push_back(noise.normal());
    ladder.add(values.back());
  }
  const std::vector<AllanLevel> levels = ladder.levels(3.0);
  ASSERT_EQ(levels.size(), 6U);
  for (std::size_t j = 0; j < levels.size(); ++j) {
    const std::size_t width = std::size_t{1} << j;
    double squares = 0.0, pairs = 0.0;
    for (std::size_t k = 0; k + 2 * width <= values.size(); k += 2 * width, pairs += 1.0) {
      double step = 0.0;
      for (std::size_t i = 0; i < width; ++i) step += values[k + width + i] - values[k + i];
      squares += 0.5 * step * step / static_cast<double>(width * width);
    }
    EXPECT_EQ(levels[j].samples, 3.0 * static_cast<double>(width));
    EXPECT_EQ(levels[j].pairs, pairs);
    EXPECT_NEAR(levels[j].variance, squares / pairs, 1e-12);
  }
}

TEST(DyadicAllan, ComparesNothingAcrossABreak) {
  DyadicAllan ladder;
  for (const double value : {1.0, 1.0, 1.0}) ladder.add(value);
  ladder.break_off();
  for (const double value : {9.0, 9.0, 9.0, 9.0}) ladder.add(value);
  for (const AllanLevel& level : ladder.levels(1.0)) EXPECT_EQ(level.variance, 0.0);
}

}  // namespace
}  // namespace proofmass::signal::running_rests_test
