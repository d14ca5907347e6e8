#include "proofmass/report/budget_report.hpp"

#include <array>
#include <fmt/format.h>

#include "proofmass/core/units.hpp"
#include "proofmass/report/json.hpp"
#include "proofmass/report/page.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using estimate::BudgetError;
using estimate::BudgetParts;
using estimate::BudgetRow;

constexpr double mps2_per_mg = 1e-3 * standard_gravity_mps2;

// "15 mm ± 2 mm": the error that the bias makes, and how sure that is.
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
                    "What double integration from rest makes of the bias: it grows with "
                    "the square of the time.",
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
  if (report.rows.empty() || report.rows.front().errors.empty()) return "Nothing to compute.";
  const BudgetRow& best = report.rows.front();
  const BudgetRow& worst = report.rows.back();
  const std::string when = duration_words(best.errors.back().t_s);
  if (report.rows.size() == 1) {
    return fmt::format("After {} the position of {} is off by {}.", when, best.name,
                       error_words(best.errors.back()));
  }
  return fmt::format("After {} the position is off by {} ({}) to {} ({}).", when,
                     error_words(best.errors.back()), best.name, error_words(worst.errors.back()),
                     worst.name);
}

Object parts_object(const BudgetParts& parts) {
  return {{"bias", parts.bias_m},
          {"white", parts.white_m},
          {"flicker", parts.flicker_m},
          {"random_walk", parts.random_walk_m},
          {"ramp", parts.ramp_m}};
}

// What the figure behind ± consists of at the last time; no row where it is 0.
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

}  // namespace

std::string budget_json(const BudgetReport& report) {
  Array rows;
  for (const BudgetRow& row : report.rows) {
    Array errors;
    for (const BudgetError& error : row.errors) {
      errors.push_back(Object{{"t_s", error.t_s},
                              {"value", error.position_m.value},
                              {"std", error.position_m.std},
                              {"unit", "m"},
                              {"std_parts", parts_object(error.parts)}});
    }
    rows.push_back(Object{{"grade", row.name},
                          {"bias", quantity(row.bias_mps2, "m/s^2")},
                          {"bias_mg", row.bias_mps2.value / mps2_per_mg},
                          {"error_m", std::move(errors)}});
  }
  return to_json({"budget", report.inputs, texts(report.notes, Severity::warning)},
                 {{"rows", std::move(rows)}});
}

std::string budget_text(const BudgetReport& report) {
  std::vector<std::vector<std::string>> rows{heading(report)};
  for (const BudgetRow& row : report.rows) rows.push_back(cells(row));
  return conclusion(report) + "\n\n" + aligned(rows);
}

std::string budget_html(const BudgetReport& report) {
  Table table{"Error of the position by double integration, from rest", heading(report), {}};
  for (const BudgetRow& row : report.rows) table.rows.push_back(cells(row));
  Page page{.verb = "budget",
            .title = "Position error of an accelerometer left to itself",
            .inputs = report.inputs,
            .conclusion = conclusion(report),
            .notes = report.notes};
  page.sections = {
      {.heading = "Error after each time",
       .tables = {std::move(table)},
       .figures = {error_figure(report)}},
      {.heading = "How it was computed",
       .paragraphs = {
           "A bias b that no calibration has removed gives ½ b t² after the time t. The standard "
           "deviation behind ± is √((½ σ t²)² + N² t³/3 + (½ σ_B t²)² + K² t⁵/20 + (R t³/6)²): σ "
           "of the bias, N white noise (velocity random walk), K random walk from the beginning of "
           "the integration, R ramp, and σ_B = B √((ln(P/(2π t)) + 1.17)/π) from flicker B of "
           "periods up to P, one hour or ten times t. Scale errors and tilt act through the motion "
           "and are not in it."}}};
  Table parts = parts_table(report);
  if (!parts.rows.empty()) page.sections.front().tables.push_back(std::move(parts));
  return html(page);
}

}  // namespace proofmass::report
