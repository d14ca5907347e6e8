#include "proofmass/report/model_equation_report.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "proofmass/core/units.hpp"
#include "proofmass/report/json.hpp"
#include "proofmass/report/page.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using calibrate::Confounded;
using calibrate::FittedCoefficient;
using calibrate::ModelFit;

std::string unit_words(const FittedCoefficient& one, const std::string& output_unit) {
  std::string unit(sensor::info(one.coefficient).standard_unit);
  const auto place = unit.find("{}");
  if (place != std::string::npos) {
    unit.replace(place, 2, output_unit.empty() ? "output" : print_unit(output_unit));
  }
  return unit == "1" ? "" : unit;
}

// In the units that the standard has: g, not m/s².
std::string figure(const FittedCoefficient& one, const std::string& output_unit) {
  if (!one.value) return std::string(absent);
  const auto convert = [&](double x) { return sensor::in_standard_unit(one.coefficient, x); };
  return with_std(Uncertain{convert(one.value->value), convert(one.value->std)},
                  unit_words(one, output_unit));
}

std::vector<std::vector<std::string>> rows_of(const ModelOutput& output) {
  std::vector<std::vector<std::string>> rows;
  for (const FittedCoefficient& one : output.fit.coefficients) {
    const sensor::CoefficientInfo& about = sensor::info(one.coefficient);
    rows.push_back({std::string(about.name), figure(one, output.unit),
                    one.value ? compact(one.variance_inflation, 3) : "",
                    std::string(about.description)});
  }
  return rows;
}

std::vector<std::vector<std::string>> combination_rows(const ModelOutput& output) {
  std::vector<std::vector<std::string>> rows;
  for (const Confounded& group : output.fit.confounded) {
    for (const calibrate::Combination& one : group.combinations) {
      std::string unit(sensor::info(one.parts.front().first).unit);
      const auto place = unit.find("{}");
      if (place != std::string::npos) {
        unit.replace(place, 2, output.unit.empty() ? "output" : output.unit);
      }
      rows.push_back({one.name, with_std(one.value, unit == "1" ? "" : print_unit(unit))});
    }
  }
  return rows;
}

// Why something is not there, each reason once.
std::vector<std::string> reasons(const ModelOutput& output) {
  std::vector<std::string> all;
  for (const FittedCoefficient& one : output.fit.coefficients) {
    if (!one.reason.empty() && std::ranges::find(all, one.reason) == all.end()) {
      all.push_back(one.reason);
    }
  }
  if (output.cross_axis && !output.cross_axis->value) all.push_back(output.cross_axis->reason);
  return all;
}

std::string judgement(const ModelOutput& output) {
  const ModelFit& fit = output.fit;
  std::string text = fmt::format("Residuals {} {} rms over {}", significant(fit.residual_rms, 3),
                                 print_unit(output.unit), count_words(output.rows.size(), "row"));
  if (fit.test) {
    text += fmt::format("; the stated standard deviations {} (χ² = {}, p = {})",
                        fit.test->p < 0.01 ? "do not explain them" : "explain them",
                        compact(fit.test->chi_square, 4), significant(fit.test->p, 2));
  }
  return text + ".";
}

std::string cross_axis_words(const ModelOutput& output) {
  if (!output.cross_axis) return {};
  if (!output.cross_axis->value) {
    return fmt::format("below {} % (95 %)", significant(100.0 * output.cross_axis->upper_95, 2));
  }
  return with_std(scaled(output.cross_axis->value, 100.0), "%", absent);
}

std::string conclusion(const ModelEquationReport& report) {
  std::string text;
  for (const ModelOutput& output : report.outputs) {
    const auto told = std::ranges::count_if(output.fit.coefficients,
                                            [](const auto& one) { return one.value.has_value(); });
    text +=
        fmt::format("{}{}: {} of {} determined. {}", text.empty() ? "" : " ", output.name, told,
                    count_words(output.fit.coefficients.size(), "coefficient"), judgement(output));
  }
  return text;
}

Figure residual_figure(const ModelOutput& output) {
  Curve curve{"", {}, output.fit.residuals, Ink::blue, Mark::points};
  for (const calibrate::ModelRow& row : output.rows) {
    curve.x.push_back(row.motion.ai_mps2 / standard_gravity_mps2);
  }
  const std::string unit = output.unit.empty() ? "" : " (" + print_unit(output.unit) + ")";
  return {
      .title = output.name + ": residuals against the input acceleration",
      .description =
          "Reading less fitted equation, row by row. A curve in them is a term that is missing.",
      .x = {.label = "Acceleration along the input axis (g)"},
      .y = {.label = "Residual" + unit},
      .curves = {std::move(curve)},
      .levels = {{"", 0.0}}};
}

Section output_section(const ModelOutput& output) {
  Section section{.heading = output.name, .paragraphs = {judgement(output)}};
  section.tables.push_back({"Coefficients; accelerations in units of g = 9.80665 m/s²",
                            {"Coefficient", "Value", "Variance inflation", "Meaning"},
                            rows_of(output)});
  if (!output.fit.confounded.empty()) {
    section.tables.push_back(
        {"What the rows tell together, in SI", {"Sum", "Value"}, combination_rows(output)});
  }
  section.points = reasons(output);
  section.points.insert(section.points.end(), output.fit.notes.begin(), output.fit.notes.end());
  if (output.cross_axis) {
    section.paragraphs.push_back(
        "Cross-axis sensitivity √(δ_o² + δ_p²): " + cross_axis_words(output) + ".");
  }
  section.figures = {residual_figure(output)};
  return section;
}

}  // namespace

std::string model_equation_text(const ModelEquationReport& report) {
  std::string text = conclusion(report) + "\n";
  for (const ModelOutput& output : report.outputs) {
    text += "\n" + aligned(rows_of(output));
    if (!output.fit.confounded.empty()) text += "\n" + aligned(combination_rows(output));
    if (output.cross_axis) {
      text += "\nCross-axis sensitivity " + cross_axis_words(output) + ".\n";
    }
    for (const std::string& reason : reasons(output)) text += reason + ".\n";
  }
  return text;
}

std::string model_equation_html(const ModelEquationReport& report) {
  Page page{.verb = "tumble",
            .title = "Model equation of an accelerometer",
            .inputs = report.inputs,
            .conclusion = conclusion(report),
            .notes = report.notes};
  for (const ModelOutput& output : report.outputs) {
    for (const FittedCoefficient& one : output.fit.coefficients) {
      if (one.value && page.key_figures.size() < 6) {
        page.key_figures.push_back(
            {fmt::format("{} {}", output.name, sensor::info(one.coefficient).name),
             figure(one, output.unit)});
      }
    }
    page.sections.push_back(output_section(output));
  }
  page.sections.push_back(
      {.heading = "How it was computed",
       .paragraphs = {
           "E = K1 (K0 + (K0′/2) sgn a_i + (1 + (K1′/2) sgn a_i) a_i + K_oq a_i |a_i| + K2 a_i² + "
           "K3 a_i³ + δ_o a_p − δ_p a_o + K_ip a_i a_p + K_io a_i a_o + K_po a_p a_o + K_pp a_p² + "
           "K_oo a_o² + K_spin ω_i ω_p + K_ang ω̇_o), fitted by least squares in the products of "
           "K1 and the coefficients; coefficients that were not asked for count as zero. Standard "
           "deviations are one sigma. Variance inflation is how many times larger a variance is "
           "than if the other coefficients were known."}});
  return html(page);
}

}  // namespace proofmass::report
