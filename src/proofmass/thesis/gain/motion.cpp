#include <array>
#include <fmt/format.h>
#include <optional>
#include <string>
#include <utility>

#include "proofmass/estimate/tune.hpp"
#include "proofmass/report/wording.hpp"
#include "proofmass/thesis/gain/figures.hpp"
#include "proofmass/thesis/gain/parts.hpp"
#include "proofmass/thesis/gain/readings.hpp"

namespace proofmass::thesis {
namespace {

using estimate::GainStudyOptions;
using report::fixed;

constexpr std::size_t sets_of_readings = 40;

const ShownUnit accel{"m/s²"};

struct TunedReadings {
  std::optional<Uncertain> jerk_psd_m2ps5, accel_variance_m2ps4;
};

// What the readings themselves say of Q and R.
TunedReadings tuned(const SimulatedReadings& readings, double step_s) {
  const auto found = estimate::tune(
      {{.name = "x", .rate_hz = 1.0 / step_s, .segments = {View<double>(readings.reading_mps2)}}},
      {.model = estimate::TuneModel::pva});
  TunedReadings out;
  if (!found) return out;
  for (const estimate::TunedParameter& p : found->parameters)
    (p.role == estimate::TuneRole::reading ? out.accel_variance_m2ps4 : out.jerk_psd_m2ps5) =
        p.value;
  return out;
}

void add_errors(const ReadingErrors& errors, const std::string& axis, std::vector<Finding>& all) {
  const std::array<std::pair<const char*, const Uncertain*>, 3> parts{
      {{"readings", &errors.reading},
       {"filter", &errors.filtered},
       {"smoother", &errors.smoothed}}};
  for (const auto& [name, found] : parts)
    all.push_back({.key = fmt::format("rms_{}_{}", name, axis),
                   .label = fmt::format("rms error of the {}, {}", name, axis),
                   .si_unit = "m/s^2",
                   .shown = accel,
                   .ours = *found});
}

std::vector<Finding> tuned_findings(const TunedReadings& found, const GainStudyOptions& options) {
  const char* why = "These measurements do not distinguish it from zero.";
  return {{.key = "tuned_r",
           .label = fmt::format("R that the readings of x themselves show; put in: {}",
                                report::compact(options.accel_variance_m2ps4, 3)),
           .si_unit = "m^2/s^4",
           .shown = variance,
           .ours = found.accel_variance_m2ps4,
           .reason = found.accel_variance_m2ps4 ? "" : why},
          {.key = "tuned_q",
           .label = "Q that the readings of x themselves show",
           .si_unit = "m^2/s^5",
           .shown = {.symbol = "m²/s⁵"},
           .ours = found.jerk_psd_m2ps5,
           .reason = found.jerk_psd_m2ps5 ? "" : why}};
}

std::string tuned_words(const TunedReadings& found) {
  const std::string all =
      "R is the noise of a reading and Q what the motion does: neither is a matter of taste. ";
  if (found.jerk_psd_m2ps5 && found.accel_variance_m2ps4)
    return all + fmt::format("From the readings of x alone the verb tune has R = {} and Q = {}.",
                             report::with_std(*found.accel_variance_m2ps4),
                             report::with_std(*found.jerk_psd_m2ps5));
  return all +
         "From these readings alone the verb tune cannot distinguish the motion from noise, and "
         "reports it; "
         "its R "
         "then holds the variance of both.";
}

std::string followed_words(const Half& half, const ReadingErrors& x, const ReadingErrors& y) {
  return fmt::format(
      "With Q = {}, R = {} the readings are off by {} (x) and {} m/s² (y) rms, the filter by {} "
      "and {}, the smoother by {} and {}; ± is the scatter from one set of readings to another.",
      report::compact(half.options.jerk_psd_m2ps5, 3),
      report::compact(half.options.accel_variance_m2ps4, 3), report::with_std(x.reading),
      report::with_std(y.reading), report::with_std(x.filtered), report::with_std(y.filtered),
      report::with_std(x.smoothed), report::with_std(y.smoothed));
}

}  // namespace

Item readings_item(const Half& half, std::uint64_t seed) {
  const bool quick = half.options.jerk_psd_m2ps5 > half.options.accel_variance_m2ps4;
  const SimulatedReadings x = simulate_readings(half.options, SimulatedAxis::x, seed),
                          y = simulate_readings(half.options, SimulatedAxis::y, seed);
  const ReadingErrors x_errors =
      reading_errors(half.options, SimulatedAxis::x, seed, sets_of_readings);
  const ReadingErrors y_errors =
      reading_errors(half.options, SimulatedAxis::y, seed, sets_of_readings);
  const FilterResponse response = filter_response(gain_study(half.options), simulated_radps);
  const TunedReadings from_readings = tuned(x, half.options.step_s);
  Item item{
      .id = half.readings_id,
      .title = "Simulated acceleration, " + half.relation,
      .thesis = quick ? "100 s of sin t and cos t in steps of 0.2 s with noise; with Q > R the "
                        "filter “detects frequent changes in measurement more accurately”. The "
                        "text has R = 4, Q = 1 here, which is Q < R: (Q, R) = (4, 1) is meant."
                      : "The same with (Q, R) = (1, 4): the filter “did not follow the simulated "
                        "acceleration when R > Q”.",
      .ours = followed_words(half, x_errors, y_errors),
      .note = fmt::format(
          "Of sin t the filter keeps {} % of the amplitude and comes {} s late. {} Its error is "
          "{} of the readings'. Where it may wait, take the smoother, which does not lag. {}",
          fixed(100.0 * response.amplitude, 0), fixed(response.delay_s, 2),
          quick
              ? "It follows, and lets much of the noise through."
              : "So it does follow, at a distance; with four times the noise none follows closely.",
          fixed(x_errors.filtered.value / x_errors.reading.value, 2), tuned_words(from_readings)),
      .findings = {{.key = "amplitude",
                    .label = "Amplitude of sin t after the filter",
                    .si_unit = "",
                    .shown = {.symbol = "%", .to_si = 0.01},
                    .ours = exact(response.amplitude)},
                   {.key = "delay",
                    .label = "Delay of sin t after the filter",
                    .si_unit = "s",
                    .shown = shown_seconds,
                    .ours = exact(response.delay_s)}},
      .figures = {readings_figure(x, SimulatedAxis::x), readings_figure(y, SimulatedAxis::y)}};
  add_errors(x_errors, "x", item.findings);
  add_errors(y_errors, "y", item.findings);
  for (Finding& finding : tuned_findings(from_readings, half.options))
    item.findings.push_back(std::move(finding));
  return item;
}

}  // namespace proofmass::thesis
