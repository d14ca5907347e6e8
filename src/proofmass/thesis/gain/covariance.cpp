#include <array>
#include <cmath>
#include <cstddef>
#include <fmt/format.h>
#include <utility>

#include "proofmass/report/wording.hpp"
#include "proofmass/thesis/gain/figures.hpp"
#include "proofmass/thesis/gain/parts.hpp"

namespace proofmass::thesis {
namespace {

using estimate::GainStudy;
using estimate::GainStudyOptions;
using report::fixed;

std::size_t readings_to(const GainStudyOptions& options, double variance_m2ps4) {
  const GainStudy study = gain_study(options);
  std::size_t count = 0;
  while (count < study.epochs.size() && study.epochs[count].variance[2] > variance_m2ps4) ++count;
  return count + 1;
}

// The largest R whose variance is down to 10 after 20 readings; more R, more variance.
double slowest_r_m2ps4() {
  GainStudyOptions options = slow_filter;
  double low = 1.0, high = 1000.0;
  while (high - low > 0.1) {
    options.accel_variance_m2ps4 = 0.5 * (low + high);
    (readings_to(options, 10.0) <= 20 ? low : high) = options.accel_variance_m2ps4;
  }
  return low;
}

double limit_variance_m2ps4(double step_s) {
  GainStudyOptions options = slow_filter;
  options.step_s = step_s;
  return gain_study(options).limit_variance_m2ps4;
}

std::vector<Finding> covariance_findings(double slowest_r) {
  std::vector<Finding> findings{
      {.key = "readings_to_ten_quick",
       .label = "Readings until the variance is below 10 (thesis: within), Q = 4, R = 1",
       .si_unit = "",
       .shown = plain,
       .thesis = 20.0,
       .ours = exact(static_cast<double>(readings_to(quick_filter, 10.0)))},
      {.key = "readings_to_ten_slow",
       .label = "Readings until the variance is below 10 (thesis: within), Q = 1, R = 4",
       .si_unit = "",
       .shown = plain,
       .thesis = 20.0,
       .ours = exact(static_cast<double>(readings_to(slow_filter, 10.0)))},
      {.key = "r_for_twenty",
       .label = "R at which it takes 20 readings, Q = 1",
       .si_unit = "m^2/s^4",
       .shown = variance,
       .ours = exact(slowest_r)}};
  constexpr std::array<std::pair<double, const char*>, 3> steps{
      {{0.05, "0p05"}, {0.2, "0p2"}, {1.0, "1"}}};
  for (const auto& [step_s, name] : steps)
    findings.push_back({.key = fmt::format("limit_variance_{}_s", name),
                        .label = fmt::format("Variance in the end, Q = 1, R = 4, steps of {} s",
                                             report::compact(step_s, 2)),
                        .si_unit = "m^2/s^4",
                        .shown = variance,
                        .ours = exact(limit_variance_m2ps4(step_s))});
  return findings;
}

}  // namespace

Item covariance_item() {
  const double slowest_r = slowest_r_m2ps4();
  const GainStudy study = gain_study(quick_filter);
  const auto& last = study.epochs.back().variance;
  return {
      .id = "figure 4.3",
      .title = "Covariance against time and step",
      .thesis =
          "“As the step size increases, covariance decreases and settles at the value less than "
          "10 within 20 steps”, from P₀ = 100.",
      .ours = fmt::format(
          "The acceleration's variance is below 10 after one reading, be R 1 or 4 m²/s⁴; R would "
          "have to be {} for it to take 20. With the length of the step it grows: {}, {} and {} "
          "m²/s⁴ in the end with steps of 0.05, 0.2 and 1 s (Q = 1, R = 4). Position and "
          "velocity never settle: after 100 s with Q = 4, R = 1 their standard deviations are {} "
          "m and {} m/s, most of it the 10 m/s of P₀, of which no reading takes anything away.",
          report::compact(slowest_r, 3), fixed(limit_variance_m2ps4(0.05), 2),
          fixed(limit_variance_m2ps4(0.2), 2), fixed(limit_variance_m2ps4(1.0), 2),
          fixed(std::sqrt(last[0]), 0), fixed(std::sqrt(last[1]), 0)),
      .note =
          "The sentence holds for the number of steps and for the acceleration alone. It does "
          "not hold for their length: between readings further apart the acceleration changes "
          "more. And it does not hold for what one wants, the position: no reading of an "
          "acceleration says where a body is, so its variance grows from the first step on. Look "
          "at the variance of the state that is asked for.",
      .findings = covariance_findings(slowest_r),
      .figures = {covariance_figure(slowest_r), step_figure(), growth_figure(study)}};
}

}  // namespace proofmass::thesis
