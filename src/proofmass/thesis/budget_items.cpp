#include "proofmass/thesis/budget_items.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <fmt/format.h>
#include <string_view>

#include "proofmass/core/units.hpp"
#include "proofmass/estimate/position_budget.hpp"
#include "proofmass/report/wording.hpp"
#include "proofmass/sensor/grades.hpp"

namespace proofmass::thesis {
namespace {

using estimate::BudgetRow;
using Cells = std::array<double, 4>;

const ShownUnit millimetres{"mm", 1e-3}, metres{"m", 1.0}, kilometres{"km", 1e3};

struct PrintedRow {
  Cells position_m;
  std::array<ShownUnit, 4> shown;
};

/// Table 2.1, grade by grade, after 1 s, 10 s, 1 min and 1 h; "015 mm" is 15 mm.
const std::array<PrintedRow, 4> printed{{
    {{0.13e-3, 12e-3, 0.44, 1.6e3}, {millimetres, millimetres, metres, kilometres}},
    {{1.5e-3, 150e-3, 5.3, 19e3}, {millimetres, millimetres, metres, kilometres}},
    {{15e-3, 1.5, 53.0, 190e3}, {millimetres, metres, metres, kilometres}},
    {{620e-3, 60.0, 2.2e3, 7900e3}, {millimetres, metres, kilometres, kilometres}},
}};
constexpr std::array<std::string_view, 4> time_keys{"1s", "10s", "1min", "1h"};

/// Position error of a navigator levelled by its accelerometers due to a bias, over ½ b t²:
///
///     (b/ω²)(1 − cos ωt) / (½ b t²),   ω² = g/R
///
/// Source: D. H. Titterton, J. L. Weston, Strapdown Inertial Navigation Technology (2004), chapter
/// 12.
double schuler_share(double t_s) {
  constexpr double earth_radius_m = 6.371e6;
  const double phase = t_s * std::sqrt(standard_gravity_mps2 / earth_radius_m);
  return 2.0 * (1.0 - std::cos(phase)) / (phase * phase);
}

std::string lower_case(std::string_view text) {
  std::string out(text);
  std::ranges::transform(out, out.begin(), [](unsigned char c) { return std::tolower(c); });
  return out;
}

double printed_m(std::size_t grade, std::size_t time) {
  return printed.at(grade).position_m.at(time);
}

double ours_m(const std::vector<BudgetRow>& rows, std::size_t grade, std::size_t time) {
  return rows[grade].errors[time].position_m.value;
}

std::vector<Finding> cells(const std::vector<BudgetRow>& rows) {
  std::vector<Finding> findings;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t j = 0; j < time_keys.size(); ++j) {
      findings.push_back({.key = fmt::format("{}_{}", lower_case(rows[i].name), time_keys.at(j)),
                          .label = fmt::format("{}, {}", rows[i].name,
                                               report::duration_words(sensor::grade_times_s.at(j))),
                          .si_unit = "m",
                          .shown = printed.at(i).shown.at(j),
                          .thesis = printed_m(i, j),
                          .ours = Uncertain{ours_m(rows, i, j), 0.0}});
    }
  }
  findings.push_back({.key = "schuler_1h",
                      .label = "Of ½ b t², what a level navigator is off by after 1 h",
                      .si_unit = "",
                      .shown = {"%", 0.01},
                      .ours = Uncertain{schuler_share(3600.0), 0.0}});
  return findings;
}

/// The thesis's layout: what it prints, and by how much that differs from ½ b t².
report::Table layout(const std::vector<BudgetRow>& rows) {
  report::Table table{
      "Position error ½ b t², and in brackets by how much the printed figure is off",
      {"Grade", "Bias", "1 s", "10 s", "1 min", "1 h"},
      {}};
  constexpr double mg_mps2 = 1e-3 * standard_gravity_mps2;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    std::vector<std::string> row{rows[i].name,
                                 report::compact(rows[i].bias_mps2.value / mg_mps2, 4) + " mg"};
    for (std::size_t j = 0; j < time_keys.size(); ++j) {
      const double exact = ours_m(rows, i, j);
      const ShownUnit& unit = printed.at(i).shown.at(j);
      const double off = 100.0 * (printed_m(i, j) / exact - 1.0);
      row.push_back(fmt::format("{} {} ({}{} %)", report::significant(exact / unit.to_si, 3),
                                unit.symbol, off > 0.0 ? "+" : "", report::fixed(off, 1)));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

report::Figure growth(const std::vector<BudgetRow>& rows) {
  constexpr std::array inks{report::Ink::blue, report::Ink::green, report::Ink::orange,
                            report::Ink::red};
  report::Figure figure{.title = "Position error of a bias",
                        .description = "Lines: ½ b t² of each grade. Dots: what the thesis prints.",
                        .x = {.label = "Time (s)", .scale = report::AxisScale::log},
                        .y = {.label = "Position error (m)", .scale = report::AxisScale::log}};
  const Cells& times_s = sensor::grade_times_s;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    report::Curve line{.label = rows[i].name, .x = {}, .y = {}, .ink = inks.at(i)};
    report::Curve dots{
        .label = "", .x = {}, .y = {}, .ink = inks.at(i), .mark = report::Mark::points};
    for (std::size_t j = 0; j < times_s.size(); ++j) {
      line.x.push_back(times_s.at(j));
      line.y.push_back(ours_m(rows, i, j));
      dots.x.push_back(times_s.at(j));
      dots.y.push_back(printed_m(i, j));
    }
    figure.curves.push_back(std::move(line));
    figure.curves.push_back(std::move(dots));
  }
  return figure;
}

double worst_off(const std::vector<BudgetRow>& rows) {
  double worst = 0.0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t j = 0; j < time_keys.size(); ++j)
      worst = std::max(worst, std::abs(printed_m(i, j) / ours_m(rows, i, j) - 1.0));
  }
  return worst;
}

}  // namespace

std::vector<Item> budget_items() {
  const std::vector<BudgetRow> rows =
      estimate::position_budget(estimate::grade_sensors(), sensor::grade_times_s);
  Item item{.id = "table 2.1",
            .title = "Position error of each grade of accelerometer",
            .thesis =
                "Biases of 0.025, 0.3, 3 and 125 mg cost from 0.13 mm after 1 s to 7900 km "
                "after 1 h; \"015 mm\" is a misprint of 15 mm.",
            .ours = fmt::format("½ b t² gives {} to {}; of the sixteen printed figures none is "
                                "further off than {} %.",
                                report::length_words(ours_m(rows, 0, 0)),
                                report::length_words(ours_m(rows, 3, 3)),
                                report::fixed(100.0 * worst_off(rows), 1)),
            .note = ""};
  item.note = fmt::format(
      "They agree but for rounding: 0.13 and 620 mm are those of g = 10 m/s². After an hour ½ b t² "
      "is a measure of the sensor and no position: a navigator that keeps itself level swings with "
      "Schuler's period of 84 min, and the same bias puts it off by {} % of that. Take the verb "
      "budget, "
      "which has the noise beside the bias.",
      report::fixed(100.0 * schuler_share(3600.0), 1));
  item.findings = cells(rows);
  item.tables.push_back(layout(rows));
  item.figures.push_back(growth(rows));
  return {std::move(item)};
}

}  // namespace proofmass::thesis
