#pragma once

#include <cstddef>
#include <vector>

#include "proofmass/estimate/filter/smoother.hpp"
#include "proofmass/estimate/tilt/axis.hpp"

// One axis as filter/smoother.hpp's StateSpaceModel.
namespace proofmass::estimate {

struct AxisTiltEpochs {
  std::vector<double> step_s;      ///< to this epoch from the previous one; 0 at the first
  std::vector<double> rate_radps;  ///< mean over the step to it; NaN: unknown
  std::vector<double> angle_rad;   ///< NaN where missing
};

/// States θ, b, d and the measurement z = θ + d of tilt/axis.hpp.
class AxisTiltModel {
 public:
  static constexpr int states = 3, moving = 3, channels = 1;

  AxisTiltModel(const AxisTiltEpochs& epochs,
                const AxisTiltNoise& noise,
                const AxisTiltOptions& options);

  [[nodiscard]] std::size_t size() const { return epochs_.step_s.size(); }
  [[nodiscard]] Transition<3, 3> transition(const Mat<3>& x, std::size_t k) const;
  void measure(const Mat<3>& x, std::size_t k, Readings<3, 1>& out) const;
  void reopen(Gaussian<3>& x, std::size_t) const { x.cov = start().x.cov; }
  [[nodiscard]] FilterState<3> start() const;

 private:
  const AxisTiltEpochs& epochs_;
  AxisTiltNoise noise_;
  double rate_bias_std_radps_, rate_scale_std_, usual_rate_radps_ = 0.0;
};

/// ln L of the innovations, with Huber's loss beyond the gate.
[[nodiscard]] double axis_log_likelihood(const AxisTiltEpochs& epochs,
                                         const AxisTiltNoise& noise,
                                         const AxisTiltOptions& options);

/// Maximum-likelihood parameters, each with a normal prior of its logarithm about a usual value
/// (standard deviation 3, a factor of some hundred). For long recordings the first 20 000 epochs
/// are used.
[[nodiscard]] AxisTiltNoise fit_axis_noise(const AxisTiltEpochs& epochs,
                                           const AxisTiltOptions& options);

/// Gate of every pass: measurements are down-weighted beyond three standard deviations.
inline constexpr Gate axis_gate{.huber = 3.0};

}  // namespace proofmass::estimate
