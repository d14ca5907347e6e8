#include "proofmass/estimate/track/fixes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <gtest/gtest.h>
#include <numbers>
#include <random>
#include <string>
#include <vector>

// Sums of sines, which have a position at any time, and fixes that are on no sample.
namespace proofmass::estimate {
namespace {

struct Sine {
  double amplitude_m, frequency_hz, phase_rad;
};

/// A sensor that swings along x and never rests.
class Swing {
 public:
  explicit Swing(std::uint64_t seed) : engine_(seed) {}

  std::vector<Sine> sines{{0.4, 0.31, 0.3}, {0.25, 0.74, 2.0}, {0.1, 1.13, 4.4}};
  double length_s = 60.0, noise_std_mps2 = 0.005;

  [[nodiscard]] double position_m(double t) const { return at(t, 0) - at(0.0, 0); }

  TrackSensor sensor() {
    TrackSensor out;
    out.name = "swing";
    for (double t = 0.0; t < length_s; t += 0.01) {
      out.time_s.push_back(t);
      constexpr double half_turn = std::numbers::pi;  // of the second derivative
      const std::array<double, 3> force{at(t, 2, half_turn) + 0.1, -0.2, standard_gravity_mps2};
      for (std::size_t i = 0; i < 3; ++i)
        out.accel_mps2[i].push_back(force[i] + noise_std_mps2 * normal_(engine_));
    }
    return out;
  }

  TrackOptions options(double every_s, double std_m, double late_s = 0.0) {
    TrackOptions out;
    out.axis = {1.0, 0.0, 0.0};
    out.scale_std = 1e-4;
    for (double t = 0.0; t + 0.01 < length_s; t += every_s)
      out.fixes.push_back({t, position_m(t - late_s) + std_m * normal_(engine_), std_m});
    return out;
  }

  /// Share of instants within two standard deviations of the truth, and the largest departure.
  [[nodiscard]] std::array<double, 2> inside(const TrackSolution& solution) const {
    double count = 0.0, all = 0.0, largest = 0.0;
    for (std::size_t k = 5; k < solution.series.time_s.size(); k += 37) {
      const double z = (solution.series.position_m[k] - position_m(solution.series.time_s[k])) /
                       solution.series.position_std_m[k];
      count += std::abs(z) < 2.0 ? 1.0 : 0.0;
      all += 1.0;
      largest = std::max(largest, std::abs(z));
    }
    return {count / all, largest};
  }

 private:
  /// Sum of the sines times the order-th power of their angular frequency.
  [[nodiscard]] double at(double t, int order, double ahead_rad = 0.0) const {
    double sum = 0.0;
    for (const Sine& sine : sines) {
      const double w = 2.0 * std::numbers::pi * sine.frequency_hz;
      sum += sine.amplitude_m * std::pow(w, order) * std::sin(w * t + sine.phase_rad + ahead_rad);
    }
    return sum;
  }

  std::mt19937_64 engine_;
  std::normal_distribution<double> normal_;
};

bool says(const TrackSolution& solution, const char* words) {
  return std::ranges::any_of(solution.notes, [words](const Note& note) {
    return note.text.find(words) != std::string::npos;
  });
}

// At 2 m/s half a sample is a centimetre, ten standard deviations of a fix. Without a rest the
// velocity and the level at the start are unknown: the smoother lost six digits there.
TEST(TrackFixes, BetweenSamplesAndWithoutARestGiveTheTruth) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Swing swing(seed);
    const auto solution = estimate_track(swing.sensor(), swing.options(2.6137, 0.001));
    ASSERT_TRUE(solution) << solution.error().message;
    ASSERT_TRUE(solution->smoother);
    const auto [share, largest] = swing.inside(*solution);
    EXPECT_GT(share, 0.8) << seed;
    EXPECT_LT(largest, 4.0) << seed;
    EXPECT_FALSE(solution->fix_review.delay_s) << seed;
    EXPECT_TRUE(solution->fix_review.wrong.empty()) << seed;
  }
}

// From 40 s to the next fix the prior at the start is uncertain by kilometres.
TEST(TrackFixes, FarApartKeepTheirDigits) {
  Swing swing(11);
  swing.length_s = 1000.0;
  swing.noise_std_mps2 = 0.01;
  const auto solution = estimate_track(swing.sensor(), swing.options(40.4337, 0.01));
  ASSERT_TRUE(solution) << solution.error().message;
  ASSERT_TRUE(solution->smoother);
  EXPECT_TRUE(solution->fix_review.wrong.empty());
  const auto [share, largest] = swing.inside(*solution);
  EXPECT_GT(share, 0.8);
  EXPECT_LT(largest, 4.0);
}

TEST(TrackFixes, AWrongOneIsNotUsed) {
  Swing swing(3);
  TrackOptions options = swing.options(2.6137, 0.003);
  options.fixes[9].position_m += 0.1;
  const auto solution = estimate_track(swing.sensor(), options);
  ASSERT_TRUE(solution) << solution.error().message;
  ASSERT_EQ(solution->fix_review.wrong.size(), 1U);
  EXPECT_EQ(solution->fix_review.wrong[0].time_s, options.fixes[9].time_s);
  EXPECT_TRUE(says(*solution, "contradicts the accelerations"));
  EXPECT_LT(swing.inside(*solution)[1], 4.0);
}

TEST(TrackFixes, TheRepetitionsOfAStuckTrackerAreNotUsed) {
  Swing swing(3);
  TrackOptions options = swing.options(2.6137, 0.003);
  for (std::size_t i = 10; i < 14; ++i) options.fixes[i].position_m = options.fixes[9].position_m;
  const auto solution = estimate_track(swing.sensor(), options);
  ASSERT_TRUE(solution) << solution.error().message;
  EXPECT_EQ(solution->fix_review.wrong.size(), 4U);
  EXPECT_LT(swing.inside(*solution)[1], 4.0);
}

TEST(TrackFixes, ADelayOfAllIsFoundAndSubtracted) {
  for (const double late_s : {0.06, -0.4}) {
    Swing swing(4);
    const auto solution = estimate_track(swing.sensor(), swing.options(2.6137, 0.003, late_s));
    ASSERT_TRUE(solution) << solution.error().message;
    ASSERT_TRUE(solution->fix_review.delay_s) << late_s;
    EXPECT_NEAR(solution->fix_review.delay_s->value, late_s,
                4.0 * solution->fix_review.delay_s->std);
    EXPECT_LT(solution->fix_review.delay_s->std, 0.01);
    EXPECT_TRUE(says(*solution, late_s > 0.0 ? "late by" : "early by"));
    EXPECT_LT(swing.inside(*solution)[1], 4.5);
  }
}

// Where sines cancel for a second, the sensor is as quiet as at rest.
TEST(TrackFixes, ContradictAQuietSecondThatIsNoRest) {
  Swing swing(5);
  swing.length_s = 76.0;
  swing.sines = {
      {0.877, 0.331, 0.439}, {0.072, 0.787, 4.187}, {0.017, 0.439, 2.526}, {0.235, 0.51, 3.519}};
  const auto solution = estimate_track(swing.sensor(), swing.options(3.7, 0.01));
  ASSERT_TRUE(solution) << solution.error().message;
  ASSERT_TRUE(solution->smoother);
  EXPECT_EQ(solution->fix_review.false_rests, 1U);
  EXPECT_TRUE(solution->rests.empty());
  EXPECT_LT(swing.inside(*solution)[1], 4.0);
}

}  // namespace
}  // namespace proofmass::estimate
