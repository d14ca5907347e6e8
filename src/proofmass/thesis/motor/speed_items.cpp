#include "proofmass/thesis/motor/speed_items.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <fmt/format.h>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "proofmass/core/statistics.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/report/wording.hpp"
#include "proofmass/thesis/wheel/rig.hpp"
#include "proofmass/thesis/wheel_words.hpp"

namespace proofmass::thesis {
namespace {

using report::Ink;
using report::Mark;
using Runs = std::vector<RunErrors> SpeedStudy::*;

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// One estimator's error after one revolution.
struct Method {
  const char *key, *label;
  Runs runs;
  Pick end;
  Ink ink;
  Mark mark = Mark::line;
};

std::vector<Method> methods() {
  using R = RunErrors;
  using T = ThesisErrors;
  const auto thesis = [](auto which, auto method) {
    return picked(which, method, &PathError::end);
  };
  const auto wheel = [](auto which) { return picked(which, &PathError::end); };
  return {
      {"gravity", "thesis's filter and smoother, gravity left in", &SpeedStudy::runs,
       thesis(&R::roll_gravity, &T::smoothed), Ink::purple},
      {"integrated", "double integration, gravity cancelled", &SpeedStudy::runs,
       thesis(&R::roll, &T::integrated), Ink::red, Mark::dashes},
      {"thesis", "thesis's filter and smoother, gravity cancelled", &SpeedStudy::runs,
       thesis(&R::roll, &T::smoothed), Ink::orange},
      {"wheel_filtered", "wheel model, filter", &SpeedStudy::runs, wheel(&R::wheel_filtered),
       Ink::green},
      {"wheel_smoothed", "wheel model, smoother", &SpeedStudy::runs, wheel(&R::wheel_smoothed),
       Ink::blue},
      {"thesis_datasheet", "thesis's filter and smoother, datasheet errors", &SpeedStudy::datasheet,
       thesis(&R::roll, &T::smoothed), Ink::orange, Mark::dashes},
      {"wheel_datasheet", "wheel model, smoother, datasheet errors", &SpeedStudy::datasheet,
       wheel(&R::wheel_smoothed), Ink::blue, Mark::dashes},
      {"wheel_moved_datasheet", "the same, way since the start", &SpeedStudy::datasheet,
       wheel(&R::wheel_moved), Ink::grey, Mark::dashes},
  };
}

std::vector<const SpeedStudy*> studied(const WheelStudy& study) {
  std::vector<const SpeedStudy*> out;
  for (const SpeedStudy& speed : study.speeds)
    if (!speed.runs.empty()) out.push_back(&speed);
  return out;
}

/// Figures of one method against the speed.
struct SpeedCurve {
  report::Curve mean;
  report::Band band;
};

/// nullopt where it has no error anywhere.
std::optional<SpeedCurve> speed_curve(const WheelStudy& study, const Method& method) {
  SpeedCurve out{
      .mean = {.label = method.label, .x = {}, .y = {}, .ink = method.ink, .mark = method.mark},
      .band = {.label = {}, .x = {}, .lower = {}, .upper = {}, .ink = method.ink}};
  bool any = false;
  for (const SpeedStudy* speed : studied(study)) {
    const auto rms = rms_over(speed->*method.runs, method.end);
    const std::vector<double> sizes = sizes_over(speed->*method.runs, method.end);
    out.mean.x.push_back(speed->speed_radps / radps_per_rpm);
    out.mean.y.push_back(rms ? rms->value : none);
    out.band.lower.push_back(quantile(sizes, 0.05).value_or(none));
    out.band.upper.push_back(quantile(sizes, 0.95).value_or(none));
    any = any || (rms && rms->value > 0.0);
  }
  if (!any) return std::nullopt;
  out.band.x = out.mean.x;
  if (out.mean.x.size() < 2) out.mean.mark = Mark::points;
  return out;
}

report::Figure speed_figure(const WheelStudy& study) {
  report::Figure figure{
      .title = "Error after one revolution against speed",
      .description = study.simulated
                         ? "Root mean square over the runs at each speed; the areas hold nine runs "
                           "in ten. Datasheet errors: misalignment, cross-axis sensitivity, scale, "
                           "nonlinearity and a tilted axle on top of noise, bias and warm-up."
                         : "Of each recording, counted from the smoothed wheel model.",
      .x = {.label = "Speed (rpm)"},
      .y = {.label = "Error after one revolution (m)", .scale = report::AxisScale::log}};
  figure.height = 420.0;
  for (const Method& method : methods()) {
    std::optional<SpeedCurve> drawn = speed_curve(study, method);
    if (!drawn) continue;
    if (study.simulated && method.mark == Mark::line)
      figure.bands.push_back(std::move(drawn->band));
    figure.curves.push_back(std::move(drawn->mean));
  }
  return figure;
}

/// Share of all runs that end inside the 95 % band, with the std of such a share.
std::optional<Uncertain> inside(const WheelStudy& study,
                                Runs runs,
                                std::optional<PathError> RunErrors::* which) {
  constexpr double two_sided_95 = 1.959964;
  double count = 0.0, held = 0.0;
  for (const SpeedStudy& speed : study.speeds)
    for (const RunErrors& run : speed.*runs) {
      const auto& error = run.*which;
      if (!error || !(error->end_std > 0.0)) continue;
      count += 1.0;
      held += std::abs(error->end) <= two_sided_95 * error->end_std ? 1.0 : 0.0;
    }
  if (count == 0.0) return std::nullopt;
  // Agresti and Coull (1998): no std of 0 where all are inside.
  const double p = (held + 2.0) / (count + 4.0);
  return Uncertain{held / count, std::sqrt(p * (1.0 - p) / (count + 4.0))};
}

report::Table speed_table(const WheelStudy& study) {
  report::Table table{.caption = fmt::format("Error after one revolution, {}", how_counted(study)),
                      .head = {"Estimator"},
                      .rows = {}};
  const auto speeds = studied(study);
  for (const SpeedStudy* speed : speeds) table.head.push_back(rpm_words(*speed) + " rpm");
  for (const Method& method : methods()) {
    std::vector<std::string> row{method.label};
    bool any = false;
    for (const SpeedStudy* speed : speeds) {
      const auto rms = rms_over(speed->*method.runs, method.end);
      any = any || rms;
      row.push_back(!rms                ? "none"
                    : rms->value < 0.01 ? said(rms, kind::millimetres)
                                        : said(rms, kind::metres));
    }
    if (any) table.rows.push_back(std::move(row));
  }
  return table;
}

void add_speed_findings(const WheelStudy& study, Findings& findings) {
  const SpeedStudy& at = study.at_11rpm();
  for (const Method& method : methods()) {
    const bool wheel = std::string_view(method.key).starts_with("wheel");
    findings.why(!study.simulated && method.runs == &SpeedStudy::datasheet
                     ? "This is of simulated runs only."
                 : !study.simulated && wheel
                     ? "The smoothed wheel model is what the others are counted from."
                     : why_absent(at.turn));
    findings.add(method.key, fmt::format("{}, {} rpm", method.label, rpm_words(at)),
                 wheel ? kind::millimetres : kind::metres, {},
                 rms_over(at.*method.runs, method.end));
  }
  findings.why(why_absent(at.turn));
  const auto four = [&](PathError FourteenStateFilter::* which) -> std::optional<Uncertain> {
    if (!study.fourteen_state_filter) return std::nullopt;
    return Uncertain{std::abs(((*study.fourteen_state_filter).*which).end), 0.0};
  };
  findings.add("fourteen_roll", "Fourteen states, y1 and y2 of them, smoothed; one run",
               kind::metres, {}, four(&FourteenStateFilter::roll_smoothed));
  findings.add("fourteen_all", "Fourteen states, mean of all four positions, smoothed; one run",
               kind::metres, {}, four(&FourteenStateFilter::all_smoothed));
  findings.why("Without a truth no share of runs can be counted.");
  findings.add("inside", "Runs that end inside the smoothed wheel model's 95 % band", kind::percent,
               {}, inside(study, &SpeedStudy::runs, &RunErrors::wheel_smoothed));
  findings.add("inside_datasheet", "The same with datasheet errors, of the angle itself",
               kind::percent, {},
               inside(study, &SpeedStudy::datasheet, &RunErrors::wheel_smoothed));
  findings.add("inside_moved_datasheet",
               "The same with datasheet errors, of the way since the start", kind::percent, {},
               inside(study, &SpeedStudy::datasheet, &RunErrors::wheel_moved));
}

}  // namespace

Item speed_item(const WheelStudy& study) {
  const SpeedStudy& at = study.at_11rpm();
  Item item{.id = "figure 5.17",
            .title = "Error after one revolution against speed",
            .thesis =
                "Position error at 11, 14, 16, 18 and 21 rpm before and after filtering; the "
                "figures stand in a plot only. Elsewhere: an average error of 0.10 m.",
            .ours = {},
            .note = {}};
  Findings findings;
  add_speed_findings(study, findings);
  item.findings = std::move(findings).all();
  item.figures = {speed_figure(study)};
  item.tables = {speed_table(study)};
  const auto all = methods();
  const auto metres = [&](std::size_t k) {
    return said(rms_over(at.*all[k].runs, all[k].end), kind::metres);
  };
  const auto millimetres = [&](std::size_t k) {
    return said(rms_over(at.*all[k].runs, all[k].end), kind::millimetres);
  };
  item.ours =
      fmt::format("After one revolution at {} rpm, {}: ", rpm_words(at), how_counted(study));
  if (why_absent(at.turn).empty())
    item.ours += fmt::format("double integration {}, the thesis's filter and smoother {}, ",
                             metres(1), metres(2));
  else
    item.ours += fmt::format("the thesis's filter and smoother, gravity left in, {}, ", metres(0));
  item.ours += fmt::format("the wheel model {} filtered", millimetres(3));
  if (study.simulated)
    item.ours += fmt::format(
        " and {} smoothed. With all errors of the datasheet: thesis {}, wheel model {} of the "
        "place "
        "itself and {} of the way since the start",
        millimetres(4), metres(5), millimetres(6), millimetres(7));
  item.ours += ". " + why_absent(at.turn);
  item.note =
      "Faster is better for whatever integrates, because the turn is over sooner; the wheel model "
      "does not care. Filter and smoother of the thesis agree at the end of a record: nothing "
      "later "
      "is left to learn from. The fourteen states hold nothing that two axes fused do not, and the "
      "mean of all four positions takes in the outward axes, which show no path. ";
  if (study.simulated)
    item.note +=
        "The wheel model's bands are cautious where there are no datasheet errors: the ripple is "
        "smoother than the white snap that stands for it. With datasheet errors its angle is off "
        "by "
        "how the sensor's axes sit against the wheel's mark, which no accelerometer can see; the "
        "band knows of no such thing unless the sensor file states it, and does not hold. The way "
        "since the start is free of it: use that, or state the alignment.";
  item.note += caveats(study);
  return item;
}

}  // namespace proofmass::thesis
