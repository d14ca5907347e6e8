#include "proofmass/thesis/wheel/conclusion_items.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <fmt/format.h>
#include <string>
#include <utility>

#include "proofmass/core/statistics.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/report/wording.hpp"
#include "proofmass/thesis/wheel/rig.hpp"
#include "proofmass/thesis/wheel_words.hpp"

namespace proofmass::thesis {
namespace {

std::optional<Uncertain> mean_over(const SpeedStudy& speed, const Pick& pick) {
  const std::vector<double> sizes = sizes_over(speed.runs, pick);
  if (sizes.empty() || sizes.size() < speed.runs.size()) return std::nullopt;
  const Moments over = moments(sizes);
  return Uncertain{over.mean, over.std() / std::sqrt(static_cast<double>(over.count))};
}

/// 1 − b/a of each run's figures, over the runs.
std::optional<Uncertain> reduction(const SpeedStudy& speed, const Pick& a, const Pick& b) {
  std::vector<double> parts;
  for (const RunErrors& run : speed.runs) {
    const auto before = a(run), after = b(run);
    if (!before || !after || *before == 0.0) return std::nullopt;
    parts.push_back(1.0 - std::abs(*after / *before));
  }
  const auto middle = median(parts);
  if (!middle) return std::nullopt;
  // Standard deviation of a median: 1.2533 σ/√n.
  return Uncertain{*middle, 1.2533 * robust_std(parts).value_or(0.0) /
                                std::sqrt(static_cast<double>(parts.size()))};
}

Item conclusion_item(const WheelStudy& study) {
  const SpeedStudy& at = study.at_11rpm();
  using T = ThesisErrors;
  using P = PathError;
  Item item{.id = "section 6.1",
            .title = "What smoothing and the error model gain",
            .thesis =
                "Average position error of 0.10 m after applying the error model; smoothing "
                "reduces the position error by 72 %.",
            .ours = {},
            .note = {}};
  Findings findings;
  findings.why(why_absent(at.turn));
  const auto average = mean_over(at, picked(&RunErrors::roll, &T::filtered, &P::mean_abs));
  const auto smoothing = reduction(at, picked(&RunErrors::roll, &T::filtered, &P::rms),
                                   picked(&RunErrors::roll, &T::smoothed, &P::rms));
  const auto filtering = reduction(at, picked(&RunErrors::roll, &T::integrated, &P::rms),
                                   picked(&RunErrors::roll, &T::smoothed, &P::rms));
  findings.add("average", "Average error over the turn, thesis's filter, gravity cancelled",
               kind::metres, 0.10, average);
  findings.add("smoothing", "Reduction by smoothing: thesis's smoother against its filter",
               kind::percent, 72.0, smoothing);
  findings.add("filtering", "Reduction by filter and smoother against double integration",
               kind::percent, {}, filtering);
  if (!study.simulated)
    findings.why("The smoothed wheel model is what the others are counted from.");
  const auto wheel_smoothing = reduction(at, picked(&RunErrors::wheel_filtered, &P::rms),
                                         picked(&RunErrors::wheel_smoothed, &P::rms));
  const auto wheel_average = mean_over(at, picked(&RunErrors::wheel_smoothed, &P::mean_abs));
  findings.add("wheel_average", "Average error over the turn, wheel model smoothed",
               kind::millimetres, {}, wheel_average);
  findings.add("wheel_smoothing",
               "Reduction by smoothing: wheel model's smoother against its filter", kind::percent,
               {}, wheel_smoothing);
  item.findings = std::move(findings).all();
  item.ours = why_absent(at.turn);
  if (item.ours.empty())
    item.ours = fmt::format(
        "At {} rpm the thesis's filter, gravity cancelled{}, is off by {} on average; its smoother "
        "takes {} off, filter and smoother together {} against double integration.",
        rpm_words(at), study.simulated ? " and the bias known to 2 mg" : "",
        said(average, kind::metres),
        smoothing && smoothing->value < 1e-4 ? "less than 0.01 %" : said(smoothing, kind::percent),
        said(filtering, kind::percent));
  if (study.simulated)
    item.ours += fmt::format(
        " The wheel model smoothed is off by {}, and there smoothing takes {} off its filter's "
        "error.",
        said(wheel_average, kind::millimetres), said(wheel_smoothing, kind::percent));
  item.note =
      "0.10 m is of the size that a bias known to a few mg leaves over one turn at 11 rpm, so this "
      "figure of the thesis is believable for gravity cancelled; its metres of section 5.4 are not "
      "of the same processing. A smoother gains only where later readings say something of earlier "
      "states: of "
      "a "
      "position seen through acceleration alone they do not, whatever Q and R are. 72 % can be the "
      "gain over double integration, from the bias that is taken off." +
      caveats(study);
  return item;
}

std::vector<std::string> setting_row(const WheelStudy& study, std::size_t k) {
  const SpeedStudy& speed = study.speeds[k];
  const double w = speed.turn.mean_speed_radps.value;
  const std::string set = study.simulated ? report::compact(setting_currents_a[k], 2) + " A"
                                          : report::file_name(speed.turn.source);
  std::vector<std::string> row{
      set, speed.turn.set_speed_radps > 0.0 ? rpm_words(speed) + " rpm" : "not stated",
      said(speed.turn.mean_speed_radps, kind::rpm),
      report::with_std(speed.turn.mean_speed_radps, "rad/s"),
      report::fixed(rad_per_turn / w, 3) + " s"};
  if (!speed.turn.radius_m) {
    row.insert(row.end(), {"not known", "not known"});
  } else {
    row.push_back(said(Uncertain{*speed.turn.radius_m * w, 0.0}, kind::speed));
    row.push_back(said(Uncertain{*speed.turn.radius_m * w * w, 0.0}, kind::milli_g));
  }
  row.push_back(said(Uncertain{rim_radius_m * w, 0.0}, kind::speed));
  return row;
}

Item setting_item(const WheelStudy& study) {
  Item item{.id = "table A.1",
            .title = "Speed at each setting of the motor's controller",
            .thesis = "2, 3, 4, 5, 6 and 7 A give 8, 11, 14, 16, 18 and 21 rpm.",
            .ours = {},
            .note = {}};
  Findings findings;
  report::Table table{.caption = "Speeds as the wheel model measures them over one turn",
                      .head = {"Setting", "Set", "Measured", "ω", "A turn takes", "Sensor's speed",
                               "Rω² at the sensor", "Rim's speed (0.15 m)"},
                      .rows = {}};
  double worst = 0.0;
  for (std::size_t k = 0; k < study.speeds.size(); ++k) {
    const SpeedStudy& speed = study.speeds[k];
    table.rows.push_back(setting_row(study, k));
    worst = std::max(worst, std::abs(speed.turn.mean_speed_radps.value - speed.speed_radps));
    if (!study.simulated) {
      findings.add(fmt::format("speed_{}", k + 1),
                   "Speed in " + report::file_name(speed.turn.source), kind::rpm, {},
                   speed.turn.mean_speed_radps);
      continue;
    }
    findings.add(fmt::format("speed_{}_a", setting_currents_a[k]),
                 fmt::format("Speed at {} A", setting_currents_a[k]), kind::rpm,
                 setting_speeds_rpm[k], speed.turn.mean_speed_radps);
  }
  item.tables = {std::move(table)};
  const double slowest = study.speeds.front().turn.mean_speed_radps.value;
  const double fastest = study.speeds.back().turn.mean_speed_radps.value;
  if (const auto radius = study.at_11rpm().turn.radius_m) {
    findings.add("slowest_centripetal", "Rω² at the sensor, slowest", kind::milli_g, {},
                 Uncertain{*radius * slowest * slowest, 0.0});
    findings.add("fastest_centripetal", "Rω² at the sensor, fastest", kind::milli_g, {},
                 Uncertain{*radius * fastest * fastest, 0.0});
  }
  item.findings = std::move(findings).all();
  item.ours = study.simulated
                  ? fmt::format(
                        "The wheel model measures the simulated wheel's speed over one turn within "
                        "{} rpm of what was set, at every setting.",
                        report::significant(worst / radps_per_rpm, 1))
                  : fmt::format("The wheel model measures {} to {} in these recordings.",
                                said(study.speeds.front().turn.mean_speed_radps, kind::rpm),
                                said(study.speeds.back().turn.mean_speed_radps, kind::rpm));
  item.note =
      "The currents are the thesis's: no accelerometer shows them. A speed counted by eye is "
      "good to perhaps 2 %; from gravity's turning it is good to 0.02 % in one turn.";
  return item;
}

}  // namespace

std::vector<Item> conclusion_items(const WheelStudy& study) {
  return {conclusion_item(study), setting_item(study)};
}

}  // namespace proofmass::thesis
