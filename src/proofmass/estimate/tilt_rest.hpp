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
  double variance = 0.0;  ///< of the mean
  double scatter = 0.0;   ///< variance of one reading
  std::size_t count = 0;  ///< finite readings
};

/// The mean of the finite values, and its variance by the scatter of the means of 40 batches (of
/// single values where there are fewer than 160), widened to Student's t: correlation within a
/// batch is counted, what wanders more slowly is not. Where the values scatter by less than half a
/// step of the converter, step²/12 is added for what rounding hides.
/// Source: C. J. Geyer, Statist. Sci. 7 (1992) 473, section 3.2, for batch means.
[[nodiscard]] StretchMean stretch_mean(View<double> values, double step);

/// Least distance between different values, the converter's step; 0 where all are equal.
/// Cost: O(N log N).
[[nodiscard]] double least_step(View<double> values);

/// What calibration and mounting leave open in a force, whatever is read.
class ForceSpread {
 public:
  explicit ForceSpread(const TiltOptions& options);

  /// (m/s²)²: of the calibration where it has one, else of the bias that the options state.
  [[nodiscard]] Mat<3, 3> calibration(const Mat<3>& force) const;
  /// (m/s²)²: σ² (|f|² 1 − f fᵀ) of the angle between axes and case.
  [[nodiscard]] Mat<3, 3> alignment(const Mat<3>& force) const;
  /// Of a force whose own noise leaves this covariance, all three together.
  [[nodiscard]] TiltAngles angles(const Mat<3>& force, const Mat<3, 3>& noise) const;
  [[nodiscard]] bool knows_calibration() const { return calibration_.has_value(); }

 private:
  std::optional<CalibrationSpread> calibration_;
  double bias_variance_ = 0.0, alignment_variance_ = 0.0;
};

/// Standard deviation in rad of a direction, rms of the two across it.
[[nodiscard]] double direction_std_rad(const Mat<3>& force, const Mat<3, 3>& cov);

/// What the sensor file's flicker and walk add to the variance of a mean over so many seconds,
/// (2 ln2/π) B² + K² T/3.
[[nodiscard]] double slow_variance(const sensor::NoiseModel& noise,
                                   std::size_t axis,
                                   double span_s);

/// The rest that these samples are; `steps` are the converter's, for each axis.
[[nodiscard]] TiltRest rest_of(const TiltRecord& record,
                               const TiltOptions& options,
                               const signal::Rest& samples,
                               const std::array<double, 3>& steps);

}  // namespace proofmass::estimate
