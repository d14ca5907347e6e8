#include "proofmass/estimate/tilt/rest.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "proofmass/core/chi_square.hpp"
#include "proofmass/core/statistics.hpp"
#include "proofmass/sensor/noise_conversions.hpp"
#include "proofmass/signal/channel_audit.hpp"

namespace proofmass::estimate {
namespace {

constexpr std::size_t batches = 40;

// Dither: causes of transitions between the codes of a converter.
struct Dither {
  double noise = 0.0;  ///< variance of its Gaussian part, steps²
  double sine = 0.0;   ///< amplitude of an additional sine, in steps
};

// From variance and fourth moment, corrected for quantisation (Sheppard): a sine of amplitude A has
// the fourth cumulant −3 A⁴/8, noise none. A sine counts if it is significant.
Dither dither_of(const std::vector<double>& values, double step) {
  const Moments all = moments(values);
  const double raw = square(all.std() / step), variance = std::max(0.0, raw - 1.0 / 12.0);
  double fourth = 0.0;
  for (const double value : values) fourth += square(square((value - all.mean) / step));
  const auto count = static_cast<double>(all.count);
  const double cumulant = fourth / count - raw / 2.0 + 7.0 / 240.0 - 3.0 * square(variance);
  Dither out{.noise = variance};
  if (cumulant > -2.0 * std::sqrt(24.0 / count) * square(variance)) return out;
  out.sine = std::pow(-8.0 / 3.0 * cumulant, 0.25);
  out.noise = std::max(0.0, variance - square(out.sine) / 2.0);
  return out;
}

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

double rounding_variance(std::vector<double> values, double step) {
  if (!(step > 0.0) || values.empty()) return 0.0;
  const double hidden = step * step / 12.0;
  const Dither dither = dither_of(values, step);
  std::ranges::sort(values);
  // If nearly all values have two codes, noise far below the step may cross their border.
  constexpr double nearly_all = 0.998;
  std::size_t most = 0;
  for (std::size_t first = 0, end = 0; first < values.size(); ++first) {
    while (end < values.size() && values[end] < values[first] + 1.5 * step) ++end;
    most = std::max(most, end - first);
  }
  const bool two_codes =
      static_cast<double>(most) >= nearly_all * static_cast<double>(values.size());
  if (two_codes || dither.noise + dither.sine <= 0.0) return hidden;
  constexpr double pi = std::numbers::pi;
  const double left = std::min(1.0, 1.0 / (pi * pi * dither.sine));
  return std::min(hidden, square(step / pi) / 2.0 * left * std::exp(-4.0 * pi * pi * dither.noise));
}

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
  out.rounding = rounding_variance(std::move(finite), step);
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
