#include <array>
#include <fmt/format.h>

#include "proofmass/report/consistency_report.hpp"
#include "proofmass/report/document.hpp"
#include "proofmass/report/track_report.hpp"
#include "proofmass/report/track_wording.hpp"

namespace proofmass::report {
namespace {

using estimate::Stroke;
using estimate::TrackBudget;
using estimate::TrackMethod;
using estimate::TrackSolution;

Value optional(const std::optional<double>& figure) {
  return figure ? Value(*figure) : Value();
}

constexpr std::array method_keys{"displacement_m", "std_m",  "interval_95_m", "path_m",
                                 "path_std_m",     "peak_m", "peak_std_m"};

Value method(const std::optional<TrackMethod>& method) {
  if (!method) {
    Object empty;
    for (const char* key : method_keys) empty.push_back({key, nullptr});
    return empty;
  }
  const Uncertain& end = method->displacement_m;
  return Object{{"displacement_m", end.value},
                {"std_m", end.std},
                {"interval_95_m",
                 Array{end.value - method->half_width_95_m, end.value + method->half_width_95_m}},
                {"path_m", method->path_m},
                {"path_std_m", optional(method->path_std_m)},
                {"peak_m", method->peak_m.value},
                {"peak_std_m", method->peak_m.std}};
}

Array rests(const TrackSolution& solution) {
  const std::vector<double>& time_s = solution.series.time_s;
  Array items;
  for (const signal::Rest& rest : solution.rests)
    items.push_back(Object{{"start_s", time_s[rest.first]}, {"end_s", time_s[rest.last]}});
  return items;
}

Array strokes(const std::vector<Stroke>& strokes) {
  Array items;
  for (const Stroke& stroke : strokes) {
    items.push_back(Object{{"start_s", stroke.start_s},
                           {"turn_s", stroke.back_m ? Value(stroke.turn_s) : Value()},
                           {"end_s", stroke.end_s},
                           {"length_m", stroke.length_m.value},
                           {"length_std_m", stroke.length_m.std},
                           {"out_m", stroke.out_m.value},
                           {"back_m", stroke.back_m ? Value(stroke.back_m->value) : Value()},
                           {"kind", kind_of(stroke)}});
  }
  return items;
}

Value stroke_summary(const std::vector<Stroke>& strokes) {
  const auto summary = summary_of(strokes);
  if (!summary)
    return Object{{"count", 0},
                  {"there_and_back", 0},
                  {"median_length_m", nullptr},
                  {"median_length_std_m", nullptr},
                  {"spread_m", nullptr}};
  return Object{{"count", summary->count},
                {"there_and_back", summary->there_and_back},
                {"median_length_m", summary->median_length_m.value},
                {"median_length_std_m", summary->median_length_m.std},
                {"spread_m", optional(summary->spread_m)}};
}

Value fused(const estimate::FusedTrack& fused) {
  Array sensors;
  for (const estimate::FusedSensor& sensor : fused.sensors)
    sensors.push_back(Object{{"name", sensor.name},
                             {"bias_mps2", sensor.bias_mps2.value},
                             {"bias_std_mps2", sensor.bias_mps2.std},
                             {"displacement_m", sensor.displacement_m.value},
                             {"std_m", sensor.displacement_m.std}});
  return Object{{"sensors", sensors}, {"variance_gain", fused.variance_gain}};
}

Value budget(const TrackBudget& budget) {
  return Object{{"white_mps2_rthz", budget.white_mps2_rthz},
                {"walk_mps2_rts", budget.walk_mps2_rts},
                {"motion_s", budget.motion_s},
                {"longest_motion_s", budget.longest_motion_s},
                {"free_m", optional(budget.free_m)},
                {"worst_m", optional(budget.worst_m)},
                {"end_m", optional(budget.end_m)}};
}

Array closures(const TrackSolution& solution) {
  Array items;
  for (const estimate::Closure& closure : solution.closures)
    items.push_back(Object{{"start_s", closure.start_s},
                           {"end_s", closure.end_s},
                           {"velocity_mps", closure.velocity_mps},
                           {"expected_std_mps", closure.expected_std_mps},
                           {"fastest_mps", closure.fastest_mps}});
  return items;
}

// What the methods have to leave open.
void tell_of_methods(const TrackSolution& solution, std::vector<std::string>& all) {
  const auto tell = [&](const std::optional<TrackMethod>& method, const char* name) {
    if (!method) {
      std::string keys;
      for (const char* key : method_keys) keys += (keys.empty() ? "" : ", ") + std::string(key);
      all.push_back(fmt::format("methods.{}: {}: null: {}", name, keys, refusal(solution)));
    } else if (!method->path_std_m) {
      const bool smoothed = &method == &solution.smoother;
      all.push_back(fmt::format(
          "methods.{}.path_std_m: null: {}", name,
          smoothed ? "no turning point stands out" : "worked out for the smoother alone"));
    }
  };
  tell(solution.double_integration, "double_integration");
  tell(solution.kalman, "kalman");
  tell(solution.smoother, "smoother");
}

void tell_of_strokes(const TrackSolution& solution, std::vector<std::string>& all) {
  const auto summary = summary_of(solution.strokes);
  if (!summary) {
    const std::string why =
        solution.smoother ? "no stroke stands out of the error band" : refusal(solution);
    all.push_back("stroke_summary: median_length_m, median_length_std_m, spread_m: null: " + why);
    return;
  }
  if (!summary->spread_m) all.emplace_back("stroke_summary.spread_m: null: one stroke only");
  if (summary->there_and_back < summary->count)
    all.emplace_back("strokes[]: turn_s, back_m: null of a stroke that goes one way");
}

Value alternatives(const TrackSolution& solution) {
  Array all;
  for (const estimate::TrackAlternative& one : solution.alternatives) {
    Array spans;
    for (const estimate::TimeSpan& span : one.no_rests)
      spans.push_back(Object{{"start_s", span.start_s}, {"end_s", span.end_s}});
    all.push_back(Object{{"probability", one.probability},
                         {"displacement_m", one.displacement_m.value},
                         {"std_m", one.displacement_m.std},
                         {"no_rests", std::move(spans)}});
  }
  return all;
}

// Every null has its reason here.
std::vector<std::string> warnings(const TrackReport& report) {
  const TrackSolution& solution = report.solution;
  std::vector<std::string> all = texts(report.notes, Severity::warning);
  const auto add = [&](const std::vector<std::string>& more) {
    all.insert(all.end(), more.begin(), more.end());
  };
  add(texts(solution.notes, Severity::warning));
  add(consistency_nulls(solution.consistency));
  tell_of_methods(solution, all);
  tell_of_strokes(solution, all);
  const auto missing = [&](const std::optional<double>& figure, const char* what) {
    if (!figure) all.emplace_back(what);
  };
  const TrackBudget& budget = solution.budget;
  if (!budget.free_m || !budget.worst_m || !budget.end_m)
    all.emplace_back("budget: free_m, worst_m, end_m: null where nothing bounds the error");
  if (solution.model == estimate::TrackModel::inertial)
    all.emplace_back("jerk_psd: null: the inertial model has none");
  else if (!solution.jerk_psd_m2ps5)
    all.emplace_back("jerk_psd: null: the readings in motion do not tell it");
  if (!solution.fused) all.emplace_back("fused: null: one sensor alone");
  missing(solution.resting_norm_mps2, "resting_norm_mps2: null: it takes three axes and a rest");
  missing(solution.turned_rad,
          "turned_rad: null: it takes three axes, gravity in the readings, and a rest");
  return all;
}

std::vector<std::string> remarks(const TrackReport& report) {
  std::vector<std::string> notes = texts(report.notes, Severity::info);
  for (std::string& text : texts(report.solution.notes, Severity::info))
    notes.push_back(std::move(text));
  return notes;
}

}  // namespace

std::string track_json(const TrackReport& report) {
  const TrackSolution& solution = report.solution;
  const std::vector<double>& time_s = solution.series.time_s;
  return to_json(
      {"track", report.inputs, warnings(report)},
      {{"samples", time_s.size()},
       {"duration_s", time_s.empty() ? 0.0 : time_s.back() - time_s.front()},
       {"budget", budget(solution.budget)},
       {"model", name_of(solution.model)},
       {"jerk_psd", quantity(solution.jerk_psd_m2ps5, "m^2/s^5")},
       {"fused", solution.fused ? fused(*solution.fused) : Value()},
       {"methods", Object{{"double_integration", method(solution.double_integration)},
                          {"kalman", method(solution.kalman)},
                          {"smoother", method(solution.smoother)}}},
       {"factor_95", solution.factor_95},
       {"axis", array_of(solution.axis)},
       {"axis_frame", solution.axis_in_world ? "world" : "sensor"},
       {"axis_given", solution.axis_given},
       {"travel_share", solution.travel_share},
       {"rests", rests(solution)},
       {"rests_by_quietness", solution.rests_by_quietness},
       {"cruises", solution.cruises},
       {"plateaus", solution.plateaus},
       {"alternatives", alternatives(solution)},
       {"no_motion_shown", solution.no_motion_shown},
       {"strokes", strokes(solution.strokes)},
       {"stroke_summary", stroke_summary(solution.strokes)},
       {"closures", closures(solution)},
       {"motion_error", Object{{"walk_mps2_rts", solution.motion_error.walk_mps2_rts},
                               {"jump_mps2", solution.motion_error.jump_mps2},
                               {"lean_mps2_rthz", solution.motion_error.lean_mps2_rthz}}},
       {"scale_std", solution.scale_std},
       {"gravity", name_of(solution.gravity)},
       {"gravity_mps2", report.options.gravity_mps2},
       {"resting_norm_mps2", optional(solution.resting_norm_mps2)},
       {"turned_rad", optional(solution.turned_rad)},
       {"suspected_jerk", solution.suspected_jerk},
       {"missing", solution.missing},
       {"consistency", consistency_json(solution.consistency)},
       {"notes", array_of(remarks(report))}});
}

}  // namespace proofmass::report
