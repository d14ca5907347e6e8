#include <algorithm>
#include <array>
#include <fmt/format.h>

#include "proofmass/core/units.hpp"
#include "proofmass/report/consistency_report.hpp"
#include "proofmass/report/track/figures.hpp"
#include "proofmass/report/track/report.hpp"
#include "proofmass/report/track/wording.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using estimate::Closure;
using estimate::Stroke;
using estimate::TrackMethod;
using estimate::TrackSolution;

Fields budget_fields(const estimate::TrackBudget& budget) {
  const std::string why = "nothing bounds the error";
  return {field::magnitude("white_mps2_rthz", budget.white_mps2_rthz,
                           {.meaning = "noise density along the axis, two-sided"}),
          field::magnitude("walk_mps2_rts", budget.walk_mps2_rts,
                           {.meaning = "random walk of the bias"}),
          field::magnitude("motion_s", budget.motion_s, {.meaning = "total duration of motion"}),
          field::magnitude("longest_motion_s", budget.longest_motion_s,
                           {.meaning = "between two stops"}),
          field::magnitude(
              "free_m", budget.free_m,
              {.meaning = "standard deviation of double integration at the end", .why_null = why}),
          field::magnitude("worst_m", budget.worst_m,
                           {.meaning = "largest with all stops and fixes", .why_null = why}),
          field::magnitude("end_m", budget.end_m,
                           {.meaning = "at the end with all stops and fixes", .why_null = why})};
}

Field fused(const TrackSolution& solution) {
  std::optional<Fields> fields;
  if (solution.fused)
    fields = Fields{
        field::records("sensors", solution.fused->sensors,
                       [](const estimate::FusedSensor& sensor) -> Fields {
                         return {field::text("name", sensor.name),
                                 field::number("bias_mps2", sensor.bias_mps2.value),
                                 field::magnitude("bias_std_mps2", sensor.bias_mps2.std),
                                 field::number("displacement_m", sensor.displacement_m.value),
                                 field::magnitude("std_m", sensor.displacement_m.std)};
                       }),
        field::magnitude("variance_gain", solution.fused->variance_gain)};
  return field::object_or_null("fused", std::move(fields),
                               {.meaning = "of the model fused", .why_null = "a single sensor"});
}

Field method(const char* key,
             const TrackSolution& solution,
             const std::optional<TrackMethod>& method,
             const std::string& why_no_path_std) {
  const std::string why = refusal(solution);
  const auto figure = [&](double value) { return method ? std::optional(value) : std::nullopt; };
  const TrackMethod m = method.value_or(TrackMethod{});
  const Uncertain& end = m.displacement_m;
  const auto interval =
      method
          ? std::optional(std::array{end.value - m.half_width_95_m, end.value + m.half_width_95_m})
          : std::nullopt;
  return field::object(
      key,
      {field::number(
           "displacement_m", figure(end.value),
           {.meaning = "from the first sample to the last, along the axis", .why_null = why}),
       field::magnitude("std_m", figure(end.std),
                        {.meaning = "of the displacement", .why_null = why}),
       field::interval(
           "interval_95_m", interval,
           {.meaning = "wider than ± 1.96 std where few stops show the errors of motion",
            .why_null = why}),
       field::magnitude("path_m", figure(m.path_m),
                        {.meaning = "length of the path, both ways counted", .why_null = why}),
       field::magnitude("path_std_m", m.path_std_m, {.why_null = method ? why_no_path_std : why}),
       field::number("peak_m", figure(m.peak_m.value),
                     {.meaning = "largest distance from the start, signed", .why_null = why}),
       field::magnitude("peak_std_m", figure(m.peak_m.std), {.why_null = why})});
}

Field methods(const TrackSolution& solution) {
  const std::string smoother_only = "computed for the smoother only";
  return field::object(
      "methods",
      {method("double_integration", solution, solution.double_integration, smoother_only),
       method("kalman", solution, solution.kalman, smoother_only),
       method("smoother", solution, solution.smoother, "no turning point is significant")});
}

Fields span_fields(double start_s, double end_s) {
  return {field::number("start_s", start_s), field::number("end_s", end_s)};
}

Fields stroke_fields(const Stroke& stroke) {
  const std::string one_way = "a stroke one way does not turn";
  return {
      field::number("start_s", stroke.start_s),
      field::number("turn_s", stroke.back_m ? std::optional(stroke.turn_s) : std::nullopt,
                    {.why_null = one_way}),
      field::number("end_s", stroke.end_s),
      field::number("length_m", stroke.length_m.value,
                    {.meaning = "mean of both ways, or the shorter where they differ by half"}),
      field::magnitude("length_std_m", stroke.length_m.std),
      field::number("out_m", stroke.out_m.value),
      field::number("back_m", stroke.back_m ? std::optional(stroke.back_m->value) : std::nullopt,
                    {.why_null = one_way}),
      field::choice("kind", kind_of(stroke), {"there_and_back", "one_way"})};
}

Field stroke_summary(const TrackSolution& solution) {
  const std::optional<StrokeSummary> summary = summary_of(solution.strokes);
  const std::string why =
      solution.smoother ? "no stroke exceeds the error band" : refusal(solution);
  const auto length = [&](double value) { return summary ? std::optional(value) : std::nullopt; };
  const StrokeSummary s = summary.value_or(StrokeSummary{});
  return field::object(
      "stroke_summary",
      {field::count("count", s.count), field::count("there_and_back", s.there_and_back),
       field::number("median_length_m", length(s.median_length_m.value), {.why_null = why}),
       field::magnitude("median_length_std_m", length(s.median_length_m.std), {.why_null = why}),
       field::magnitude("spread_m", s.spread_m,
                        {.meaning = "sample standard deviation of the lengths",
                         .why_null = summary ? "a single stroke" : why})});
}

Fields alternative_fields(const estimate::TrackAlternative& one) {
  return {field::probability("probability", one.probability),
          field::number("displacement_m", one.displacement_m.value),
          field::magnitude("std_m", one.displacement_m.std),
          field::records("no_rests", one.no_rests, [](const estimate::TimeSpan& span) {
            return span_fields(span.start_s, span.end_s);
          })};
}

Field fixes_of(const TrackReport& report) {
  const estimate::FixReview& review = report.solution.fix_review;
  std::optional<Fields> fields;
  if (!report.options.fixes.empty())
    fields = Fields{
        field::measured("delay_s", review.delay_s, "s",
                        {.meaning = "by which the times of the fixes are late; it is subtracted",
                         .why_null = "the fixes show no delay of their times"}),
        field::records("not_used", review.wrong,
                       [](const estimate::PositionFix& fix) -> Fields {
                         return {field::number("time_s", fix.time_s),
                                 field::number("position_m", fix.position_m)};
                       },
                       {.meaning = "fixes that contradict the accelerations and the other fixes"}),
        field::count("false_rests", review.false_rests,
                     {.meaning = "quiet intervals that are no rests by the fixes"})};
  return field::object_or_null("fixes", std::move(fields),
                               {.meaning = "what the fixes contradict", .why_null = "no fixes"});
}

Fields closure_fields(const Closure& closure) {
  return {field::number("start_s", closure.start_s), field::number("end_s", closure.end_s),
          field::number("velocity_mps", closure.velocity_mps,
                        {.meaning = "residual velocity at the stop"}),
          field::magnitude("expected_std_mps", closure.expected_std_mps),
          field::magnitude("fastest_mps", closure.fastest_mps)};
}

Field motion_error(const estimate::MotionErrorFigures& error) {
  return field::object(
      "motion_error",
      {field::magnitude("walk_mps2_rts", error.walk_mps2_rts,
                        {.meaning = "random walk of the bias in motion"}),
       field::magnitude("jump_mps2", error.jump_mps2,
                        {.meaning = "difference of the bias in motion from that at rest"}),
       field::magnitude("lean_mps2_rthz", error.lean_mps2_rthz,
                        {.meaning = "white noise from a rocking attitude"})});
}

Field axis(const TrackSolution& solution) {
  return field::numbers("axis", solution.axis, {.meaning = "unit vector"});
}

Field jerk_psd(const TrackSolution& solution) {
  return field::measured(
      "jerk_psd", solution.jerk_psd_m2ps5, "m^2/s^5",
      {.meaning = "two-sided density of the white jerk of the models pva and fused; std 0 where "
                  "given",
       .why_null = solution.model == estimate::TrackModel::inertial
                       ? "the inertial model has none"
                       : "the measurements in motion do not determine it"});
}

Fields track_fields(const TrackReport& report) {
  const TrackSolution& solution = report.solution;
  const std::vector<double>& time_s = solution.series.time_s;
  return {
      field::count("samples", time_s.size()),
      field::number("duration_s", time_s.empty() ? 0.0 : time_s.back() - time_s.front()),
      field::object("budget", budget_fields(solution.budget)),
      field::choice("model", name_of(solution.model), {"inertial", "pva", "fused"}),
      jerk_psd(solution),
      fused(solution),
      methods(solution),
      field::magnitude("factor_95", solution.factor_95,
                       {.meaning = "half width of a 95 % interval in standard deviations"}),
      axis(solution),
      field::choice("axis_frame", solution.axis_in_world ? "world" : "sensor", {"world", "sensor"}),
      field::flag("axis_given", solution.axis_given),
      field::magnitude("travel_share", solution.travel_share,
                       {.meaning = "share of the squared velocity that is along the axis"}),
      field::records("rests", solution.rests,
                     [&](const signal::Rest& rest) {
                       return span_fields(time_s[rest.first], time_s[rest.last]);
                     }),
      field::flag("rests_by_quietness", solution.rests_by_quietness,
                  {.meaning = "found relative to the motion, not by the noise of a static sensor"}),
      field::count("cruises", solution.cruises,
                   {.meaning = "quiet intervals of constant speed rather than rest"}),
      field::count("plateaus", solution.plateaus,
                   {.meaning = "quiet intervals of constant acceleration rather than rest"}),
      field::records(
          "alternatives", solution.alternatives, alternative_fields,
          {.meaning = "hypotheses about which quiet intervals are rests, by decreasing "
                      "probability; present where none is clearly the most probable, and "
                      "then no method gives a displacement"}),
      fixes_of(report),
      field::flag("no_motion_shown", solution.no_motion_shown,
                  {.meaning = "all of the recording is as quiet as rest: only its ends are taken "
                              "for rests"}),
      field::records("strokes", solution.strokes, stroke_fields),
      stroke_summary(solution),
      field::records("closures", solution.closures, closure_fields,
                     {.meaning = "velocity integrated from one stop to the next, on arrival"}),
      motion_error(solution.motion_error),
      field::magnitude("scale_std", solution.scale_std,
                       {.meaning = "relative; part of every standard deviation"}),
      field::choice("gravity", name_of(solution.gravity), {"removed", "present", "unknown"}),
      field::number("gravity_mps2", report.options.gravity_mps2),
      field::number("resting_norm_mps2", solution.resting_norm_mps2,
                    {.meaning = "norm of the measured force at rest",
                     .why_null = "needs three axes and a rest"}),
      field::number("turned_rad", solution.turned_rad,
                    {.meaning = "largest angle between the directions of gravity at two rests",
                     .why_null = "needs three axes, gravity in the measurements, and a rest"}),
      field::flag("suspected_jerk", solution.suspected_jerk,
                  {.meaning = "the data look like the derivative of an acceleration: no method has "
                              "a displacement"}),
      field::count("missing", solution.missing, {.meaning = "samples without a value"}),
      consistency_field(solution.consistency),
      field::notes(all_notes(report.notes, report.solution.notes))};
}

std::string seconds(double t) {
  return fixed(t, 2) + " s";
}

std::vector<KeyFigure> figures_of(const TrackSolution& solution) {
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
      {"Consistency",
       std::string(solution.smoother ? name_of(solution.consistency.verdict) : "no displacement")}};
}

Table methods_table(const TrackSolution& solution) {
  Table table{"Along the axis, by method",
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
  add("Smoother", solution.smoother);
  add("Filter (Kalman)", solution.kalman);
  add("Double integration", solution.double_integration);
  return table;
}

Table fused_table(const TrackSolution& solution) {
  Table table{
      "Each accelerometer alone, and all fused", {"Sensor", "Displacement", "Output at rest"}, {}};
  for (const estimate::FusedSensor& sensor : solution.fused->sensors)
    table.rows.push_back({sensor.name + " alone", length_with_std(sensor.displacement_m),
                          fixed(sensor.bias_mps2.value, 4) + " m/s²"});
  table.rows.push_back({fmt::format("fused: variance {} times smaller",
                                    significant(solution.fused->variance_gain, 2)),
                        length_with_std(solution.smoother->displacement_m), ""});
  return table;
}

Table strokes_table(const std::vector<Stroke>& strokes) {
  Table table{
      "Strokes; the length is the mean of both ways, or the shorter where they differ by "
      "half",
      {"Stroke", "From", "Turns", "To", "Out", "Back", "Length"},
      {}};
  table.long_list = true;
  for (const Stroke& stroke : strokes)
    table.rows.push_back({std::to_string(table.rows.size() + 1), seconds(stroke.start_s),
                          stroke.back_m ? seconds(stroke.turn_s) : "one way", seconds(stroke.end_s),
                          length_with_std(stroke.out_m),
                          stroke.back_m ? length_with_std(*stroke.back_m) : "",
                          length_with_std(stroke.length_m)});
  return table;
}

Table closures_table(const std::vector<Closure>& closures) {
  Table table{"Residual velocity at each stop",
              {"Motion", "From", "To", "Fastest", "Residual", "Expected, 1 std", "Ratio"},
              {}};
  table.page_only = table.long_list = true;
  for (const Closure& closure : closures)
    table.rows.push_back({std::to_string(table.rows.size() + 1), seconds(closure.start_s),
                          seconds(closure.end_s), significant(closure.fastest_mps, 2) + " m/s",
                          significant(closure.velocity_mps, 2) + " m/s",
                          significant(closure.expected_std_mps, 2) + " m/s",
                          significant(closure.velocity_mps / closure.expected_std_mps, 2)});
  return table;
}

std::string_view how_found(const TrackReport& report) {
  if (!report.options.still.empty()) return "as listed";
  return report.solution.rests_by_quietness ? "found relative to the motion"
                                            : "found by the noise of the static sensor";
}

Section stops_section(const TrackReport& report) {
  const TrackSolution& solution = report.solution;
  const auto& error = solution.motion_error;
  Section section{.heading = "Stops", .on_terminal = true};
  std::string rests =
      fmt::format("{}, {}.", count_words(solution.rests.size(), "rest"), how_found(report));
  if (!solution.closures.empty())
    rests += " In the forward filter, " + closures_words(solution.closures) + ".";
  section.paragraphs = {std::move(rests)};
  if (error.walk_mps2_rts > 0.0 || error.jump_mps2 > 0.0 || error.lean_mps2_rthz > 0.0)
    section.paragraphs.push_back(fmt::format(
        "Errors in motion beyond the noise at rest, as these stops show: a bias random walk of {} "
        "m/s²/√s, a bias offset of {} m/s², and {} m/s²/√Hz from a rocking attitude.",
        significant(error.walk_mps2_rts, 2), significant(error.jump_mps2, 2),
        significant(error.lean_mps2_rthz, 2)));
  if (!solution.closures.empty()) section.tables = {closures_table(solution.closures)};
  return section;
}

Section data_section(const TrackReport& report) {
  const TrackSolution& solution = report.solution;
  Table table{"", {}, {}};
  table.rows = {{"Axis", axis_words(solution) + (solution.axis_given ? ", given" : ", found")},
                {"Motion along it", fmt::format("{} % of the squared velocity",
                                                fixed(100.0 * solution.travel_share, 1))},
                {"Gravity", std::string(gravity_words(solution.gravity))},
                {"Uncertainty of the scale",
                 significant(100.0 * solution.scale_std, 2) + " %, part of every band"}};
  if (solution.resting_norm_mps2)
    table.rows.push_back({"Norm at rest", fixed(*solution.resting_norm_mps2, 4) + " m/s²"});
  if (solution.turned_rad)
    table.rows.push_back(
        {"Rotation between two rests", fixed(*solution.turned_rad / rad_per_deg, 2) + "° at most"});
  table.rows.push_back({"Samples without a value", grouped(solution.missing)});
  Section section{.heading = "The data",
                  .tables = {std::move(table)},
                  .figures = {[&] { return accel_figure(solution); }},
                  .on_terminal = true};
  if (solution.model != estimate::TrackModel::inertial)
    section.paragraphs = {model_words(solution)};
  return section;
}

Section pva_method_section() {
  return {.heading = "How it was computed",
          .paragraphs = {
              "The states of the Kalman filter are position, velocity, acceleration and a bias for "
              "each accelerometer. The acceleration is driven by white jerk in motion; at rest "
              "velocity and acceleration are 0, and an accelerometer measures its bias. A "
              "fixed-interval smoother then runs backwards through the recording.",
              "Axis, rests and errors in motion are determined as in the inertial model. Double "
              "integration of the same data, less their mean at the first rest, is given for "
              "comparison."}};
}

Section method_section(const TrackSolution& solution) {
  if (solution.model != estimate::TrackModel::inertial) return pva_method_section();
  return {
      .heading = "How it was computed",
      .paragraphs = {
          "Between stops the acceleration along the axis, less a bias, is integrated to velocity "
          "and position. At a stop the velocity is 0 and the accelerometer measures its bias. A "
          "Kalman filter propagates position, velocity and bias with their covariance; a "
          "fixed-interval smoother then runs backwards, so that the residual velocity at a stop "
          "corrects the motion before it.",
          "Bias random walk and attitude errors in motion are estimated from the residual "
          "velocities at the stops; the 95 % intervals account for the small number of stops. "
          "Double integration of the same data, less their mean at the first rest, is given for "
          "comparison."}};
}

std::string conclusion(const TrackSolution& solution) {
  const std::vector<double>& time_s = solution.series.time_s;
  const std::string when = time_s.empty() ? "" : duration_words(time_s.back() - time_s.front());
  if (!solution.smoother)
    return fmt::format("The displacement over {} is not determined: {}.", when, refusal(solution));
  std::string words = fmt::format("After {} the displacement is {} along {}, 95 % interval {}",
                                  when, length_with_std(solution.smoother->displacement_m),
                                  axis_words(solution), interval_words(*solution.smoother));
  if (const auto strokes = summary_of(solution.strokes)) words += "; " + strokes_words(*strokes);
  return words + ".";
}

}  // namespace

Document describe(const TrackReport& report) {
  const TrackSolution& solution = report.solution;
  Document document{.page = {.verb = "track",
                             .title = file_name(report.inputs.front()),
                             .inputs = report.inputs,
                             .conclusion = conclusion(solution),
                             .key_figures = figures_of(solution),
                             .notes = all_notes(report.notes, report.solution.notes)},
                    .fields = track_fields(report)};
  std::vector<Section>& sections = document.page.sections;
  sections.push_back({.heading = "What sensor, duration and stops allow",
                      .paragraphs = budget_words(solution),
                      .on_terminal = true});
  if (solution.smoother) {
    sections.push_back({.heading = "Position",
                        .tables = {methods_table(solution)},
                        .figures = {[&] { return position_figure(report); },
                                    [&] { return velocity_figure(solution); },
                                    [&] { return position_std_figure(solution); }},
                        .on_terminal = true});
    if (solution.fused) sections.back().tables.push_back(fused_table(solution));
    if (!solution.strokes.empty())
      sections.push_back(
          {.heading = "Strokes", .tables = {strokes_table(solution.strokes)}, .on_terminal = true});
  }
  sections.push_back(data_section(report));
  if (solution.smoother) {
    sections.push_back(stops_section(report));
    sections.push_back(consistency_section(solution.consistency));
    sections.push_back(method_section(solution));
  }
  return document;
}

}  // namespace proofmass::report
