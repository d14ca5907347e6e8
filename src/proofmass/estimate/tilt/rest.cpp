#include "proofmass/estimate/tilt/rest.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "proofmass/core/chi_square.hpp"
#include "proofmass/core/statistics.hpp"
#include "proofmass/sensor/noise_conversions.hpp"
#include "proofmass/signal/channel_audit.hpp"
#include "proofmass/signal/rounding.hpp"

namespace proofmass::estimate {
namespace {

constexpr std::size_t batches = 40;

// Ratio of the variance of a mean to that of independent values: 1 + 2 Σ ρ_k over the positive
// pairs of lags, if the first is significant.
double correlated(const std::vector<double>& means) {
  const Moments all = moments(means);
  const auto count = static_cast<double>(means.size());
  const auto rho = [&](std::size_t lag) {
    double sum = 0.0;
    for (std::size_t k = lag; k < means.size(); ++k)
      sum += (means[k] - all.mean) * (means[k - lag] - all.mean);
    return sum / all.squares;
  };
  if (!(all.squares > 0.0) || rho(1) < 2.0 / std::sqrt(count)) return 1.0;
  double sum = 0.0;
  for (std::size_t lag = 0; lag + 1 < means.size(); lag += 2) {
    const double pair = rho(lag) + rho(lag + 1);
    if (pair <= 0.0) break;
    sum += pair;
  }
  return std::max(1.0, 2.0 * sum - 1.0);
}

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
  const std::size_t length = finite.size() < 4 * batches ? 1 : finite.size() / batches;
  std::vector<double> means;
  for (std::size_t first = 0; first + length <= finite.size(); first += length)
    means.push_back(moments(View<double>(finite).subspan(first, length)).mean);
  if (means.size() > 1) {
    const auto count = static_cast<double>(means.size());
    const double wider = student_t_quantile(0.975, count - 1.0) / 1.959964;
    out.variance = square(wider * moments(means).std()) / count * correlated(means);
  }
  out.scatter = square(all.std());
  out.rounding = signal::rounding_variance(std::move(finite), step);
  return out;
}

std::optional<std::array<double, 3>> converter_steps(const TiltRecord& record) {
  std::array<double, 3> steps{};
  std::array<bool, 3> constant{};
  double largest = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::vector<double>& axis = record.accel_mps2[i];
    if (axis.empty()) continue;
    const auto first = std::ranges::find_if(axis, [](double v) { return std::isfinite(v); });
    constant[i] = first != axis.end() && std::all_of(first, axis.end(), [&](double value) {
                    return value == *first || !std::isfinite(value);
                  });
    steps[i] = record.step_mps2[i] ? *record.step_mps2[i] : signal::find_lsb(axis).value_or(0.0);
    largest = std::max(largest, steps[i]);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    if (!constant[i] || steps[i] > 0.0) continue;
    if (!(largest > 0.0)) return std::nullopt;
    steps[i] = largest;
  }
  return steps;
}

ForceSpread::ForceSpread(const TiltOptions& options, const Mat<3>& rounding_m2ps4)
    : beside_(rounding_m2ps4.array() + square(options.bias_std_mps2.value_or(0.0))) {
  if (!options.calibration) return;
  calibration_ = CalibrationSpread::of(*options.calibration);
  if (options.calibration->alignment_std)
    alignment_variance_ = square(options.calibration->alignment_std->si());
}

Mat<3, 3> ForceSpread::calibration(const Mat<3>& force) const {
  Mat<3, 3> cov = beside_.asDiagonal();
  if (calibration_) cov += calibration_->at(force);
  return cov;
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
                 const std::optional<std::array<double, 3>>& steps) {
  TiltRest rest{.first = samples.first, .last = samples.last};
  Mat<3, 3> noise = Mat<3, 3>::Zero();
  rest.force_mps2.setConstant(std::numeric_limits<double>::quiet_NaN());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (record.accel_mps2[axis].empty()) continue;
    const StretchMean mean = stretch_mean(
        View<double>(record.accel_mps2[axis]).subspan(rest.first, rest.last - rest.first + 1),
        steps ? (*steps)[axis] : 0.0);
    if (mean.count == 0) continue;
    const auto row = static_cast<Eigen::Index>(axis);
    rest.force_mps2(row) = mean.mean;
    rest.rounding_m2ps4(row) = mean.rounding;
    noise(row, row) =
        mean.variance + mean.rounding + slow_variance(options.noise, axis, span_s(record, samples));
  }
  const ForceSpread spread(options);
  const Mat<3> known = rest.force_mps2.array().isFinite().select(rest.force_mps2, 0.0);
  const Mat<3, 3> calibration = spread.calibration(known), alignment = spread.alignment(known);
  const Mat<3, 3> cov = noise + calibration + alignment;
  if (!steps)
    rest.angles.why_no_roll = rest.angles.why_no_pitch =
        "an axis reads one and the same value throughout: it is stuck, or its converter is too "
        "coarse to state an uncertainty";
  else if (known.norm() > 0.0)
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
