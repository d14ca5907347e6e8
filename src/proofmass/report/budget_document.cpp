#include <array>
#include <fmt/format.h>

#include "proofmass/core/units.hpp"
#include "proofmass/report/budget_report.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using estimate::BudgetError;
using estimate::BudgetParts;
using estimate::BudgetRow;

constexpr double mps2_per_mg = 1e-3 * standard_gravity_mps2;

// "15 mm ± 2 mm": error due to the bias, and its standard deviation.
std::string error_words(const BudgetError& error) {
  const std::string size = length_words(error.position_m.value);
  return error.position_m.std > 0.0 ? size + " ± " + length_words(error.position_m.std) : size;
}

std::string bias_words(const BudgetRow& row) {
  const Uncertain mg{row.bias_mps2.value / mps2_per_mg, row.bias_mps2.std / mps2_per_mg};
  return mg.std > 0.0 ? with_std(mg, "mg") : compact(mg.value, 6) + " mg";
}

std::vector<std::string> heading(const BudgetReport& report) {
  std::vector<std::string> cells{"Sensor", "Bias"};
  if (report.rows.empty()) return cells;
  for (const BudgetError& error : report.rows.front().errors) {
    cells.push_back("after " + duration_words(error.t_s));
  }
  return cells;
}

std::vector<std::string> cells(const BudgetRow& row) {
  std::vector<std::string> cells{row.name, bias_words(row)};
  for (const BudgetError& error : row.errors) cells.push_back(error_words(error));
  return cells;
}

Figure error_figure(const BudgetReport& report) {
  constexpr std::array inks{Ink::blue, Ink::green, Ink::orange, Ink::red, Ink::purple, Ink::grey};
  Figure figure{.title = "Position error against time",
                .description =
                    "Double integration from rest: the error by a bias grows with the "
                    "square of the time.",
                .x = {.label = "Time (s)", .scale = AxisScale::log},
                .y = {.label = "Error (m)", .scale = AxisScale::log},
                .height = 340.0};
  for (std::size_t k = 0; k < report.rows.size(); ++k) {
    const Ink ink = inks[k % inks.size()];
    Curve line{report.rows[k].name, {}, {}, ink};
    for (const BudgetError& error : report.rows[k].errors) {
      line.x.push_back(error.t_s);
      line.y.push_back(std::abs(error.position_m.value) + error.position_m.std);
    }
    Curve points{"", line.x, line.y, ink, Mark::points};
    figure.curves.push_back(std::move(line));
    figure.curves.push_back(std::move(points));
  }
  return figure;
}

std::string conclusion(const BudgetReport& report) {
  if (report.rows.empty() && !report.parts.empty())
    return fmt::format("{} compared by their datasheets.",
                       count_words(report.parts.size(), "part"));
  if (report.rows.empty() || report.rows.front().errors.empty()) return "Nothing to compute.";
  const BudgetRow& best = report.rows.front();
  const BudgetRow& worst = report.rows.back();
  const std::string when = duration_words(best.errors.back().t_s);
  if (report.rows.size() == 1) {
    return fmt::format("After {} the position error of {} is {}.", when, best.name,
                       error_words(best.errors.back()));
  }
  return fmt::format("After {} the position error is {} ({}) to {} ({}).", when,
                     error_words(best.errors.back()), best.name, error_words(worst.errors.back()),
                     worst.name);
}

Field parts_field(const BudgetParts& parts) {
  return field::object(
      "std_parts",
      {field::magnitude("bias", parts.bias_m), field::magnitude("white", parts.white_m),
       field::magnitude("flicker", parts.flicker_m),
       field::magnitude("random_walk", parts.random_walk_m),
       field::magnitude("ramp", parts.ramp_m)},
      {.meaning = "contributions to std in metres, which add in quadrature"});
}

Fields error_fields(const BudgetError& error) {
  return {field::number("t_s", error.t_s, {.meaning = "since the beginning of the integration"}),
          field::number("value", error.position_m.value, {.meaning = "½ b t²"}),
          field::magnitude("std", error.position_m.std), field::choice("unit", "m", {"m"}),
          parts_field(error.parts)};
}

Fields row_fields(const BudgetRow& row) {
  return {field::text("grade", row.name, {.meaning = "of sensor, or the sensor's name and axis"}),
          field::measured("bias", row.bias_mps2, "m/s^2"),
          field::number("bias_mg", row.bias_mps2.value / mps2_per_mg,
                        {.meaning = "the same value in 1e-3 of standard gravity"}),
          field::records("error_m", row.errors, error_fields)};
}

Field part_figure(std::string key, const std::optional<sensor::PartFigure>& figure, About about) {
  about.why_null = "not in the table: the datasheet has none, or in another form";
  std::optional<Fields> fields;
  if (figure)
    fields = Fields{
        field::number("value", figure->value),
        field::choice("kind", figure->kind == sensor::FigureKind::limit ? "limit" : "typical",
                      {"typical", "limit"})};
  return field::object_or_null(std::move(key), std::move(fields), std::move(about));
}

Fields part_error_fields(const PartRow& row, const PartError& error) {
  return {field::number("t_s", error.t_s),
          field::magnitude("delivered", error.delivered_m,
                           {.meaning = "double integration from rest with the offset as delivered",
                            .why_null = row.why_not_delivered}),
          field::magnitude("calibrated", error.calibrated_m,
                           {.meaning = "the same with the bias calibrated, after a change of "
                                       "temperature",
                            .why_null = row.why_not_calibrated}),
          field::magnitude("between_rests", error.between_rests_m,
                           {.meaning = "of the distance between two rests so far apart",
                            .why_null = row.why_not_between_rests})};
}

Fields part_fields(const PartRow& row) {
  const sensor::AccelerometerPart& part = *row.part;
  return {field::text("name", part.name),
          field::text("maker", part.maker),
          field::choice("output", part.output == sensor::PartOutput::analog ? "analog" : "digital",
                        {"analog", "digital"}),
          field::text("document", part.document, {.meaning = "the datasheet of the figures"}),
          field::magnitude("range_mps2", part.range_mps2),
          part_figure("noise_mps2_rthz", part.noise_mps2_rthz, {.meaning = "one-sided density"}),
          part_figure("offset_mps2", part.offset_mps2, {.meaning = "±, as delivered"}),
          part_figure("offset_mps2_per_k", part.offset_mps2_per_k, {}),
          part_figure("in_run_mps2", part.in_run_mps2, {.meaning = "bias instability"}),
          part_figure("repeatability_mps2", part.repeatability_mps2, {}),
          part_figure("scale", part.scale, {.meaning = "± fraction"}),
          part_figure("scale_per_k", part.scale_per_k, {}),
          part_figure("nonlinearity", part.nonlinearity, {.meaning = "± fraction of full scale"}),
          part_figure("cross_axis", part.cross_axis, {}),
          field::records("std_m", row.errors,
                         [&row](const PartError& error) { return part_error_fields(row, error); })};
}

// At one time, by falling error between rests.
Table jobs_table(const BudgetReport& report, std::size_t at) {
  const double t_s = report.parts.front().errors[at].t_s;
  Table table{fmt::format("Standard deviation of the position after {} (calibrated: {:g} K from "
                          "the temperature of the calibration)",
                          duration_words(t_s), report.temperature_change_k),
              {"Part", "Maker", "As delivered", "Calibrated", "Between rests"},
              {}};
  const auto words = [](const std::optional<double>& error_m) {
    return error_m ? length_words(*error_m) : std::string(absent);
  };
  for (const PartRow& row : report.parts) {
    const PartError& error = row.errors[at];
    table.rows.push_back({std::string(row.part->name), std::string(row.part->maker),
                          words(error.delivered_m), words(error.calibrated_m),
                          words(error.between_rests_m)});
  }
  return table;
}

std::string figure_words(const std::optional<sensor::PartFigure>& figure,
                         double factor,
                         const char* unit) {
  if (!figure) return std::string(absent);
  return fmt::format("{} {}{}", compact(figure->value * factor, 3), unit,
                     figure->kind == sensor::FigureKind::limit ? " max" : "");
}

Table datasheets_table(const BudgetReport& report) {
  Table table{"Figures of the datasheets; typical unless max is stated",
              {"Part", "Noise", "Offset", "Per kelvin", "Scale", "Document"},
              {}};
  table.page_only = true;
  constexpr double g = standard_gravity_mps2;
  for (const PartRow& row : report.parts) {
    const sensor::AccelerometerPart& part = *row.part;
    table.rows.push_back({std::string(part.name),
                          figure_words(part.noise_mps2_rthz, 1e6 / g, "µg/√Hz"),
                          figure_words(part.offset_mps2, 1e3 / g, "mg"),
                          figure_words(part.offset_mps2_per_k, 1e3 / g, "mg"),
                          figure_words(part.scale, 100.0, "%"), std::string(part.document)});
  }
  return table;
}

Section parts_section(const BudgetReport& report) {
  Section section{
      .heading = "Parts by their datasheets",
      .paragraphs =
          {"A typical figure counts as one standard deviation, a limit as that of a "
           "uniform distribution. Between two rests a constant bias cancels: what "
           "remains is √(N² t³/12 + B² t⁴/(16 π)). Drift of the bias that a datasheet "
           "does not state (flicker, random walk), scale error and a change of tilt "
           "are not included: characterise the device with noise and calibrate. The figures were "
           "transcribed by hand, most of them without a comparison with the current "
           "revision: check those that matter in the datasheet."},
      .on_terminal = true};
  for (std::size_t at = 0; at < report.parts.front().errors.size(); ++at)
    section.tables.push_back(jobs_table(report, at));
  section.tables.push_back(datasheets_table(report));
  return section;
}

// Contributions to the standard deviation at the last time; those that are 0 are omitted.
Table parts_table(const BudgetReport& report) {
  Table table{"", {"Sensor", "Bias", "White noise", "Flicker", "Random walk", "Ramp"}, {}};
  for (const BudgetRow& row : report.rows) {
    if (row.errors.empty() || !(row.errors.back().position_m.std > 0.0)) continue;
    const BudgetError& error = row.errors.back();
    table.caption =
        "Standard deviation of the position after " + duration_words(error.t_s) + ", by cause";
    std::vector<std::string>& cells = table.rows.emplace_back();
    cells.push_back(row.name);
    const BudgetParts& parts = error.parts;
    for (const double part :
         {parts.bias_m, parts.white_m, parts.flicker_m, parts.random_walk_m, parts.ramp_m})
      cells.push_back(part > 0.0 ? length_words(part) : "–");
  }
  return table;
}

Section error_section(const BudgetReport& report) {
  Table table{"Error of the position by double integration, from rest", heading(report), {}};
  for (const BudgetRow& row : report.rows) table.rows.push_back(cells(row));
  Section section{.heading = "Error after each time",
                  .tables = {std::move(table)},
                  .figures = {[&] { return error_figure(report); }},
                  .on_terminal = true};
  Table parts = parts_table(report);
  parts.page_only = true;
  if (!parts.rows.empty()) section.tables.push_back(std::move(parts));
  return section;
}

}  // namespace

Document describe(const BudgetReport& report) {
  Document document{
      .page = {.verb = "budget",
               .title = "Position error of an unaided accelerometer",
               .inputs = report.inputs,
               .conclusion = conclusion(report),
               .notes = report.notes},
      .fields = {field::records("rows", report.rows, row_fields),
                 field::records("parts", report.parts, part_fields, {.meaning = "with --parts"}),
                 field::number("temperature_change_k", report.temperature_change_k,
                               {.meaning = "of the calibrated parts"})}};
  if (!report.rows.empty()) document.page.sections.push_back(error_section(report));
  if (!report.parts.empty()) document.page.sections.push_back(parts_section(report));
  document.page.sections.push_back(
      {.heading = "How it was computed",
       .paragraphs = {
           "An uncorrected bias b gives ½ b t² after the time t. The standard deviation after ± "
           "is √((½ σ t²)² + N² t³/3 + (½ σ_B t²)² + K² t⁵/20 + (R t³/6)²): σ of the bias, N "
           "white noise (velocity random walk), K random walk from the beginning of the "
           "integration, R ramp, and σ_B = B √((ln(P/(2π t)) + 1.17)/π) from flicker B of periods "
           "up to P, one hour or ten times t. Scale errors and tilt act through the motion and "
           "are not included."}});
  return document;
}

}  // namespace proofmass::report
