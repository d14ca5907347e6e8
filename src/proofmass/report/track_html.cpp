#include <fmt/format.h>

#include "proofmass/core/units.hpp"
#include "proofmass/report/consistency_report.hpp"
#include "proofmass/report/page.hpp"
#include "proofmass/report/track_figures.hpp"
#include "proofmass/report/track_report.hpp"
#include "proofmass/report/track_wording.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using estimate::Closure;
using estimate::Stroke;
using estimate::TrackMethod;
using estimate::TrackSolution;

std::string seconds(double t) {
  return fixed(t, 2) + " s";
}

std::string_view verdict(const TrackSolution& solution) {
  if (!solution.smoother) return "no displacement";
  return name_of(solution.consistency.verdict);
}

std::vector<KeyFigure> key_figures(const TrackSolution& solution) {
  const auto summary = summary_of(solution.strokes);
  const auto length = [](const std::optional<Uncertain>& figure) {
    return figure ? length_with_std(*figure) : std::string(absent);
  };
  const auto of_smoother = [&](Uncertain TrackMethod::* figure) {
    return solution.smoother ? std::optional((*solution.smoother).*figure) : std::nullopt;
  };
  return {
      {"Displacement", length(of_smoother(&TrackMethod::displacement_m))},
      {"Strokes", summary ? grouped(summary->count) : "none"},
      {"Median stroke", length(summary ? std::optional(summary->median_length_m) : std::nullopt)},
      {"Farthest from the start", length(of_smoother(&TrackMethod::peak_m))},
      {"Rests", grouped(solution.rests.size())},
      {"Consistency", std::string(verdict(solution))}};
}

Table methods_table(const TrackSolution& solution) {
  Table table{"Along the axis, by each method",
              {"Method", "Displacement", "95 % interval", "Farthest from the start", "Path"},
              {}};
  const auto add = [&](const char* name, const std::optional<TrackMethod>& method) {
    if (!method) return;
    table.rows.push_back({name, length_with_std(method->displacement_m), interval_words(*method),
                          length_with_std(method->peak_m),
                          method->path_std_m
                              ? length_with_std({method->path_m, *method->path_std_m})
                              : length_words(method->path_m)});
  };
  add("Smoother: all readings", solution.smoother);
  add("Filter: readings so far", solution.kalman);
  add("Double integration", solution.double_integration);
  return table;
}

constexpr std::size_t most_rows = 100;

std::string cut_caption(std::string caption, std::size_t rows) {
  if (rows <= most_rows) return caption;
  return fmt::format("{}: the first {} of {}; the JSON document has all", caption, most_rows,
                     grouped(rows));
}

Table strokes_table(const std::vector<Stroke>& strokes) {
  Table table{cut_caption("Each stroke; the length is the mean of both ways, or the shorter where "
                          "they differ by half",
                          strokes.size()),
              {"Stroke", "From", "Turns", "To", "Out", "Back", "Length"},
              {}};
  for (const Stroke& stroke : strokes) {
    if (table.rows.size() == most_rows) break;
    table.rows.push_back({std::to_string(table.rows.size() + 1), seconds(stroke.start_s),
                          stroke.back_m ? seconds(stroke.turn_s) : "one way", seconds(stroke.end_s),
                          length_with_std(stroke.out_m),
                          stroke.back_m ? length_with_std(*stroke.back_m) : "",
                          length_with_std(stroke.length_m)});
  }
  return table;
}

Table closures_table(const std::vector<Closure>& closures) {
  Table table{cut_caption("What was left of the velocity when it stopped", closures.size()),
              {"Motion", "From", "To", "Fastest", "Left over", "Expected, 1 std", "Ratio"},
              {}};
  for (const Closure& closure : closures) {
    if (table.rows.size() == most_rows) break;
    table.rows.push_back({std::to_string(table.rows.size() + 1), seconds(closure.start_s),
                          seconds(closure.end_s), significant(closure.fastest_mps, 2) + " m/s",
                          significant(closure.velocity_mps, 2) + " m/s",
                          significant(closure.expected_std_mps, 2) + " m/s",
                          significant(closure.velocity_mps / closure.expected_std_mps, 2)});
  }
  return table;
}

Section budget_section(const TrackSolution& solution) {
  return {.heading = "What this sensor, this duration and these stops allow",
          .paragraphs = budget_words(solution)};
}

std::string_view how_found(const TrackReport& report) {
  if (!report.options.still.empty()) return "as the list says";
  return report.solution.rests_by_quietness ? "found where it is quiet against the motion"
                                            : "found by the noise of the resting sensor";
}

Section stops_section(const TrackReport& report) {
  const TrackSolution& solution = report.solution;
  const auto& error = solution.motion_error;
  Section section{.heading = "Stops: what the velocity should have been, and was"};
  std::string rests = fmt::format("{} at rest, {}.", count_words(solution.rests.size(), "stretch"),
                                  how_found(report));
  if (!solution.closures.empty())
    rests += " In the forward filter, " + closures_words(solution.closures) + ".";
  section.paragraphs = {std::move(rests)};
  if (error.walk_mps2_rts > 0.0 || error.jump_mps2 > 0.0 || error.lean_mps2_rthz > 0.0) {
    section.paragraphs.push_back(fmt::format(
        "In motion the acceleration errs beyond its noise at rest, as these stops show: a bias "
        "that walks by {} m/s²/√s and differs from that at rest by {} m/s², and an attitude that "
        "rocks by {} m/s²/√Hz.",
        significant(error.walk_mps2_rts, 2), significant(error.jump_mps2, 2),
        significant(error.lean_mps2_rthz, 2)));
  }
  if (!solution.closures.empty()) section.tables = {closures_table(solution.closures)};
  return section;
}

Section readings_section(const TrackReport& report) {
  const TrackSolution& solution = report.solution;
  Table table{"", {}, {}};
  table.rows = {{"Axis", axis_words(solution) + (solution.axis_given ? ", given" : ", found")},
                {"Motion along it", fmt::format("{} % of the squared velocity",
                                                fixed(100.0 * solution.travel_share, 1))},
                {"Gravity", std::string(gravity_words(solution.gravity))},
                {"Scale of the readings", fmt::format("good to {} %, part of every band",
                                                      significant(100.0 * solution.scale_std, 2))}};
  if (solution.resting_norm_mps2)
    table.rows.push_back(
        {"Length of the readings at rest", fixed(*solution.resting_norm_mps2, 4) + " m/s²"});
  if (solution.turned_rad)
    table.rows.push_back({"Turned between two rests by",
                          fixed(*solution.turned_rad / rad_per_deg, 2) + "° at most"});
  table.rows.push_back({"Samples without a reading", grouped(solution.missing)});
  return {
      .heading = "The readings", .tables = {std::move(table)}, .figures = {accel_figure(solution)}};
}

Table fused_table(const TrackSolution& solution) {
  auto rows = fused_rows(solution);
  Table table{
      "Each accelerometer alone, and all fused", {"Sensor", "Displacement", "Reads at rest"}, {}};
  table.rows.assign(rows.begin() + 1, rows.end());
  return table;
}

Section pva_method_section(const TrackSolution& solution) {
  Section section{.heading = "How it was computed"};
  section.paragraphs = {
      model_words(solution),
      "A Kalman filter carries position, velocity, acceleration and a bias of each accelerometer "
      "through the recording. White jerk drives the acceleration in motion; at rest velocity and "
      "acceleration are 0, and what an accelerometer reads is its bias. Each reading is judged by "
      "its innovation. A fixed-interval smoother then goes back through the recording.",
      "The axis, the rests and what the readings err by in motion are found as in the inertial "
      "model. "
      "Beside it stands double integration of the same readings, less their level at the first "
      "rest."};
  return section;
}

Section method_section(const TrackSolution& solution) {
  if (solution.model != estimate::TrackModel::inertial) return pva_method_section(solution);
  return {
      .heading = "How it was computed",
      .paragraphs = {
          "Between stops the acceleration along the axis, less a bias, is integrated to velocity "
          "and position. At a stop the velocity is 0 and the accelerometer reads its bias. A "
          "Kalman filter carries position, velocity and bias through the recording with their "
          "uncertainty; a fixed-interval smoother then goes back through it, so that every instant "
          "is judged by all readings, and what is left of the velocity at a stop corrects the "
          "motion before it.",
          "How far bias and attitude wander in motion is found from what is left over at the "
          "stops; that there are few of them is part of the 95 % intervals. Beside it stands "
          "double integration of the same readings, less their level at the first rest."}};
}

}  // namespace

std::string track_html(const TrackReport& report) {
  const TrackSolution& solution = report.solution;
  Page page{.verb = "track",
            .title = file_name(report.inputs.front()),
            .inputs = report.inputs,
            .conclusion = track_conclusion(solution),
            .key_figures = key_figures(solution),
            .notes = report.notes};
  page.notes.insert(page.notes.end(), solution.notes.begin(), solution.notes.end());
  page.sections.push_back(budget_section(solution));
  if (solution.smoother) {
    page.sections.push_back({.heading = "Position",
                             .tables = {methods_table(solution)},
                             .figures = {position_figure(report), velocity_figure(solution),
                                         position_std_figure(solution)}});
    if (solution.fused) page.sections.back().tables.push_back(fused_table(solution));
    if (!solution.strokes.empty())
      page.sections.push_back({.heading = "Strokes", .tables = {strokes_table(solution.strokes)}});
  }
  page.sections.push_back(readings_section(report));
  if (solution.smoother) {
    page.sections.push_back(stops_section(report));
    page.sections.push_back(consistency_section(solution.consistency));
    page.sections.push_back(method_section(solution));
  }
  return html(page);
}

}  // namespace proofmass::report
