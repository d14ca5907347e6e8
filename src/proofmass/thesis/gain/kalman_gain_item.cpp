#include "proofmass/thesis/gain/kalman_gain_item.hpp"

#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "proofmass/estimate/gain_study.hpp"
#include "proofmass/report/wording.hpp"
#include "proofmass/thesis/wheel_words.hpp"

namespace proofmass::thesis {
namespace {

/// ρ = W Δ/R at which the gain of the acceleration settles at k: k²/(1 − k).
double density_over_variance(double gain) {
  return gain * gain / (1.0 - gain);
}

/// Beside the gain of a noise at which it settles where the thesis prints it.
report::Figure gain_figure(const FirstTurn& turn,
                           const std::vector<double>& gain,
                           const estimate::GainStudy& as_printed) {
  const double noise_mps2 = std::sqrt(as_printed.options.accel_variance_m2ps4);
  const double step_s = as_printed.options.step_s;
  std::vector<double> t_s, k;
  for (const estimate::GainEpoch& epoch : as_printed.epochs) {
    t_s.push_back(epoch.t_s);
    k.push_back(epoch.gain[2]);
  }
  report::Figure figure{
      .title = "Gain of the acceleration",
      .description = "What of an innovation goes into the acceleration, against time.",
      .x = {.label = "Time (s)", .scale = report::AxisScale::log, .min = step_s},
      .y = {.label = "Gain", .min = 0.0, .max = 1.05}};
  figure.curves = {
      curve(turn, "corrected filter, R of the sensor", gain, report::Ink::orange),
      {.label = fmt::format("√R = {} mg", report::compact(noise_mps2 / kind::milli_g.to_si, 2)),
       .x = t_s,
       .y = k,
       .ink = report::Ink::blue}};
  figure.levels = {{.label = "as printed", .y = 0.1}};
  return figure;
}

}  // namespace

Item kalman_gain_item(const FirstTurn& turn,
                      const FusedReading& reading,
                      const ThesisPaths& paths) {
  const std::vector<double>& gain = paths.gain;
  const double variance = reading.variance_m2ps4;
  const double step_s = turn.time_s.back() / static_cast<double>(turn.size() - 1);
  const estimate::GainStudy limit =
      estimate::gain_study({.accel_variance_m2ps4 = variance, .step_s = step_s, .duration_s = 2.0});
  const double slow = step_s / density_over_variance(0.1);  // R at W = 1
  const estimate::GainStudy as_printed = estimate::gain_study(
      {.accel_variance_m2ps4 = slow, .step_s = step_s, .duration_s = turn.time_s.back()});
  Item item{.id = "figure 5.16",
            .title = "Kalman gain",
            .thesis = "The gain falls from 1 to 0.1 within the first few seconds.",
            .ours = {},
            .note = {}};
  Findings findings;
  findings.add("first_gain", "Gain of the acceleration at the first reading", kind::plain, 1.0,
               Uncertain{gain.front(), 0.0});
  findings.add("last_gain", "Gain of the acceleration once settled", kind::plain, 0.1,
               Uncertain{gain.back(), 0.0});
  findings.add("limit", "Its limit in closed form", kind::plain, {},
               Uncertain{limit.limit[2], 0.0});
  findings.why("It does not settle within 2 s.");
  findings.add(
      "settling", "Time from which on it stays within 2 % of it", kind::seconds, {},
      limit.settling_s[2] ? std::optional(Uncertain{*limit.settling_s[2], 0.0}) : std::nullopt);
  findings.add("noise", "Noise of the fused readings, √R", kind::milli_g, {},
               Uncertain{std::sqrt(variance), 0.0});
  findings.add("noise_for_0_1", "√R at which W = 1 settles at 0.1", kind::milli_g, {},
               Uncertain{std::sqrt(slow), 0.0});
  findings.add("jerk_for_0_1", "W at which this R settles at 0.1 (m²/s⁵)",
               {"m^2/s^5", "m²/s⁵", 1.0}, {},
               Uncertain{density_over_variance(0.1) * variance / step_s, 0.0});
  item.findings = std::move(findings).all();
  item.figures.push_back(gain_figure(turn, gain, as_printed));
  item.ours = fmt::format(
      "With W = 1 and the sensor's own noise ({} fused) it starts at {} and settles at {}. It "
      "would "
      "come to 0.1 with a noise of {}.",
      said(Uncertain{std::sqrt(variance), 0.0}, kind::milli_g), report::fixed(gain.front(), 3),
      report::fixed(gain.back(), 3), said(Uncertain{std::sqrt(slow), 0.0}, kind::milli_g));
  item.note =
      "The limit is k = (√(ρ² + 4ρ) − ρ)/2 with ρ = W Δ/R and depends on no measurement. A gain of "
      "0.1 "
      "says "
      "that R was set far above the sensor's noise, or that the gain shown is another state's; "
      "it is no sign that the filter \"converges to the true value\".";
  return item;
}

}  // namespace proofmass::thesis
