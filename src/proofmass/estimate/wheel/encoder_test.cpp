#include "proofmass/estimate/wheel/encoder.hpp"

#include <array>
#include <cmath>
#include <gtest/gtest.h>

#include "proofmass/core/linalg.hpp"

namespace proofmass::estimate::wheel_encoder_test {
namespace {

constexpr double counts = 512.0, step_rad = rad_per_turn / counts, samples_a_turn = 511.0 / 17.0;

/// An encoder without errors, and its angle at each fix; `swing` of the speed, relative, twelve
/// times in the recording.
struct Rounded {
  std::vector<double> time_s, own_rad;
  EncoderReadings readings;

  explicit Rounded(double swing) {
    constexpr std::size_t size = 6000;
    constexpr double rate_hz = 240.0;
    const double speed = rad_per_turn * rate_hz / samples_a_turn, slow = 0.48 * rad_per_turn;
    const auto angle = [&](double t) {
      return 0.1 + speed * (t - swing / slow * (std::cos(slow * t) - 1.0));
    };
    std::vector<double> shown_rad;
    for (std::size_t k = 0; k < size; ++k) {
      time_s.push_back(static_cast<double>(k) / rate_hz);
      shown_rad.push_back(step_rad * std::floor(angle(time_s.back()) / step_rad));
    }
    WheelEncoder encoder;
    encoder.fixes = signal::fixes_of_samples(time_s, shown_rad, step_rad, 0.0);
    encoder.step_rad = step_rad;
    readings = encoder_readings(encoder, time_s);
    for (std::size_t k = 0; k < size; ++k) own_rad.push_back(angle(time_s[k] - readings.age_s[k]));
  }

  /// Least squares of the fixes less the angle on once and twice a turn.
  [[nodiscard]] Mat<5> errors() const {
    Mat<5, 5> normal = Mat<5, 5>::Zero();
    Mat<5> sum = Mat<5>::Zero();
    for (std::size_t k = 0; k < own_rad.size(); ++k) {
      if (!readings.has(k)) continue;
      const double psi = own_rad[k];
      Mat<5> x;
      x << 1.0, std::cos(psi), std::sin(psi), std::cos(2.0 * psi), std::sin(2.0 * psi);
      normal += x * x.transpose();
      sum += (readings.angle_rad[k] - psi) * x;
    }
    return positive_inverse(normal) * sum;
  }
};

// 512 counts a turn and 30.06 samples: the rounding of a steady wheel comes once a turn. As white
// noise it would give errors of 0.06 mrad.
TEST(CoherentRounding, CoversWhatRepeatsOnceATurn) {
  const Rounded steady(0.0);
  const auto more_rad = coherent_rounding_rad(steady.readings, steady.time_s, steady.own_rad);
  const Mat<5> errors_rad = steady.errors();
  const double found = std::hypot(errors_rad(1), errors_rad(2));
  EXPECT_GT(found, 5e-4);
  const double covered = std::hypot(more_rad[0], more_rad[1]);
  EXPECT_GT(covered, 0.5 * found);
  EXPECT_LT(covered, 3.0 * found);
}

TEST(CoherentRounding, IsWhiteWhereTheSpeedVaries) {
  const Rounded varying(0.3);
  const auto more_rad = coherent_rounding_rad(varying.readings, varying.time_s, varying.own_rad);
  for (const double more : more_rad) EXPECT_LT(more, 1.5e-4);
  for (int i = 1; i < 5; ++i) EXPECT_LT(std::abs(varying.errors()(i)), 3e-4);
}

TEST(CoherentRounding, IsNothingWithoutStepsOrWithStampedEdges) {
  Rounded smooth(0.0);
  smooth.readings.step_rad = 0.0;
  Rounded stamped(0.0);
  for (double& variance : stamped.readings.variance_rad2) variance = 1e-12;
  for (const Rounded* one : {&smooth, &stamped})
    for (const double more : coherent_rounding_rad(one->readings, one->time_s, one->own_rad))
      EXPECT_EQ(more, 0.0);
}

}  // namespace
}  // namespace proofmass::estimate::wheel_encoder_test
