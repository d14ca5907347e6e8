#include "proofmass/estimate/tilt/epochs.hpp"

#include <algorithm>
#include <cmath>

#include "proofmass/core/statistics.hpp"
#include "proofmass/estimate/tilt/record.hpp"
#include "proofmass/estimate/tilt/rest.hpp"

namespace proofmass::estimate {
namespace {

// Variation with attitude of the norm of a calibrated sensor's measurements at rest.
constexpr double calibrated_norm_std_mps2 = 5e-3;

// Standard deviation of white noise with the low-frequency density of the longest rest.
Mat<3> rest_std(const std::array<std::vector<double>, 3>& axes,
                const TiltSolution& solution,
                double least) {
  Mat<3> out = Mat<3>::Constant(least);
  const auto longest = std::ranges::max_element(
      solution.rests, {}, [](const TiltRest& rest) { return rest.last - rest.first; });
  if (longest == solution.rests.end()) return out;
  for (std::size_t i = 0; i < 3; ++i) {
    const StretchMean mean = stretch_mean(
        View<double>(axes[i]).subspan(longest->first, longest->last - longest->first + 1), 0.0);
    const double variance = std::max(mean.scatter, mean.variance * static_cast<double>(mean.count));
    out(static_cast<Eigen::Index>(i)) = std::max(least, std::sqrt(variance));
  }
  return out;
}

}  // namespace

double longest_bridge_s(double usual_step_s) {
  constexpr double steps = 5.0, least_s = 0.2;
  return std::max(steps * usual_step_s, least_s);
}

Mat<3> rate_over(const Mat<3>& before, const Mat<3>& now, double step_s, double longest_s) {
  if (step_s > longest_s) return Mat<3>::Constant(no_value);
  if (!now.allFinite()) return before;
  if (!before.allFinite()) return now;
  return 0.5 * (now + before);
}

TiltEpochs epochs_of(const TiltRecord& record, const TiltSolution& solution) {
  TiltEpochs out;
  const bool rates = has_rates(record);
  std::vector<double> steps(1, 0.0);
  for (std::size_t k = 1; k < solution.samples; ++k)
    steps.push_back(record.time_s[k] - record.time_s[k - 1]);
  const double usual_s = median(View<double>(steps).subspan(1)).value_or(0.0);
  const double longest = longest_bridge_s(usual_s);
  out.resting = solution.series.resting;
  for (std::size_t k = 0; k < solution.samples; ++k) {
    out.force_mps2.push_back(vector_at(record.accel_mps2, k));
    if (!rates) continue;
    const Mat<3> now = vector_at(record.rate_radps, k);
    const Mat<3> before = k == 0 ? now : out.rate_at_radps.back();
    out.rate_at_radps.push_back(now);
    out.rate_radps.push_back(rate_over(before, now, steps[k], longest));
  }
  out.step_s = std::move(steps);
  return out;
}

std::size_t drop_held(TiltEpochs& epochs) {
  const std::size_t size = epochs.force_mps2.size();
  std::vector<std::size_t> repeats;
  std::size_t moving = 0;
  for (std::size_t k = 1; k < size; ++k) {
    if (epochs.resting[k] != 0 || !epochs.force_mps2[k].allFinite()) continue;
    ++moving;
    const bool same_rate =
        epochs.rate_at_radps.empty() || epochs.rate_at_radps[k] == epochs.rate_at_radps[k - 1];
    if (same_rate && epochs.force_mps2[k] == epochs.force_mps2[k - 1]) repeats.push_back(k);
  }
  if (2 * repeats.size() < moving) return 0;
  for (const std::size_t k : repeats) epochs.force_mps2[k].setConstant(no_value);
  return repeats.size();
}

TiltKnown known_of(const TiltRecord& record,
                   const TiltOptions& options,
                   const TiltSolution& solution,
                   const TiltEpochs& epochs) {
  TiltKnown known{.gravity_mps2 = options.gravity_mps2.value,
                  .gravity_std_mps2 = options.gravity_mps2.std,
                  .rest_std_mps2 = rest_std(record.accel_mps2, solution, 1e-4),
                  .rate_bias_std_radps = options.rate_bias_std_radps,
                  .rate_bias_walk_radps_rts = options.rate_bias_walk_radps_rts};
  if (options.calibration) known.norm_std_mps2 = calibrated_norm_std_mps2;
  if (solution.norm_std_mps2 > 0.0) known.norm_std_mps2 = solution.norm_std_mps2;
  std::vector<double> norms;
  for (const TiltRest& rest : solution.rests)
    if (rest.norm_mps2) norms.push_back(rest.norm_mps2->value);
  if (const auto norm = median(norms)) {
    known.gravity_mps2 = *norm;
    known.gravity_std_mps2 = 0.0;
  }
  if (!has_rates(record)) return known;
  known.rest_rate_std_radps = rest_std(record.rate_radps, solution, 1e-5);
  const double step_s = median(View<double>(epochs.step_s).subspan(1)).value_or(0.0);
  if (!solution.rests.empty())
    known.rate_noise_radps_rthz = known.rest_rate_std_radps.maxCoeff() * std::sqrt(step_s);
  known.rate_scale_std = options.rate_scale_std;
  std::vector<double> rates;
  for (const Mat<3>& rate : epochs.rate_at_radps)
    if (rate.allFinite()) rates.push_back(rate.norm());
  known.usual_rate_radps = std::max(0.05, quantile(rates, 0.9).value_or(1.0));
  return known;
}

}  // namespace proofmass::estimate
