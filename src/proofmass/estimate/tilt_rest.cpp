#include "proofmass/estimate/tilt_rest.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "proofmass/core/chi_square.hpp"
#include "proofmass/core/statistics.hpp"
#include "proofmass/sensor/noise_conversions.hpp"

namespace proofmass::estimate {
namespace {

constexpr std::size_t batches = 40;

double span_s(const TiltRecord& record, const signal::Rest& samples) {
  if (record.time_s.empty()) return 0.0;
  return record.time_s[samples.last] - record.time_s[samples.first];
}

}  // namespace

StretchMean stretch_mean(View<double> values, double step) {
  std::vector<double> finite;
  finite.reserve(values.size());
  for (const double value : values)
    if (std::isfinite(value)) finite.push_back(value);
  StretchMean out;
  out.count = finite.size();
  if (finite.empty()) return out;
  const Moments all = moments(finite);
  out.mean = all.mean;
  out.scatter = square(all.std());
  const std::size_t length = finite.size() < 4 * batches ? 1 : finite.size() / batches;
  Moments means;
  for (std::size_t first = 0; first + length <= finite.size(); first += length)
    means.add(moments(View<double>(finite).subspan(first, length)).mean);
  if (means.count > 1) {
    const auto count = static_cast<double>(means.count);
    const double wider = student_t_quantile(0.975, count - 1.0) / 1.959964;
    out.variance = square(wider * means.std()) / count;
  }
  if (std::sqrt(out.scatter) < 0.5 * step) out.variance += step * step / 12.0;
  return out;
}

double least_step(View<double> values) {
  std::vector<double> sorted;
  sorted.reserve(values.size());
  for (const double value : values)
    if (std::isfinite(value)) sorted.push_back(value);
  std::ranges::sort(sorted);
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 1; k < sorted.size(); ++k) {
    const double step = sorted[k] - sorted[k - 1];
    // Below it lies what conversion of units leaves between equal readings.
    if (step > 1e-9 * std::max(1.0, std::abs(sorted[k]))) least = std::min(least, step);
  }
  return std::isfinite(least) ? least : 0.0;
}

ForceSpread::ForceSpread(const TiltOptions& options) {
  if (options.calibration) {
    calibration_ = CalibrationSpread::of(*options.calibration);
    if (options.calibration->alignment_std)
      alignment_variance_ = square(options.calibration->alignment_std->si());
  }
  if (!calibration_) bias_variance_ = square(options.bias_std_mps2);
}

Mat<3, 3> ForceSpread::calibration(const Mat<3>& force) const {
  if (calibration_) return calibration_->at(force);
  return bias_variance_ * Mat<3, 3>::Identity();
}

Mat<3, 3> ForceSpread::alignment(const Mat<3>& force) const {
  return alignment_variance_ *
         (force.squaredNorm() * Mat<3, 3>::Identity() - force * force.transpose());
}

TiltAngles ForceSpread::angles(const Mat<3>& force, const Mat<3, 3>& noise) const {
  return angles_of(force, noise + calibration(force) + alignment(force));
}

double direction_std_rad(const Mat<3>& force, const Mat<3, 3>& cov) {
  const Mat<3> up = force.normalized();
  const double across = cov.trace() - up.dot(cov * up);
  return std::sqrt(std::max(0.0, 0.5 * across)) / force.norm();
}

double slow_variance(const sensor::NoiseModel& noise, std::size_t axis, double span_s) {
  double variance = 0.0;
  if (noise.flicker[axis]) variance += sensor::flicker_plateau * square(noise.flicker[axis]->si());
  if (noise.random_walk[axis]) variance += square(noise.random_walk[axis]->si()) * span_s / 3.0;
  return variance;
}

TiltRest rest_of(const TiltRecord& record,
                 const TiltOptions& options,
                 const signal::Rest& samples,
                 const std::array<double, 3>& steps) {
  TiltRest rest{.first = samples.first, .last = samples.last};
  Mat<3, 3> noise = Mat<3, 3>::Zero();
  rest.force_mps2.setConstant(std::numeric_limits<double>::quiet_NaN());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (record.accel_mps2[axis].empty()) continue;
    const StretchMean mean = stretch_mean(
        View<double>(record.accel_mps2[axis]).subspan(rest.first, rest.last - rest.first + 1),
        steps[axis]);
    if (mean.count == 0) continue;
    const auto row = static_cast<Eigen::Index>(axis);
    rest.force_mps2(row) = mean.mean;
    noise(row, row) = mean.variance + slow_variance(options.noise, axis, span_s(record, samples));
  }
  const ForceSpread spread(options);
  const Mat<3> known = rest.force_mps2.array().isFinite().select(rest.force_mps2, 0.0);
  const Mat<3, 3> calibration = spread.calibration(known), alignment = spread.alignment(known);
  const Mat<3, 3> cov = noise + calibration + alignment;
  if (known.norm() > 0.0)
    rest.angles = angles_of_some(rest.force_mps2, cov, options.gravity_mps2);
  else
    rest.angles.why_no_roll = rest.angles.why_no_pitch = "the force is zero";
  if (rest.force_mps2.allFinite() && known.norm() > 0.0) {
    rest.shares = {.noise = direction_std_rad(known, noise),
                   .calibration = direction_std_rad(known, calibration),
                   .alignment = direction_std_rad(known, alignment)};
    const Mat<3> up = known.normalized();
    rest.norm_mps2 = Uncertain{known.norm(), std::sqrt(up.dot((noise + calibration) * up))};
  }
  return rest;
}

}  // namespace proofmass::estimate
