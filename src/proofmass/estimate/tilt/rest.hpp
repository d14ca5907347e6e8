#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "proofmass/core/view.hpp"
#include "proofmass/estimate/tilt.hpp"
#include "proofmass/estimate/tilt/calibration.hpp"

// The direction of gravity over a rest.
namespace proofmass::estimate {

/// Mean of a stretch and its variance.
struct StretchMean {
  double mean = 0.0;
  double variance = 0.0;  ///< of the mean, from its noise
  double scatter = 0.0;   ///< variance of one measurement
  double rounding = 0.0;  ///< variance of the mean due to quantisation
  std::size_t count = 0;  ///< finite measurements
};

/// The mean of the finite values, and its variance from the scatter of the means of 40 batches (of
/// single values if there are fewer than 160), widened to Student's t. Significant correlation
/// between batches is included by the initial positive sequence; drift as slow as the stretch
/// itself is included only in part. Source: C. J. Geyer, Statist. Sci. 7 (1992) 473, sections 3.2
/// and 3.3.
[[nodiscard]] StretchMean stretch_mean(View<double> values, double step);

/// Quantisation step of each axis, 0 if it appears continuous: as stated by the record or else
/// estimated from its values. An axis with a constant value is assigned the largest step of the
/// others; nullopt if there is none.
[[nodiscard]] std::optional<std::array<double, 3>> converter_steps(const TiltRecord& record);

/// Force uncertainty due to calibration and mounting, independent of the noise.
class ForceSpread {
 public:
  /// `rounding_m2ps4`: variance of each axis due to quantisation.
  explicit ForceSpread(const TiltOptions& options, const Mat<3>& rounding_m2ps4 = Mat<3>::Zero());

  /// (m/s²)²: from the calibration, the additional bias uncertainty in the options, and
  /// quantisation.
  [[nodiscard]] Mat<3, 3> calibration(const Mat<3>& force) const;
  /// (m/s²)²: σ² (|f|² 1 − f fᵀ), from the angle between axes and case.
  [[nodiscard]] Mat<3, 3> alignment(const Mat<3>& force) const;
  /// Angles of a force with this noise covariance, including all three.
  [[nodiscard]] TiltAngles angles(const Mat<3>& force, const Mat<3, 3>& noise) const;
  [[nodiscard]] bool knows_calibration() const { return calibration_.has_value(); }

 private:
  std::optional<CalibrationSpread> calibration_;
  Mat<3> beside_;
  double alignment_variance_ = 0.0;
};

/// Standard deviation in rad of a direction, rms of the two across it.
[[nodiscard]] double direction_std_rad(const Mat<3>& force, const Mat<3, 3>& cov);

/// Variance of a mean over `duration_s` due to the sensor file's flicker and random walk, (2 ln2/π)
/// B² + K² T/3.
[[nodiscard]] double slow_variance(const sensor::NoiseModel& noise,
                                   std::size_t axis,
                                   double span_s);

/// The rest over these samples; `steps` as from converter_steps().
[[nodiscard]] TiltRest rest_of(const TiltRecord& record,
                               const TiltOptions& options,
                               const signal::Rest& samples,
                               const std::optional<std::array<double, 3>>& steps);

}  // namespace proofmass::estimate
