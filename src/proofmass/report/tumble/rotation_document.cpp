#include <algorithm>
#include <fmt/format.h>

#include "proofmass/core/units.hpp"
#include "proofmass/report/rotation_report.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using calibrate::RotationAxis;
using calibrate::RotationCoefficient;
using calibrate::RotationFit;
using Q = calibrate::RotationQuantity;

constexpr double g = standard_gravity_mps2;

// Display of a coefficient: in mg, mrad and the standard's g. K1 is in the unit of the output.
struct QuantityInfo {
  const char* label;
  std::string_view unit;  // SI
  Display display;
};
constexpr std::array<QuantityInfo, calibrate::rotation_quantities> quantities{{
    {"K1, scale factor", "", {}},
    {"K0 + Kpp g², bias", "m/s^2", {"mg", 1e3 / g}},
    {"K0 + Kpp g² − r ω²", "m/s^2", {"mg", 1e3 / g}},
    {"Misalignment", "rad", {"mrad", 1e3}},
    {"K2 − Kpp", "1/(m/s^2)", {"mg/g²", 1e3 * g}},
    {"Kip", "1/(m/s^2)", {"mg/g²", 1e3 * g}},
    {"K3", "1/(m/s^2)^2", {"mg/g³", 1e3 * g* g}},
    {"Radius along the axis", "m", {"mm", 1e3}},
}};

const QuantityInfo& info(Q quantity) {
  return quantities[static_cast<std::size_t>(quantity)];
}

std::string unit_of(Q quantity, const std::string& output_unit) {
  if (quantity != Q::K1) return std::string(info(quantity).unit);
  return output_unit == "m/s^2" ? "1" : (output_unit.empty() ? "output" : output_unit) + "/(m/s^2)";
}

Field coefficient(const RotationCoefficient& one, const std::string& output_unit) {
  const QuantityInfo& about = info(one.quantity);
  About shown{.label = about.label, .why_null = one.reason};
  if (one.quantity != Q::K1) shown.display = about.display;
  if (one.quantity == Q::K0_radial) shown.meaning = "at the mean of the squared speed";
  return field::measured(std::string(name_of(one.quantity)), one.value,
                         unit_of(one.quantity, output_unit), std::move(shown));
}

// The coefficient in its display unit.
std::string coefficient_words(const RotationReport& report, const RotationAxis& axis, Q quantity) {
  const RotationCoefficient& one = axis[quantity];
  if (quantity != Q::K1) return shown_value(coefficient(one, report.unit));
  const std::string unit = unit_of(Q::K1, report.unit);
  return with_std(one.value, unit == "1" ? "" : print_unit(unit), absent);
}

Fields axis_fields(const RotationReport& report, std::size_t at) {
  const RotationFit& fit = report.fit;
  const RotationAxis& axis = fit.axes[at];
  Fields out{field::text("name", report.axis_names[at])};
  Fields intervals;
  for (const RotationCoefficient& one : axis.coefficients) {
    out.push_back(coefficient(one, report.unit));
    if (!one.value) continue;
    const std::array ends{one.value->value - one.half_width_95,
                          one.value->value + one.half_width_95};
    intervals.push_back(field::interval(std::string(name_of(one.quantity)), ends));
  }
  append(
      out,
      {field::map("interval_95", std::move(intervals), {.meaning = "of what has a value"}),
       field::measured("delay_s", axis.delay_s, "s",
                       {.meaning = "of the outputs relative to the encoder's angle",
                        .why_null = fit.angle_given ? "a single speed does not separate it from a "
                                                      "misalignment, and no bandwidth is given"
                                                    : "needs an encoder"}),
       field::magnitude("residual_rms", axis.residual_rms),
       field::object(
           "fold",
           {field::numbers("angle_rad", axis.fold.angle_rad, {.meaning = "middle of each bin"}),
            field::numbers("mean", axis.fold.mean), field::numbers("residual", axis.fold.residual)},
           {.meaning = "mean output and residual against the angle of the axis"})});
  return out;
}

Fields section_fields(const calibrate::RotationSection& section) {
  return {field::count("recording", section.recording, {.meaning = "index into input"}),
          field::number("start_s", section.start_s), field::number("end_s", section.end_s),
          field::number("turns", section.turns),
          field::number("speed_radps", section.speed_radps, {.meaning = "mean"})};
}

Fields ripple_fields(const calibrate::SpeedRipple& ripple) {
  return {
      field::count("per_turn", static_cast<std::size_t>(ripple.per_turn)),
      field::measured("amplitude", ripple.amplitude, "1",
                      {.meaning = "relative variation of the speed",
                       .why_null = "the harmonics may be chance or the sensor's"}),
      field::probability("chance_p", ripple.chance_p,
                         {.meaning = "probability of these harmonics without ripple and "
                                     "nonlinearity"}),
      field::flag("accepted", ripple.accepted,
                  {.meaning = "the harmonics are attributed to the ripple, not to the sensor"})};
}

Field per_percent(const calibrate::RippleEffect& effect) {
  return field::object(
      "per_percent_of_ripple",
      {field::object("once_a_turn", {field::number("bias_mps2", effect.bias_mps2),
                                     field::number("second_order_s2pm", effect.second_order_s2pm)}),
       field::object("twice_a_turn",
                     {field::number("scale_relative", effect.scale_relative),
                      field::number("misalignment_rad", effect.misalignment_rad),
                      field::number("third_order_s4pm2", effect.third_order_s4pm2)})},
      {.meaning = "error of the coefficients if a ripple of 1 % is attributed to the sensor"});
}

Field direction(const RotationFit& fit) {
  return field::integer("direction", fit.direction,
                        {.meaning = "1: the second axis leads by a quarter turn; -1: it lags",
                         .why_null = "a single axis does not show it"});
}

Fields rotation_fields(const RotationReport& report) {
  const RotationFit& fit = report.fit;
  Fields out{field::choice("mode", "rotating", {"rotating"})};
  for (const RotationCoefficient& one : fit.axes.front().coefficients)
    out.push_back(coefficient(one.quantity == Q::radius ? fit.radius : one, report.unit));
  Fields axes;
  for (std::size_t at = 0; at < fit.axes.size(); ++at)
    axes.push_back(field::object({}, axis_fields(report, at)));
  append(out,
         {field::text("unit", report.unit, {.meaning = "of the outputs, SI; empty if not known"}),
          field::magnitude("gravity_mps2", report.gravity_mps2, {.meaning = "as assumed"}),
          field::flag("angle_given", fit.angle_given, {.meaning = "by an encoder"}), direction(fit),
          field::list("axes", std::move(axes)),
          field::records("sections", fit.sections, section_fields,
                         {.meaning = "sections of steady rotation"}),
          field::magnitude("turns", fit.turns), field::count("samples", fit.samples),
          field::magnitude("steady_fraction", fit.steady_fraction,
                           {.meaning = "of the recorded time"}),
          field::count("blocks", fit.blocks,
                       {.meaning = "of whole turns, whose scatter gives the standard deviations"}),
          field::magnitude("dof", fit.dof),
          field::count("iterations", static_cast<std::size_t>(fit.iterations)),
          field::flag("converged", fit.converged),
          field::records("ripples", fit.ripples, ripple_fields,
                         {.meaning = "speed varying with the angle; without an encoder"}),
          per_percent(fit.per_percent), field::notes(report.notes)});
  return out;
}

std::string conclusion(const RotationReport& report) {
  const RotationFit& fit = report.fit;
  const RotationAxis& axis = fit.axes.front();
  const bool bias = axis[Q::K0].value.has_value();
  std::string text = fmt::format(
      "{} steady turns in {}, angle from {}. {}: K1 = {}, bias{} {}",
      grouped(static_cast<std::size_t>(fit.turns)), count_words(fit.sections.size(), "section"),
      fit.angle_given ? "the encoder" : "gravity", report.axis_names.front(),
      coefficient_words(report, axis, Q::K1), bias ? "" : " less r ω²",
      coefficient_words(report, axis, bias ? Q::K0 : Q::K0_radial));
  if (fit.radius.value)
    text += fmt::format("; {} from the axle", with_std(*scaled(fit.radius.value, 1e3), "mm"));
  return text + ".";
}

std::vector<KeyFigure> figures_of(const RotationReport& report) {
  const RotationAxis& axis = report.fit.axes.front();
  std::vector<KeyFigure> out;
  for (const Q quantity : {Q::K1, axis[Q::K0].value ? Q::K0 : Q::K0_radial, Q::K2_minus_Kpp})
    out.push_back({report.axis_names.front() + ": " + info(quantity).label,
                   coefficient_words(report, axis, quantity), true});
  out.push_back({"Radius", with_std(scaled(report.fit.radius.value, 1e3), "mm", absent)});
  out.push_back({"Turns", fixed(report.fit.turns, 0)});
  return out;
}

Table coefficients_table(const RotationReport& report) {
  Table table{"Coefficients of the model equation, ± one standard deviation", {"Coefficient"}, {}};
  table.head.insert(table.head.end(), report.axis_names.begin(), report.axis_names.end());
  for (std::size_t q = 0; q < quantities.size(); ++q) {
    std::vector<std::string> row{quantities[q].label};
    for (const RotationAxis& axis : report.fit.axes)
      row.push_back(coefficient_words(report, axis, static_cast<Q>(q)));
    table.rows.push_back(std::move(row));
  }
  std::vector<std::string> residual{"Residual, rms"};
  for (const RotationAxis& axis : report.fit.axes)
    residual.push_back(significant(axis.residual_rms, 3) + " " + print_unit(report.unit));
  table.rows.push_back(std::move(residual));
  return table;
}

Table sections_table(const RotationReport& report) {
  Table table{"Sections of steady rotation", {"Recording", "From", "To", "Turns", "Speed"}, {}};
  table.long_list = true;
  for (const calibrate::RotationSection& one : report.fit.sections)
    table.rows.push_back({report.inputs.at(one.recording), fixed(one.start_s, 2) + " s",
                          fixed(one.end_s, 2) + " s", fixed(one.turns, 0),
                          significant(one.speed_radps / radps_per_rpm, 4) + " rpm"});
  return table;
}

// Reasons of absent coefficients, each once.
std::vector<std::string> absence_reasons(const RotationReport& report) {
  std::vector<std::string> all;
  for (const RotationAxis& axis : report.fit.axes)
    for (const RotationCoefficient& one : axis.coefficients) {
      const std::string words = "Not determined: " + one.reason + ".";
      if (!one.reason.empty() && std::ranges::find(all, words) == all.end()) all.push_back(words);
    }
  return all;
}

std::vector<double> in_degrees(const std::vector<double>& angle_rad) {
  std::vector<double> angle(angle_rad);
  for (double& a : angle) a *= deg_per_rad;
  return angle;
}

Figure response_figure(const RotationReport& report) {
  Figure figure{.title = "Output against the angle",
                .description =
                    "Mean output in 72 bins of the turn; 0° is where the axis is "
                    "horizontal and turning upwards.",
                .x = {.label = "Angle of the axis (°)", .min = 0.0, .max = 360.0},
                .y = {.label = "Output (" + print_unit(report.unit) + ")"}};
  constexpr Ink inks[] = {Ink::blue, Ink::orange};
  for (std::size_t at = 0; at < report.fit.axes.size(); ++at) {
    const calibrate::RotationFold& fold = report.fit.axes[at].fold;
    figure.curves.push_back(
        {report.axis_names[at], in_degrees(fold.angle_rad), fold.mean, inks[at % 2], Mark::points});
  }
  return figure;
}

Figure residual_figure(const RotationReport& report, std::size_t at) {
  const calibrate::RotationFold& fold = report.fit.axes[at].fold;
  Band band{"95 % for white noise", in_degrees(fold.angle_rad), {}, {}};
  for (const double std : fold.residual_std) {
    band.lower.push_back(-normal_95 * std);
    band.upper.push_back(normal_95 * std);
  }
  return {
      .title = report.axis_names[at] + ": residual against the angle",
      .description =
          "Residuals of the fit, folded over the turns. A curve outside the band repeats "
          "every turn and is not in the model equation.",
      .x = {.label = "Angle of the axis (°)", .min = 0.0, .max = 360.0},
      .y = {.label = "Residual (" + print_unit(report.unit) + ")"},
      .bands = {std::move(band)},
      .curves = {{"residual", in_degrees(fold.angle_rad), fold.residual, Ink::blue, Mark::points}},
      .levels = {{"", 0.0}}};
}

Section folded_section(const RotationReport& report) {
  Section section{.heading = "Folded over the turns",
                  .figures = {[&] { return response_figure(report); }}};
  for (std::size_t at = 0; at < report.fit.axes.size(); ++at)
    section.figures.emplace_back([&report, at] { return residual_figure(report, at); });
  return section;
}

Section method_section(const RotationReport& report) {
  return {
      .heading = "How it was computed",
      .paragraphs = {
          "E = B0 + S1 sin φ + C1 cos φ + S2 sin 2φ + C2 cos 2φ + S3 sin 3φ + C3 cos 3φ − A ω², "
          "fitted to all samples of steady rotation; without an encoder φ is a cubic spline of the "
          "time with knots several turns apart. K1 = (S1 + 3 S3)/g, K2 − Kpp = −2 C2/(K1 g²), Kip "
          "= 2 S2/(K1 g²), K3 = −4 S3/(K1 g³), r = A/K1.",
          fmt::format("Standard deviations come from the scatter between {} of whole turns: they "
                      "hold for noise of any colour with a correlation time below a block.",
                      count_words(report.fit.blocks, "block")),
          fmt::format("Gravity was taken as {} m/s².", fixed(report.gravity_mps2, 5))}};
}

}  // namespace

Document describe(const RotationReport& report) {
  Document document{.page = {.verb = "tumble",
                             .title = "Coefficients from a rotating table",
                             .inputs = report.inputs,
                             .conclusion = conclusion(report),
                             .key_figures = figures_of(report),
                             .notes = report.notes},
                    .fields = rotation_fields(report)};
  document.page.sections = {{.heading = "Coefficients",
                             .points = absence_reasons(report),
                             .tables = {coefficients_table(report), sections_table(report)},
                             .on_terminal = true},
                            folded_section(report),
                            method_section(report)};
  return document;
}

}  // namespace proofmass::report
