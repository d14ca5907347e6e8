#include <algorithm>
#include <fmt/format.h>

#include "proofmass/core/units.hpp"
#include "proofmass/report/model_equation_report.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using calibrate::Combination;
using calibrate::Confounded;
using calibrate::FittedCoefficient;
using calibrate::ModelFit;
using sensor::Coefficient;

// Replaces "{}" by the unit of the output.
std::string with_output_unit(std::string_view pattern, const std::string& output_unit) {
  std::string unit(pattern);
  const auto place = unit.find("{}");
  if (place == std::string::npos) return unit;
  unit.replace(place, 2, output_unit.empty() ? "output" : output_unit);
  return unit == "m/s^2/(m/s^2)" ? "1" : unit;
}

std::string si_unit(Coefficient coefficient, const std::string& output_unit) {
  return with_output_unit(sensor::info(coefficient).unit, output_unit);
}

std::string shown_unit(const std::string& unit) {
  return unit == "1" ? "" : print_unit(unit);
}

// In the units of the standard: g instead of m/s².
std::optional<Uncertain> in_standard(const FittedCoefficient& one) {
  if (!one.value) return std::nullopt;
  return Uncertain{sensor::in_standard_unit(one.coefficient, one.value->value),
                   sensor::in_standard_unit(one.coefficient, one.value->std)};
}

std::string standard_unit(const FittedCoefficient& one, const std::string& output_unit) {
  return with_output_unit(sensor::info(one.coefficient).standard_unit, output_unit);
}

std::string value_words(const FittedCoefficient& one, const std::string& output_unit) {
  return with_std(in_standard(one), shown_unit(standard_unit(one, output_unit)), absent);
}

Field si_value(std::string key, const FittedCoefficient& one, const std::string& output_unit) {
  return field::measured(std::move(key), one.value, si_unit(one.coefficient, output_unit),
                         {.why_null = one.reason});
}

Fields coefficient_fields(const FittedCoefficient& one, const std::string& output_unit) {
  const sensor::CoefficientInfo& about = sensor::info(one.coefficient);
  std::optional<std::array<double, 2>> ends;
  std::optional<double> inflation;
  if (one.value) {
    ends = {one.value->value - one.half_width_95, one.value->value + one.half_width_95};
    inflation = one.variance_inflation;
  }
  return {field::text("name", about.name),
          field::text("meaning", about.description),
          si_value("value", one, output_unit),
          field::measured(
              "value_standard", in_standard(one), standard_unit(one, output_unit),
              {.meaning = "in the units of IEEE 1293: g = 9.80665 m/s^2", .why_null = one.reason}),
          field::interval("interval_95", ends, {.why_null = one.reason}),
          field::magnitude("variance_inflation", inflation,
                           {.meaning = "variance over that if the other coefficients were known",
                            .why_null = one.reason}),
          field::text("reason", one.reason, {.meaning = "why there is no value, else empty"})};
}

Fields confounded_fields(const Confounded& group, const std::string& output_unit) {
  std::vector<std::string> names;
  for (const Coefficient one : group.coefficients) names.emplace_back(sensor::info(one).name);
  return {field::texts("coefficients", names),
          field::count("determined", group.determined,
                       {.meaning = "how many of them are identifiable if the others are known"}),
          field::texts("relations", group.relations,
                       {.meaning = "linear dependences of the terms in all rows"}),
          field::records("combinations", group.combinations,
                         [&](const Combination& one) -> Fields {
                           return {field::text("name", one.name),
                                   field::measured("value", one.value,
                                                   si_unit(one.parts.front().first, output_unit))};
                         }),
          field::text("words", group.words)};
}

Field matrix(const char* key, const Eigen::MatrixXd& values, About about) {
  Fields rows;
  for (Eigen::Index r = 0; r < values.rows(); ++r) {
    const Eigen::VectorXd row = values.row(r);
    rows.push_back(field::numbers({}, row));
  }
  return field::list(key, std::move(rows), std::move(about));
}

Field cross_axis(const ModelOutput& output) {
  std::optional<Fields> fields;
  if (output.cross_axis)
    fields = Fields{field::measured("value", output.cross_axis->value, "1",
                                    {.why_null = output.cross_axis->reason}),
                    field::magnitude("upper_95", output.cross_axis->upper_95),
                    field::probability("p", output.cross_axis->p)};
  return field::object_or_null("cross_axis_sensitivity", std::move(fields),
                               {.meaning = "sqrt(delta_o^2 + delta_p^2)",
                                .why_null = "needs delta_o and delta_p, both determined"});
}

Field residual_test(const ModelFit& fit) {
  std::optional<Fields> fields;
  if (fit.test)
    fields = Fields{field::magnitude("chi_square", fit.test->chi_square),
                    field::probability("p", fit.test->p)};
  return field::object_or_null(
      "residual_test", std::move(fields),
      {.meaning = "of the residuals against the stated standard deviations",
       .why_null = "needs stated standard deviations (a column NAME_std) and more rows than "
                   "coefficients"});
}

Fields output_fields(const ModelOutput& output) {
  const ModelFit& fit = output.fit;
  const std::optional<double> condition =
      fit.confounded.empty() ? std::optional(fit.condition) : std::nullopt;
  return {
      field::text("name", output.name),
      field::text("unit", output.unit, {.meaning = "of the output, SI; empty if not known"}),
      field::count("rows", output.rows.size()),
      field::records(
          "coefficients", fit.coefficients,
          [&](const FittedCoefficient& one) { return coefficient_fields(one, output.unit); }),
      matrix("covariance", fit.covariance,
             {.meaning = "of the coefficients in their order, SI; 0 where there is no value"}),
      field::records("confounded", fit.confounded,
                     [&](const Confounded& one) { return confounded_fields(one, output.unit); },
                     {.meaning = "groups of coefficients that the rows do not separate"}),
      cross_axis(output),
      field::count("dof", fit.dof),
      field::magnitude("residual_rms", fit.residual_rms),
      residual_test(fit),
      field::flag("std_stated", fit.std_stated,
                  {.meaning = "standard deviations come from those stated in the rows, not from "
                              "the residuals"}),
      field::magnitude("scatter", fit.scatter,
                       {.meaning = "factor on the stated standard deviations"}),
      field::magnitude("condition", condition,
                       {.meaning = "condition number of the design, columns of unit length",
                        .why_null = "some coefficients are not separable"}),
      field::numbers("residuals", fit.residuals),
      field::texts("notes", fit.notes)};
}

Fields model_equation_fields(const ModelEquationReport& report) {
  Fields out{field::choice("mode", "coefficients", {"coefficients"})};
  if (report.gravity_mps2)
    out.push_back(field::magnitude("gravity_mps2", *report.gravity_mps2,
                                   {.meaning = "where the accelerations follow from angles"}));
  if (report.outputs.size() == 1) {
    const ModelOutput& output = report.outputs.front();
    for (const FittedCoefficient& one : output.fit.coefficients)
      out.push_back(si_value(std::string(sensor::info(one.coefficient).name), one, output.unit));
  }
  out.push_back(field::records("outputs", report.outputs, output_fields));
  out.push_back(field::notes(report.notes));
  return out;
}

Table coefficients_table(const ModelOutput& output) {
  Table table{"Coefficients; accelerations in units of g = 9.80665 m/s²",
              {"Coefficient", "Value", "Variance inflation", "Meaning"},
              {}};
  for (const FittedCoefficient& one : output.fit.coefficients) {
    const sensor::CoefficientInfo& about = sensor::info(one.coefficient);
    table.rows.push_back({std::string(about.name), value_words(one, output.unit),
                          one.value ? compact(one.variance_inflation, 3) : "",
                          std::string(about.description)});
  }
  return table;
}

Table combinations_table(const ModelOutput& output) {
  Table table{"Identifiable combinations, in SI", {"Combination", "Value"}, {}};
  for (const Confounded& group : output.fit.confounded)
    for (const Combination& one : group.combinations)
      table.rows.push_back(
          {one.name,
           with_std(one.value, shown_unit(si_unit(one.parts.front().first, output.unit)))});
  return table;
}

// Reasons of absent coefficients, each once.
std::vector<std::string> absence_reasons(const ModelOutput& output) {
  std::vector<std::string> all;
  for (const FittedCoefficient& one : output.fit.coefficients)
    if (!one.reason.empty() && std::ranges::find(all, one.reason) == all.end())
      all.push_back(one.reason);
  if (output.cross_axis && !output.cross_axis->value) all.push_back(output.cross_axis->reason);
  return all;
}

std::string residual_words(const ModelOutput& output) {
  const ModelFit& fit = output.fit;
  std::string text = fmt::format("Residuals {} {} rms over {}", significant(fit.residual_rms, 3),
                                 print_unit(output.unit), count_words(output.rows.size(), "row"));
  if (fit.test)
    text += fmt::format("; the stated standard deviations {} (χ² = {}, p = {})",
                        fit.test->p < 0.01 ? "do not explain them" : "explain them",
                        compact(fit.test->chi_square, 4), significant(fit.test->p, 2));
  return text + ".";
}

std::string cross_axis_words(const ModelOutput& output) {
  if (!output.cross_axis->value)
    return fmt::format("below {} % (95 %)", significant(100.0 * output.cross_axis->upper_95, 2));
  return with_std(scaled(output.cross_axis->value, 100.0), "%", absent);
}

std::string conclusion(const ModelEquationReport& report) {
  std::string text;
  for (const ModelOutput& output : report.outputs) {
    const auto determined = std::ranges::count_if(
        output.fit.coefficients, [](const auto& one) { return one.value.has_value(); });
    text += fmt::format("{}{}: {} of {} determined. {}", text.empty() ? "" : " ", output.name,
                        determined, count_words(output.fit.coefficients.size(), "coefficient"),
                        residual_words(output));
  }
  return text;
}

std::vector<KeyFigure> figures_of(const ModelEquationReport& report) {
  constexpr std::size_t most = 6;
  std::vector<KeyFigure> out;
  for (const ModelOutput& output : report.outputs)
    for (const FittedCoefficient& one : output.fit.coefficients)
      if (one.value && out.size() < most)
        out.push_back({fmt::format("{} {}", output.name, sensor::info(one.coefficient).name),
                       value_words(one, output.unit), true});
  return out;
}

Figure residual_figure(const ModelOutput& output) {
  Curve curve{"", {}, output.fit.residuals, Ink::blue, Mark::points};
  for (const calibrate::ModelRow& row : output.rows)
    curve.x.push_back(row.motion.ai_mps2 / standard_gravity_mps2);
  const std::string unit = output.unit.empty() ? "" : " (" + print_unit(output.unit) + ")";
  return {.title = output.name + ": residuals against the input acceleration",
          .description =
              "Output less fitted equation, row by row. A systematic curve indicates a "
              "missing term.",
          .x = {.label = "Acceleration along the input axis (g)"},
          .y = {.label = "Residual" + unit},
          .curves = {std::move(curve)},
          .levels = {{"", 0.0}}};
}

Section output_section(const ModelOutput& output) {
  Section section{.heading = output.name,
                  .paragraphs = {residual_words(output)},
                  .points = absence_reasons(output),
                  .tables = {coefficients_table(output)},
                  .figures = {[&] { return residual_figure(output); }},
                  .on_terminal = true};
  if (!output.fit.confounded.empty()) section.tables.push_back(combinations_table(output));
  const std::vector<std::string>& notes = output.fit.notes;
  section.points.insert(section.points.end(), notes.begin(), notes.end());
  if (output.cross_axis)
    section.paragraphs.push_back(
        "Cross-axis sensitivity √(δ_o² + δ_p²): " + cross_axis_words(output) + ".");
  return section;
}

Section method_section() {
  return {
      .heading = "How it was computed",
      .paragraphs = {
          "E = K1 (K0 + (K0′/2) sgn a_i + (1 + (K1′/2) sgn a_i) a_i + K_oq a_i |a_i| + K2 a_i² + "
          "K3 a_i³ + δ_o a_p − δ_p a_o + K_ip a_i a_p + K_io a_i a_o + K_po a_p a_o + K_pp a_p² + "
          "K_oo a_o² + K_spin ω_i ω_p + K_ang ω̇_o), fitted by least squares in the products of "
          "K1 and the coefficients; coefficients that are not fitted are zero. ± is one standard "
          "deviation. Variance inflation is the variance over that if the other coefficients were "
          "known."}};
}

// The report's notes, then those of the fits, prefixed with the output's name.
std::vector<Note> all_notes(const ModelEquationReport& report) {
  std::vector<Note> notes = report.notes;
  for (const ModelOutput& output : report.outputs)
    for (const std::string& text : output.fit.notes)
      notes.push_back({Severity::warning, output.name + ": " + text});
  return notes;
}

}  // namespace

Document describe(const ModelEquationReport& report) {
  Document document{.page = {.verb = "tumble",
                             .title = "Model equation of an accelerometer",
                             .inputs = report.inputs,
                             .conclusion = conclusion(report),
                             .key_figures = figures_of(report),
                             .notes = all_notes(report)},
                    .fields = model_equation_fields(report)};
  for (const ModelOutput& output : report.outputs)
    document.page.sections.push_back(output_section(output));
  document.page.sections.push_back(method_section());
  return document;
}

}  // namespace proofmass::report
