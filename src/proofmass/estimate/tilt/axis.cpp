#include "proofmass/estimate/tilt/axis.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "proofmass/core/statistics.hpp"
#include "proofmass/estimate/tilt/axis_model.hpp"

namespace proofmass::estimate {
namespace {

constexpr std::size_t fewest = 50;

Status check(const AxisTiltRecord& record, AxisTiltSolution& solution) {
  const std::size_t size = solution.samples = record.time_s.size();
  if (record.angle_rad.size() != size || record.rate_radps.size() != size)
    return Error{Errc::invalid_argument, "channels of different length"};
  for (std::size_t k = 0; k < size; ++k) {
    if (!std::isfinite(record.time_s[k]) || (k > 0 && record.time_s[k] < record.time_s[k - 1]))
      return Error{Errc::invalid_argument,
                   "time must ascend, but does not at sample " + std::to_string(k)};
    if (!std::isfinite(record.angle_rad[k]) || !std::isfinite(record.rate_radps[k]))
      ++solution.unusable;
  }
  if (size < solution.unusable + fewest)
    return Error{Errc::too_few_samples,
                 "only " + std::to_string(size - solution.unusable) +
                     " samples have both angle and rate: it takes at least 50"};
  return Done{};
}

// The unwrapped angle, for the filter.
std::vector<double> unwrapped(const std::vector<double>& angle_rad) {
  constexpr double turn = 2.0 * std::numbers::pi;
  std::vector<double> out(angle_rad);
  double last = std::numeric_limits<double>::quiet_NaN();
  for (double& angle : out) {
    if (!std::isfinite(angle)) continue;
    if (std::isfinite(last)) angle -= turn * std::round((angle - last) / turn);
    last = angle;
  }
  return out;
}

AxisTiltEpochs epochs_of(const AxisTiltRecord& record) {
  AxisTiltEpochs out;
  out.angle_rad = unwrapped(record.angle_rad);
  out.step_s.push_back(0.0);
  out.rate_radps.push_back(record.rate_radps.front());
  for (std::size_t k = 1; k < record.time_s.size(); ++k) {
    const double now = record.rate_radps[k], before = record.rate_radps[k - 1];
    out.step_s.push_back(record.time_s[k] - record.time_s[k - 1]);
    out.rate_radps.push_back(!std::isfinite(now)      ? before
                             : !std::isfinite(before) ? now
                                                      : 0.5 * (now + before));
  }
  const double longest = 10.0 * median(View<double>(out.step_s).subspan(1)).value_or(0.0);
  for (std::size_t k = 1; k < out.step_s.size(); ++k)
    if (out.step_s[k] > longest) out.rate_radps[k] = std::numeric_limits<double>::quiet_NaN();
  return out;
}

void note(AxisTiltSolution& solution) {
  if (solution.unusable > 0)
    solution.notes.push_back({Severity::warning, std::to_string(solution.unusable) + " of " +
                                                     std::to_string(solution.samples) +
                                                     " samples lack angle or rate"});
  if (!solution.noise.converged)
    solution.notes.push_back(
        {Severity::info, "the search for the noise figures ended before it had converged"});
}

}  // namespace

Result<AxisTiltSolution> estimate_axis_tilt(const AxisTiltRecord& record,
                                            const AxisTiltOptions& options) {
  AxisTiltSolution solution;
  if (Status fits = check(record, solution); !fits) return fits.error();
  const AxisTiltEpochs epochs = epochs_of(record);
  if (options.progress) options.progress("fitting the noise", 0.0);
  solution.noise = fit_axis_noise(epochs, options);
  const AxisTiltModel model(epochs, solution.noise, options);
  AxisTiltSeries& s = solution.series;
  s.time_s = record.time_s;
  for (auto* values : {&s.angle_rad, &s.angle_std_rad, &s.filtered_angle_rad,
                       &s.filtered_angle_std_rad, &s.rate_bias_radps, &s.rate_bias_std_radps})
    values->assign(solution.samples, 0.0);
  s.weight.assign(solution.samples, 0.0F);
  const double step_s = median(View<double>(epochs.step_s).subspan(1)).value_or(0.0);
  ConsistencyCheck check_of({.channels = {"angle"}, .rate_hz = step_s > 0.0 ? 1.0 / step_s : 1.0});
  smooth(
      model, model.start(), axis_gate,
      [&](std::size_t k, const StepOf<AxisTiltModel>& step) {
        s.filtered_angle_rad[k] = step.filtered.mean(0);
        s.filtered_angle_std_rad[k] = std::sqrt(step.filtered.cov(0, 0));
        if (step.count == 0) {
          check_of.miss(0);
          return;
        }
        const Update<3>& u = step.updates[0];
        check_of.add(0, u.innovation, u.expected, u.used);
        s.weight[k] = static_cast<float>(u.expected / u.variance);
        if (u.expected < 0.5 * u.variance) ++solution.down_weighted;
      },
      [&](std::size_t k, const StepOf<AxisTiltModel>& step, const BackwardInformation<3>& later) {
        const Mat<3> mean = later.mean(step.filtered);
        const Mat<2, 2> cov = later.cov<2>(step.filtered);
        s.angle_rad[k] = mean(0);
        s.angle_std_rad[k] = std::sqrt(std::max(0.0, cov(0, 0)));
        s.rate_bias_radps[k] = mean(1);
        s.rate_bias_std_radps[k] = std::sqrt(std::max(0.0, cov(1, 1)));
      });
  solution.angle_rad = {s.angle_rad.back(), s.angle_std_rad.back()};
  solution.rate_bias_radps = {s.rate_bias_radps.back(), s.rate_bias_std_radps.back()};
  solution.consistency = check_of.judge();
  note(solution);
  return solution;
}

}  // namespace proofmass::estimate
