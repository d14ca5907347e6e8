#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <utility>
#include <vector>

#include "proofmass/core/units.hpp"
#include "proofmass/report/motor/report.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using estimate::FrictionPoint;
using estimate::MotorParameter;
using estimate::MotorSolution;

// "torque_constant" → "Torque constant".
std::string label_of(const MotorParameter& parameter) {
  std::string label = parameter.name;
  std::ranges::replace(label, '_', ' ');
  label.front() = static_cast<char>(label.front() - 'a' + 'A');
  return label;
}

// "N m s/rad" of "N*m*s/rad".
std::string unit_words(const std::string& unit) {
  if (unit == "ohm") return "Ω";
  std::string words = print_unit(unit);
  std::ranges::replace(words, '*', ' ');
  return words;
}

// Angles in degrees for people.
std::string value_words(const MotorParameter& parameter) {
  if (!parameter.value) return std::string(absent);
  if (parameter.unit == "rad") return degree_words(parameter.value);
  return with_std(*parameter.value, unit_words(parameter.unit));
}

std::string interval_words(const MotorParameter& parameter) {
  if (!parameter.interval_95) return parameter.reason;
  const bool angle = parameter.unit == "rad";
  const double factor = angle ? deg_per_rad : 1.0;
  return fmt::format("{} … {}{}", significant((*parameter.interval_95)[0] * factor, 4),
                     significant((*parameter.interval_95)[1] * factor, 4), angle ? "°" : "");
}

Fields parameter_fields(const MotorParameter& parameter) {
  const auto value =
      parameter.value ? std::optional(parameter.value->value) : std::optional<double>{};
  const auto std = parameter.value ? std::optional(parameter.value->std) : std::optional<double>{};
  Fields fields{
      field::text("name", parameter.name),
      field::number("value", value,
                    {.meaning = "at the load's shaft; null where the recording does not "
                                "determine it",
                     .why_null = parameter.reason}),
      field::magnitude("std", std, {.why_null = parameter.reason}),
      field::text("unit", parameter.unit),
      field::interval("interval_95", parameter.interval_95, {.why_null = parameter.reason})};
  if (!parameter.reason.empty()) fields.push_back(field::text("reason", parameter.reason));
  return fields;
}

Fields point_fields(const FrictionPoint& point) {
  return {field::number("speed_radps", point.speed_radps), field::number("value", point.torque),
          field::magnitude("std", point.std)};
}

// Correlation of each innovation with the next.
Fields correlation_fields(const MotorSolution& solution) {
  return {
      field::number("winding", solution.angle_correlation,
                    {.meaning = "0 if the noise is as modelled", .why_null = "no current is used"}),
      field::number("motion", solution.motion_correlation)};
}

Fields motor_fields(const MotorReport& report) {
  const MotorSolution& solution = report.solution;
  return {field::flag("current_recorded", solution.has_current),
          field::records("parameters", solution.parameters, parameter_fields),
          field::object(
              "friction",
              {field::text("unit", solution.has_current ? "N*m" : "V"),
               field::records("curve", solution.friction, point_fields,
                              {.meaning = "of the forward motion; without a current the voltage "
                                          "that dry friction costs"})}),
          field::number("rate_hz", solution.rate_hz, {.meaning = "at which it was analysed"}),
          field::probability("moving_share", solution.moving_share),
          field::count("reversals", solution.reversals),
          field::number("angle_noise_rad", solution.angle_noise_rad,
                        {.meaning = "standard deviation of one sample"}),
          field::object("innovation_correlation", correlation_fields(solution)),
          field::notes(report.notes)};
}

Table parameters_table(const MotorSolution& solution) {
  Table table{"The drive, at the load's shaft", {"Figure", "Value", "95 % interval"}, {}};
  for (const MotorParameter& one : solution.parameters)
    table.rows.push_back({label_of(one), value_words(one), interval_words(one)});
  return table;
}

Figure friction_figure(const MotorSolution& solution) {
  Figure figure{.title = "Friction against speed",
                .description =
                    "Friction that opposes the motion, with its 95 % band; at rest it "
                    "balances any torque up to the left end.",
                .x = {.label = "Speed (rad/s)", .min = 0.0},
                .y = {.label = solution.has_current ? "Friction (N m)" : "Friction (V)"}};
  Curve curve{.label = "friction", .x = {}, .y = {}};
  Band band{.label = "95 %", .x = {}, .lower = {}, .upper = {}};
  for (const FrictionPoint& point : solution.friction) {
    curve.x.push_back(point.speed_radps);
    curve.y.push_back(point.torque);
    band.x.push_back(point.speed_radps);
    band.lower.push_back(point.torque - normal_95 * point.std);
    band.upper.push_back(point.torque + normal_95 * point.std);
  }
  figure.bands = {std::move(band)};
  figure.curves = {std::move(curve)};
  return figure;
}

Figure gear_figure(const MotorSolution& solution) {
  const estimate::MotorSeries& series = solution.series;
  Figure figure{.title = "The gear",
                .description =
                    "Load's angle as measured minus the motor's: the distance between "
                    "the two levels is the backlash.",
                .x = {.label = "Time (s)"},
                .y = {.label = "Load minus motor (°)"}};
  Curve apart{.label = "measured", .x = series.time_s, .y = {}, .mark = Mark::thin};
  for (std::size_t k = 0; k < series.time_s.size(); ++k)
    apart.y.push_back((series.load_angle_rad[k] - series.motor_angle_rad[k]) * deg_per_rad);
  figure.curves = {std::move(apart)};
  return figure;
}

Figure speed_figure(const MotorSolution& solution) {
  return {.title = "Speed",
          .description = solution.has_current ? "Of the motor at the load's shaft, by its back-EMF."
                                              : "Of the load, by its angle.",
          .x = {.label = "Time (s)"},
          .y = {.label = "Speed (rad/s)"},
          .curves = {{.label = "", .x = solution.series.time_s, .y = solution.series.speed_radps}}};
}

std::string conclusion(const MotorSolution& solution) {
  std::size_t found = 0;
  for (const MotorParameter& one : solution.parameters) found += one.value ? 1U : 0U;
  std::string words = fmt::format("{} of {} are identified", found,
                                  count_words(solution.parameters.size(), "figure"));
  for (const char* name : {"inertia", "coulomb_friction", "friction_voltage", "backlash"})
    if (const MotorParameter* one = solution.find(name); one != nullptr && one->value) {
      std::string label = label_of(*one);
      if (!label.starts_with("Coulomb"))
        label.front() = static_cast<char>(label.front() - 'A' + 'a');
      words += fmt::format("; {} {}", label, value_words(*one));
    }
  return words + ".";
}

Section how_computed() {
  return {.heading = "How it was computed",
          .paragraphs = {
              "Two regressions whose noise is white plus a random walk. The first compares the "
              "load's angle with the integral of the motor's back-EMF and gives resistance, torque "
              "constant and backlash; the second is the equation of motion, integrated once. At "
              "rest and in the gap of the gear friction is unknown, so those samples are not used. "
              "Standard deviations allow for noise that is not as modelled and for 0.05 % in the "
              "gains of the channels; see docs/methods/motor.md."}};
}

}  // namespace

Document describe(const MotorReport& report) {
  const MotorSolution& solution = report.solution;
  Document document{.page = {.verb = "motor",
                             .title = report.inputs.empty() ? "" : file_name(report.inputs.front()),
                             .inputs = report.inputs,
                             .conclusion = conclusion(solution),
                             .notes = report.notes},
                    .fields = motor_fields(report)};
  std::vector<Plot> figures{[&solution] { return friction_figure(solution); },
                            [&solution] { return speed_figure(solution); }};
  if (solution.has_current) figures.emplace_back([&solution] { return gear_figure(solution); });
  document.page.sections = {Section{.heading = "Parameters",
                                    .tables = {parameters_table(solution)},
                                    .figures = std::move(figures),
                                    .on_terminal = true},
                            how_computed()};
  return document;
}

Recording motor_series(const MotorReport& report) {
  const MotorSolution& solution = report.solution;
  const estimate::MotorSeries& series = solution.series;
  Recording out;
  out.source = report.inputs.empty() ? "" : report.inputs.front();
  out.time.source = TimeSource::stamps;
  out.time.stamps_s = series.time_s;
  const Unit rad = *parse_unit("rad"), radps = *parse_unit("rad/s");
  Unit friction;
  friction.symbol = solution.has_current ? "N*m" : "V";
  std::vector<double> contact(series.contact.begin(), series.contact.end());
  out.channels = {{"load_angle", rad, series.load_angle_rad}};
  if (solution.has_current) out.channels.push_back({"motor_angle", rad, series.motor_angle_rad});
  out.channels.push_back({"speed", radps, series.speed_radps});
  out.channels.push_back({"friction", friction, series.friction});
  out.channels.push_back({"contact", {}, std::move(contact)});
  return out;
}

}  // namespace proofmass::report
