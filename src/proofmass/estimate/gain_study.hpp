#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "proofmass/core/view.hpp"

// Settling of a filter's gain and covariance, and the effect of the step length on them.
namespace proofmass::estimate {

struct GainStudyOptions {
  double jerk_psd_m2ps5 = 1.0;        ///< Q per second
  double accel_variance_m2ps4 = 1.0;  ///< R
  double step_s = 0.2;
  double duration_s = 100.0;
  double prior_variance = 100.0;  ///< P₀ of position, velocity and acceleration alike
};

/// One epoch, after its measurement.
struct GainEpoch {
  double t_s = 0.0;
  std::array<double, 3> gain{};      ///< of position, velocity, acceleration
  std::array<double, 3> variance{};  ///< P⁺, diagonal
};

struct GainStudy {
  GainStudyOptions options;
  std::vector<GainEpoch> epochs;
  std::array<double, 3> limit{};      ///< limits of the gains
  double limit_variance_m2ps4 = 0.0;  ///< limit of the acceleration's variance
  /// For each gain: the time after which it stays within 2 % of its limit; absent if it does not
  /// within the duration.
  std::array<std::optional<double>, 3> settling_s{};
};

/// Gain and covariance of the PVA filter (pva_model) against time; they do not depend on the
/// measurements. The limits are exact: with Q = W h and ρ = Q/R the acceleration's variance obeys
/// P⁺ = R k, k = (√(ρ² + 4ρ) − ρ)/2. Position and velocity are not observed and their variances
/// grow without bound, but their gains have limits. Source: M. A. Lele (2010), sections 4.1.4 and
/// 5.3, for the study; the definition of settling is ours. Expects positive step and R. Cost:
/// O(duration / step).
[[nodiscard]] GainStudy gain_study(const GainStudyOptions& options);

/// Time after which the gain of a state (0: position) stays within this fraction of its limit;
/// absent if it does not within the duration.
[[nodiscard]] std::optional<double> settling_s(const GainStudy& study,
                                               std::size_t state,
                                               double within);

/// Effect of a step length on the settled gain.
struct StepSizeEffect {
  double step_s = 0.0;
  double gain = 0.0;                 ///< gain of the acceleration
  double accel_std_mps2 = 0.0;       ///< √P⁺
  double predicted_std_mps2 = 0.0;   ///< √P⁻, just before a measurement
  std::optional<double> settling_s;  ///< settling time of the acceleration's gain
};

/// Effects of several step lengths, with R per measurement independent of the step.
[[nodiscard]] std::vector<StepSizeEffect> step_size_study(const GainStudyOptions& options,
                                                          View<double> steps_s);

}  // namespace proofmass::estimate
