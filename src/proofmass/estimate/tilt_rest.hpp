#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "proofmass/core/view.hpp"
#include "proofmass/estimate/tilt.hpp"
#include "proofmass/estimate/tilt_calibration.hpp"

// The direction of gravity over a rest. Private to the module's tilt*.cpp.
namespace proofmass::estimate {

/// Mean of a stretch and its variance.
struct StretchMean {
  double mean = 0.0;
  double variance = 0.0;  ///< of the mean, by its noise
  double scatter = 0.0;   ///< variance of one measurement
  double rounding = 0.0;  ///< variance of what the converter's steps hide in the mean
  std::size_t count = 0;  ///< finite measurements
};

/// The mean of the finite values, and its variance by the scatter of the means of 40 batches (of
/// single values where there are fewer than 160), widened to Student's t. Correlation from batch to
/// batch, where it is beyond chance, is counted by the initial positive sequence; what drifts as
/// slowly as the stretch lasts shows in part. Source: C. J. Geyer, Statist. Sci. 7 (1992) 473,
/// sections 3.2 and 3.3.
[[nodiscard]] StretchMean stretch_mean(View<double> values, double step);

/// Variance of the error that rounding to multiples of a step leaves in the mean of measurements:
/// step²/12 without noise; Gaussian noise σ leaves (step/π) e^(−2π²(σ/step)²) at most and a sine of
/// where the mean lies, a sine of amplitude A beside it |J₀(2πA/step)| ≤ (1/π) √(step/A) of that,
/// both acting as dither. step²/12 where all but 2 in 1000 are of two codes. Source: B. Widrow, I.
/// Kollár, Quantization Noise (2008), chapter 5 and appendix G.
[[nodiscard]] double rounding_variance(std::vector<double> values, double step);

/// Steps of the converter behind each axis, 0 where it looks continuous: those that the record
/// states or, without, those that its values show. An axis that reads one value throughout is taken
/// to have the largest step of the others; nullopt where there is none.
[[nodiscard]] std::optional<std::array<double, 3>> converter_steps(const TiltRecord& record);

/// What calibration and mounting leave open in a force, whatever is read.
class ForceSpread {
 public:
  /// `rounding_m2ps4`: variance of each axis by the converter's steps.
  explicit ForceSpread(const TiltOptions& options, const Mat<3>& rounding_m2ps4 = Mat<3>::Zero());

  /// (m/s²)²: of the calibration, of the bias beyond it that the options state, and of rounding.
  [[nodiscard]] Mat<3, 3> calibration(const Mat<3>& force) const;
  /// (m/s²)²: σ² (|f|² 1 − f fᵀ) of the angle between axes and case.
  [[nodiscard]] Mat<3, 3> alignment(const Mat<3>& force) const;
  /// Of a force whose own noise leaves this covariance, all three together.
  [[nodiscard]] TiltAngles angles(const Mat<3>& force, const Mat<3, 3>& noise) const;
  [[nodiscard]] bool knows_calibration() const { return calibration_.has_value(); }

 private:
  std::optional<CalibrationSpread> calibration_;
  Mat<3> beside_;
  double alignment_variance_ = 0.0;
};

/// Standard deviation in rad of a direction, rms of the two across it.
[[nodiscard]] double direction_std_rad(const Mat<3>& force, const Mat<3, 3>& cov);

/// What the sensor file's flicker and walk add to the variance of a mean over so many seconds,
/// (2 ln2/π) B² + K² T/3.
[[nodiscard]] double slow_variance(const sensor::NoiseModel& noise,
                                   std::size_t axis,
                                   double span_s);

/// The rest that these samples are; `steps` as of converter_steps().
[[nodiscard]] TiltRest rest_of(const TiltRecord& record,
                               const TiltOptions& options,
                               const signal::Rest& samples,
                               const std::optional<std::array<double, 3>>& steps);

}  // namespace proofmass::estimate
