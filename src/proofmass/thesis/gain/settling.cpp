#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <string>
#include <utility>

#include "proofmass/report/wording.hpp"
#include "proofmass/thesis/gain/figures.hpp"
#include "proofmass/thesis/gain/parts.hpp"
#include "proofmass/thesis/gain/readings.hpp"

namespace proofmass::thesis {
namespace {

using estimate::GainStudy;
using estimate::GainStudyOptions;
using report::fixed;

std::optional<Uncertain> exact(const std::optional<double>& value) {
  return value ? std::optional(Uncertain{*value}) : std::nullopt;
}

std::string settled_words(const std::optional<double>& time_s) {
  return time_s ? fixed(*time_s, 1) + " s" : "not within the time";
}

// The last of the three.
std::optional<double> all_settled_s(const GainStudy& study, double within) {
  double last_s = 0.0;
  for (std::size_t state = 0; state < 3; ++state) {
    const auto time_s = settling_s(study, state, within);
    if (!time_s) return std::nullopt;
    last_s = std::max(last_s, *time_s);
  }
  return last_s;
}

std::vector<Finding> settling_findings(const Half& half, const GainStudy& study) {
  const FilterResponse response = filter_response(study, simulated_radps);
  std::vector<Finding> findings{{.key = "settling",
                                 .label = "All gains within 2 % of their limits",
                                 .si_unit = "s",
                                 .shown = shown_seconds,
                                 .thesis = half.printed_settling_s,
                                 .ours = exact(all_settled_s(study, 0.02))},
                                {.key = "settling_fine",
                                 .label = "All gains within 0.1 % of their limits",
                                 .si_unit = "s",
                                 .shown = shown_seconds,
                                 .thesis = half.printed_settling_s,
                                 .ours = exact(all_settled_s(study, 1e-3))},
                                {.key = "settling_acceleration",
                                 .label = "Gain of the acceleration within 2 %",
                                 .si_unit = "s",
                                 .shown = shown_seconds,
                                 .ours = exact(study.settling_s[2])},
                                {.key = "time_constant",
                                 .label = "Time in which an error of the acceleration falls to 1/e",
                                 .si_unit = "s",
                                 .shown = shown_seconds,
                                 .ours = exact(response.time_constant_s)},
                                {.key = "error_to_2_percent",
                                 .label = "Time in which it falls to 2 %",
                                 .si_unit = "s",
                                 .shown = shown_seconds,
                                 .ours = exact(-std::log(0.02) * response.time_constant_s)},
                                {.key = "gain",
                                 .label = "Gain of the acceleration in the end",
                                 .si_unit = "",
                                 .shown = plain,
                                 .ours = exact(study.limit[2])},
                                {.key = "variance",
                                 .label = "Variance of the acceleration in the end",
                                 .si_unit = "m^2/s^4",
                                 .shown = variance,
                                 .ours = exact(study.limit_variance_m2ps4)}};
  const auto& last = study.epochs.back().variance;
  findings.push_back({.key = "velocity_std",
                      .label = "Standard deviation of the velocity after 100 s",
                      .si_unit = "m/s",
                      .shown = {.symbol = "m/s"},
                      .ours = exact(std::sqrt(last[1]))});
  findings.push_back({.key = "position_std",
                      .label = "Standard deviation of the position after 100 s",
                      .si_unit = "m",
                      .shown = {.symbol = "m"},
                      .ours = exact(std::sqrt(last[0]))});
  return findings;
}

// What the thesis's Q can be: it gives no unit.
report::Table meaning_table(const Half& half) {
  report::Table table{.caption = "What Q may mean",
                      .head = {"Q is", "Gain in the end", "Time constant (s)",
                               "Settled to 2 %: acceleration, velocity, position"},
                      .rows = {}};
  GainStudyOptions per_step = half.options;
  per_step.jerk_psd_m2ps5 /= per_step.step_s;
  const std::array<std::pair<const char*, GainStudyOptions>, 2> readings{
      {{"density of the jerk, m²/s⁵ (as here)", half.options},
       {"variance that a step adds to the acceleration, m²/s⁴", per_step}}};
  for (const auto& [words, options] : readings) {
    const GainStudy study = gain_study(options);
    table.rows.push_back(
        {words, fixed(study.limit[2], 3),
         fixed(filter_response(study, simulated_radps).time_constant_s, 2),
         fmt::format("{}, {}, {}", settled_words(study.settling_s[2]),
                     settled_words(study.settling_s[1]), settled_words(study.settling_s[0]))});
  }
  return table;
}

}  // namespace

Item settling_item(const Half& half) {
  const GainStudy study = gain_study(half.options);
  const FilterResponse response = filter_response(study, simulated_radps);
  const bool quick = half.printed_settling_s < 5.0;
  Item item{
      .id = half.gain_id,
      .title = "Kalman gain and error covariance, " + half.relation,
      .thesis = quick ? "“The error settles within two seconds and filter converges quickly.”"
                      : "The response is disordered “for first ten seconds. It takes approximately "
                        "eight seconds to settle the error in the measurement”.",
      .ours = fmt::format(
          "Within 2 % of their limits are the gains of acceleration, velocity and position after "
          "{}, {} and {}; within 0.1 % all three after {}. An error of the acceleration falls to "
          "1/e in {} s. The standard deviation of the position is {} m after 100 s and grows.",
          settled_words(study.settling_s[2]), settled_words(study.settling_s[1]),
          settled_words(study.settling_s[0]), settled_words(all_settled_s(study, 1e-3)),
          fixed(response.time_constant_s, 2), fixed(std::sqrt(study.epochs.back().variance[0]), 0)),
      .note = fmt::format(
          "Gain and covariance depend on Q, R and the step and on no measurement, so there is "
          "nothing "
          "disordered in them. The thesis does not say what it calls settled, nor the unit of Q. "
          "Its {} s are {} time constants of the filter; the other case's are as many, so the "
          "two go together if Q is the density of the jerk and settled means to about 0.1 %. "
          "State the tolerance, or state the time constant.",
          fixed(half.printed_settling_s, 0),
          fixed(half.printed_settling_s / response.time_constant_s, 1)),
      .findings = settling_findings(half, study),
      .tables = {meaning_table(half)},
      .figures = {gain_figure(study), quick ? growth_figure(study) : tolerance_figure()}};
  return item;
}

}  // namespace proofmass::thesis
