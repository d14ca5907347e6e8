#include <algorithm>
#include <fmt/format.h>

#include "proofmass/core/units.hpp"
#include "proofmass/report/consistency_report.hpp"
#include "proofmass/report/document.hpp"
#include "proofmass/report/page.hpp"
#include "proofmass/report/wheel_figures.hpp"
#include "proofmass/report/wheel_report.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using estimate::WheelMethod;
using estimate::WheelSensorFit;
using estimate::WheelSolution;

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : " and ") + file_name(name);
  return text;
}

std::vector<KeyFigure> key_figures(const WheelSolution& solution) {
  const std::string of =
      solution.distance_of.empty() ? "" : ", path of " + file_name(solution.distance_of);
  return {{"Turns", with_std(solution.turns, "", absent)},
          {"Distance" + of, with_std(solution.distance_m, "m", absent)},
          {"Top speed",
           with_std(scaled(solution.peak_speed_radps, 1.0 / radps_per_rpm), "rpm", absent)},
          {"Final angle", with_std(scaled(solution.angle_final_rad, deg_per_rad), "°", absent)},
          {"Mean NIS (1 expected)", fixed(solution.consistency.nis, 3)},
          {"Rows rejected", count_words(solution.rejected_samples, "row")}};
}

Table methods_table(const WheelSolution& solution) {
  Table table{
      "Turns by each method, and what limits it", {"Method", "Turns", "Off by", "Remark"}, {}};
  const auto add = [&](const char* name, const WheelMethod& method) {
    const bool both = method.turns && solution.smoother.turns && &method != &solution.smoother;
    table.rows.push_back(
        {name, with_std(method.turns, "", "none"),
         both ? significant(method.turns->value - solution.smoother.turns->value, 2) : "",
         print_unit(method.note)});
  };
  add("Smoother", solution.smoother);
  add("Filter (EKF)", solution.ekf);
  add("atan2", solution.atan2);
  add("Double integration", solution.double_integration);
  return table;
}

std::vector<std::string> sensor_cells(const WheelSensorFit& fit, bool first, bool clocks_shared) {
  const auto& axis = fit.spin_axis;
  const std::string_view to_itself = first ? "0 by definition" : absent;
  return {file_name(fit.name),
          with_std(scaled(fit.radius_m, 1e3), "mm", absent),
          with_std(fit.bias_mps2[0], "m/s²", absent),
          with_std(fit.bias_mps2[1], "m/s²", absent),
          with_std(fit.scale[0], "", absent),
          with_std(fit.scale[1], "", absent),
          with_std(scaled(fit.skew_rad, deg_per_rad), "°", absent),
          with_std(scaled(fit.mounting_rad, deg_per_rad), "°", absent),
          with_std(scaled(fit.phase_rad, deg_per_rad), "°", to_itself),
          with_std(scaled(fit.clock_offset_s, 1e3), "ms", clocks_shared ? "the same" : to_itself),
          fmt::format("({}, {}, {}), {}", fixed(axis[0], 4), fixed(axis[1], 4), fixed(axis[2], 4),
                      fit.spin_axis_given ? "given" : "found"),
          significant(fit.noise_mps2, 2) + " m/s²",
          count_words(fit.samples, "row"),
          count_words(fit.unusable, "row"),
          count_words(fit.gated, "row")};
}

// One column a sensor: there are at most two, and many figures of each.
Table sensors_table(const WheelReport& report) {
  const WheelSolution& solution = report.solution;
  Table table{"In-plane axes 1 and 2: reading = scale · force + bias", {"Figure"}, {}};
  for (const char* name :
       {"Distance from the axle", "Bias, axis 1", "Bias, axis 2", "Scale, axis 1", "Scale, axis 2",
        "Axes miss being square by", "Mounting, axis 1 against the spoke",
        "Place about the axle, against the first", "Clock, against the first", "Spin axis",
        "Noise, one sample", "Recorded", "Unusable", "Rejected by the gate"}) {
    table.rows.push_back({name});
  }
  for (const WheelSensorFit& fit : solution.sensors) {
    const auto cells =
        sensor_cells(fit, &fit == &solution.sensors.front(), report.options.clocks_shared);
    table.head.push_back(cells[0]);
    for (std::size_t k = 1; k < cells.size(); ++k) table.rows[k - 1].push_back(cells[k]);
  }
  if (std::ranges::none_of(solution.sensors, &WheelSensorFit::has_gyro)) return table;
  table.rows.push_back({"Gyroscope, scale"});
  table.rows.push_back({"Gyroscope, bias"});
  for (const WheelSensorFit& fit : solution.sensors) {
    const std::string_view without = fit.has_gyro ? absent : "none";
    const std::size_t scale = table.rows.size() - 2;
    table.rows[scale].push_back(with_std(fit.gyro_scale, "", without));
    table.rows[scale + 1].push_back(with_std(fit.gyro_bias_radps, "rad/s", without));
  }
  return table;
}

Section fit_section(const WheelSolution& solution) {
  Section section = consistency_section(solution.consistency);
  section.figures = {innovations_figure(solution)};
  if (solution.rejected.empty()) return section;
  Table table{"What was rejected", {"From", "To", "Rows", "Why"}, {}};
  constexpr std::size_t most_rows = 40;
  for (const estimate::Stretch& stretch : solution.rejected) {
    if (table.rows.size() == most_rows) break;
    table.rows.push_back({fixed(stretch.start_s, 3) + " s", fixed(stretch.end_s, 3) + " s",
                          std::to_string(stretch.rows), stretch.reason});
  }
  if (solution.rejected.size() > most_rows) {
    table.caption += fmt::format(": the first {} of {}; the JSON document has all", most_rows,
                                 count_words(solution.rejected.size(), "stretch"));
  }
  section.tables.insert(section.tables.begin(), std::move(table));
  return section;
}

Section method_section(const WheelReport& report) {
  return {
      .heading = "How it was computed",
      .paragraphs = {
          "Each accelerometer on the wheel feels gravity turning past it, the centripetal "
          "acceleration ω²r and the tangential αr. An extended Kalman filter follows angle, speed "
          "and angular acceleration together with the sensors' biases, scales, places and "
          "mounting; readings that lie far outside what it expects are left out. A fixed-interval "
          "smoother then goes back through the recording, so that every instant is judged by all "
          "readings. The standard deviations are those of the smoother.",
          "Beside it stand two plain methods: atan2 takes the direction of the measured force for "
          "that of gravity; double integration takes the tangential acceleration and integrates "
          "it twice.",
          fmt::format("Gravity was taken as {} m/s².", fixed(report.options.gravity_mps2, 5))}};
}

}  // namespace

std::string wheel_html(const WheelReport& report) {
  const WheelSolution& solution = report.solution;
  Page page{.verb = "wheel",
            .title = joined(report.inputs),
            .inputs = report.inputs,
            .conclusion = wheel_conclusion(solution),
            .key_figures = key_figures(solution),
            .notes = report.notes};
  page.notes.insert(page.notes.end(), solution.notes.begin(), solution.notes.end());
  page.sections.push_back({.heading = "Angle",
                           .tables = {methods_table(solution)},
                           .figures = {turns_figure(solution), plain_methods_figure(solution),
                                       filter_figure(solution), angle_std_figure(solution)}});
  page.sections.push_back({.heading = "Speed", .figures = {speed_figure(solution)}});
  page.sections.push_back({.heading = "The sensors, as this recording shows them",
                           .paragraphs = {wheel_delay(report)},
                           .tables = {sensors_table(report)}});
  if (!solution.not_observable.empty()) {
    page.sections.push_back(
        {.heading = "What this recording cannot tell", .points = solution.not_observable});
  }
  page.sections.push_back(fit_section(solution));
  page.sections.push_back(method_section(report));
  return html(page);
}

}  // namespace proofmass::report
