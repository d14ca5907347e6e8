#pragma once

#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

#include "proofmass/calibrate/rotation.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/sensor/model_equation.hpp"

namespace proofmass::calibrate {

/// A simulated wheel defined only by the model equation and an angle as a function of time.
struct PlainWheel {
  std::vector<sensor::ModelEquation> equations{{.K1 = 0.0336}};  ///< of one axis or two
  std::function<double(double)> angle = [](double t) { return 1.152 * t + 0.7; };
  double duration_s = 200.0, rate_hz = 50.0;
  double radius_m = 0.0;
  double mounting_rad = 0.0;              ///< of the first axis, relative to the spoke
  double white = 0.0;                     ///< per sample, in the unit of the output
  double coloured = 0.0, memory_s = 1.0;  ///< additional first-order Markov noise
  unsigned seed = 1;
  bool give_angle = false;
  int hand = 1;  ///< −1: the second axis lags
};

/// f = gravity minus acceleration in the wheel's frame, for each axis.
inline RotationRecording turned(const PlainWheel& wheel) {
  constexpr double g = standard_gravity_mps2, h = 1e-3;
  std::mt19937 random(wheel.seed);
  std::normal_distribution<double> normal;
  RotationRecording recording{"wheel", {}, {}, {}};
  recording.axes.resize(wheel.equations.size());
  std::vector<double> markov(wheel.equations.size());
  for (double& m : markov) m = wheel.coloured * normal(random);
  const double keep = std::exp(-1.0 / (wheel.rate_hz * wheel.memory_s));
  const auto samples = static_cast<int>(wheel.duration_s * wheel.rate_hz);
  for (int k = 0; k < samples; ++k) {
    const double t = k / wheel.rate_hz, theta = wheel.angle(t);
    const double omega = (wheel.angle(t + h) - wheel.angle(t - h)) / (2.0 * h);
    const double alpha = (wheel.angle(t + h) - 2.0 * theta + wheel.angle(t - h)) / (h * h);
    const double out = g * std::sin(theta) - wheel.radius_m * omega * omega;
    const double on = g * std::cos(theta) + wheel.radius_m * alpha;
    recording.time_s.push_back(t);
    if (wheel.give_angle) recording.angle_rad.push_back(theta);
    const double c = std::cos(wheel.mounting_rad), s = std::sin(wheel.mounting_rad);
    const double first = c * out + s * on, second = -s * out + c * on;
    for (std::size_t axis = 0; axis < wheel.equations.size(); ++axis) {
      const int sign = axis == 1 ? wheel.hand : 1;
      const sensor::Motion motion{.ai_mps2 = axis == 0 ? first : sign * second,
                                  .ap_mps2 = axis == 0 ? wheel.hand * second : -first};
      markov[axis] =
          keep * markov[axis] + wheel.coloured * std::sqrt(1.0 - keep * keep) * normal(random);
      recording.axes[axis].push_back(sensor::output(wheel.equations[axis], motion) +
                                     wheel.white * normal(random) + markov[axis]);
    }
  }
  return recording;
}

inline RotationFit fit_of(const std::vector<RotationRecording>& recordings) {
  return fit_rotation(recordings, {.gravity_mps2 = standard_gravity_mps2}).value();
}

}  // namespace proofmass::calibrate
