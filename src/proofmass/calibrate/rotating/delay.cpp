#include "proofmass/calibrate/rotating/delay.hpp"

#include <cmath>
#include <fmt/format.h>

#include "proofmass/core/units.hpp"

namespace proofmass::calibrate {
namespace {

using Eigen::Index;

struct SpeedMoments {
  double mean = 0.0, variance = 0.0;  // of φ̇/√ω̄²
};

SpeedMoments speed_moments(const RotationState& state) {
  double sum = 0.0, squares = 0.0, count = 0.0;
  for_each_sample(state, [&](const RotationRecording&, const RotationSample& sample) {
    sum += sample.relative_speed;
    squares += sample.relative_speed * sample.relative_speed;
    count += 1.0;
  });
  const double mean = sum / count;
  return {mean, squares / count - mean * mean};
}

// Corrects the first harmonics for a known delay.
void correct(double phase_rad, Index from, RotationEstimate& estimate) {
  const double gain = 1.0 + 0.5 * phase_rad * phase_rad;
  estimate.harmonics.segment<2>(from + 1) *= gain;
  estimate.blocks.scores.middleRows<2>(from + 1) *= gain;
}

}  // namespace

void judge_delay(RotationState& state) {
  if (!state.angle_given || state.zero == EncoderZero::none) return;
  constexpr double least_spread = 0.2;
  state.delay_determined = speed_moments(state).variance > least_spread * least_spread;
}

void allow_for_delay(const RotationState& state,
                     const RotationOptions& options,
                     RotationEstimate& estimate,
                     RotationFit& fit) {
  constexpr double normal_95 = 1.959964;
  const double speed = std::sqrt(state.mean_square_speed);  // rms
  const double mean = speed_moments(state).mean * speed;
  const bool stated = options.bandwidth_hz > 0.0;
  fit.axes.resize(state.axes);
  for (std::size_t axis = 0; axis < state.axes; ++axis) {
    const Index from = harmonic_count * static_cast<Index>(axis), delay = from + delay_column;
    const double amplitude = estimate.harmonics(from + 1);
    if (state.delay_determined) {
      Eigen::VectorXd gradient = Eigen::VectorXd::Zero(state.size());
      gradient(delay) = -1.0 / (amplitude * speed);
      const double tau = gradient.dot(estimate.harmonics);
      fit.axes[axis].delay_s = Uncertain{tau, estimate.spread_of(gradient, false).std};
      correct(tau * speed, from, estimate);
    } else if (stated) {
      const double tau = 1.0 / (rad_per_turn * options.bandwidth_hz);
      estimate.harmonics(from + 2) += amplitude * tau * mean;
      fit.axes[axis].delay_s = Uncertain{tau, 0.0};
      correct(tau * speed, from, estimate);
    } else {
      const double phase = normal_95 * assumed_delay_std_s * speed;
      Eigen::VectorXd turned = Eigen::VectorXd::Zero(state.size()), weaker = turned;
      turned(from + 2) = amplitude * phase;
      weaker(from + 1) = amplitude * 0.5 * phase * phase;
      estimate.bounds.push_back(turned);
      estimate.bounds.push_back(weaker);
    }
  }
  if (state.delay_determined || stated) return;
  fit.notes.push_back(
      fmt::format("at one speed a delay of the sensor's filter cannot be distinguished from a "
                  "misalignment: {:.2g} mrad for each millisecond; {:.0f} ms are allowed for "
                  "(standard deviation). State the bandwidth of the filter, or record a second "
                  "speed or both senses of rotation",
                  speed, 1e3 * assumed_delay_std_s));
}

}  // namespace proofmass::calibrate
