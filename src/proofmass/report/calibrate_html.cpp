#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/calibrate/rest_accuracy.hpp"
#include "proofmass/report/calibrate_figures.hpp"
#include "proofmass/report/calibrate_wording.hpp"
#include "proofmass/report/page.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using calibrate::MultiPosition;
using calibrate::PoseModel;

std::string title_of(const std::vector<std::string>& inputs) {
  constexpr std::size_t few = 3;
  std::string text;
  for (std::size_t k = 0; k < std::min(inputs.size(), few); ++k)
    text += (k == 0 ? "" : ", ") + file_name(inputs[k]);
  if (inputs.size() > few) text += fmt::format(" and {} more", inputs.size() - few);
  return text;
}

std::string used_words(const MultiPosition& fit) {
  const auto used = static_cast<std::size_t>(std::count_if(
      fit.poses.begin(), fit.poses.end(), [](const auto& pose) { return pose.used; }));
  if (used == fit.poses.size()) return fmt::format("all {}", used);
  return fmt::format("{} of {}", used, fit.poses.size());
}

std::vector<KeyFigure> key_figures(const CalibrateReport& report) {
  const bool known = stds_known(report);
  std::vector<KeyFigure> out;
  const std::optional<calibrate::RestAccuracy> good = calibrate::rest_accuracy(report.fit);
  out.push_back({"Readings at rest are good to (68 %)",
                 good ? mg_words(good->overall_mps2) : "cannot be told"});
  out.push_back({"Positions used", used_words(report.fit)});
  out.push_back({"Residuals over what noise explains",
                 report.fit.lack_of_fit
                     ? significant(std::sqrt(report.fit.lack_of_fit->statistic), 2) + " times"
                     : "cannot be told"});
  const std::vector<CalibrationFigure> figures = calibration_figures(report);
  for (std::size_t k = 0; k < 6; ++k) {
    std::string label = figures[k].key;
    label[0] = static_cast<char>(label[0] - 32);
    out.push_back({std::move(label), figure_words(figures[k], known)});
  }
  return out;
}

std::vector<std::string> capitals(std::vector<std::string> head) {
  for (std::string& word : head)
    if (!word.empty() && word.size() > 1 && word[0] >= 'a' && word[0] <= 'z')
      word[0] = static_cast<char>(word[0] - 32);
  return head;
}

Section figures_section(const CalibrateReport& report) {
  std::vector<std::vector<std::string>> rows = figure_rows(report);
  // The sign stays on the line of its number.
  const std::string sign = "± ";
  for (std::vector<std::string>& row : rows)
    if (row[2].starts_with(sign)) row[2].replace(0, sign.size(), "±\u00a0");
  Table table{stds_known(report)
                  ? "± is one standard deviation"
                  : "No standard deviations: the noise is not known and no position is to spare",
              capitals(rows.front()),
              {rows.begin() + 1, rows.end()}};
  Section section{.heading = "Bias, scale and misalignment"};
  section.tables.push_back(std::move(table));
  section.points = calibrate_findings(report);
  return section;
}

Section positions_section(const CalibrateReport& report) {
  std::vector<std::vector<std::string>> rows = position_rows(report);
  Table table{
      "Residual: length of the calibrated force less gravity; by the others: by a fit to "
      "them alone; t: that over its standard deviation",
      capitals(rows.front()),
      {rows.begin() + 1, rows.end()}};
  constexpr std::size_t most_rows = 100;
  if (table.rows.size() > most_rows) {
    table.caption =
        fmt::format("The first {} of {}; the document has all", most_rows, table.rows.size());
    table.rows.resize(most_rows);
  }
  Section section{.heading = "Positions"};
  section.tables.push_back(std::move(table));
  return section;
}

Section plots_section(const CalibrateReport& report) {
  Section section{.heading = "Residuals and directions"};
  // Rounding is no residual.
  constexpr double rounding_g = 1e-9;
  if (report.fit.residual_rms_mps2 > rounding_g * report.fit.gravity_mps2)
    section.figures.push_back(residual_figure(report));
  section.figures.push_back(direction_figure(report));
  return section;
}

std::string size_words(calibrate::BudgetSize size) {
  switch (size) {
    case calibrate::BudgetSize::too_small:
      return "budget too small";
    case calibrate::BudgetSize::too_large:
      return "budget too large";
    case calibrate::BudgetSize::right:
      break;
  }
  return "agrees";
}

Section check_section(const CalibrateReport& report) {
  const calibrate::MonteCarloCheck& check = *report.check;
  const std::vector<CalibrationFigure> figures = calibration_figures(report);
  Table table{"", {"Figure", "Std by budget", "Std by draws", "Draws within its 95 %", ""}, {}};
  for (const calibrate::ParameterCheck& one : check.parameters) {
    double factor = 1.0;
    std::string unit;
    for (const CalibrationFigure& figure : figures) {
      if (figure.key != one.quantity) continue;
      factor = figure.factor;
      unit = figure.printed_unit.empty() ? "" : " " + figure.printed_unit;
    }
    table.rows.push_back({one.quantity, significant(factor * one.budget_std, 2) + unit,
                          significant(factor * one.drawn_std, 2) + unit,
                          fixed(100.0 * one.inside, 1) + " %", size_words(one.agreement)});
  }
  Section section{.heading = "Check of the uncertainties by Monte Carlo"};
  section.paragraphs = {check.verdict};
  section.tables.push_back(std::move(table));
  return section;
}

// Bias and scale of each file, units in the head.
Table supply_table(const CalibrateReport& report) {
  Table table{"", {"File", "Supply"}, {}};
  for (const SuppliedFit& one : report.supplies) {
    CalibrateReport at;
    at.unit = report.unit;
    at.fit = one.fit;
    std::vector<CalibrationFigure> figures = calibration_figures(at);
    figures.resize(6);
    std::vector<std::string> row{file_name(one.file), compact(one.supply_v, 5) + " V"};
    for (CalibrationFigure& figure : figures) {
      if (table.head.size() < 8)
        table.head.push_back(figure.key + (figure.printed_unit.empty() ? "" : ", ") +
                             figure.printed_unit);
      figure.printed_unit.clear();
      row.push_back(figure_words(figure, stds_known(at)));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

Section supply_section(const CalibrateReport& report) {
  Section section{.heading = "What the supply does"};
  for (const auto& axis : report.supply->axes)
    if (axis) section.points.push_back(axis->words);
  if (report.unit.quantity == Quantity::voltage)
    section.paragraphs.emplace_back(
        "A ratiometric output follows its supply: its scale grows as the supply, and its bias is "
        "the same part of it.");
  section.figures = plots(supply_figures(report));
  section.tables.push_back(supply_table(report));
  return section;
}

std::string method_words(const CalibrateReport& report) {
  std::string text = "multi-position, " + model_words(report.fit.model);
  if (report.fit.model == PoseModel::norm_9 || report.fit.model == PoseModel::norm_6)
    text += ", against the length of local gravity";
  return text;
}

// What the program could not fill in without knowing the report's words.
CertificateData certificate_of(const CalibrateReport& report) {
  CertificateData data = report.certificate;
  if (data.method.empty()) data.method = method_words(report);
  if (data.equations.empty()) {
    data.equations = {"f = T diag(1/scale) (reading − bias)",
                      "T = [1 −α_yz α_zy; 0 1 −α_zx; 0 0 1]"};
    if (report.fit.model != PoseModel::given_12) data.equations.emplace_back("|f| = g");
  }
  if (data.budgets.empty()) data.budgets = report.budgets;
  if (!report.fit.misalignment_rad[0])
    data.not_determined.emplace_back("Misalignment of the axes was not determined.");
  if (!stds_known(report))
    data.not_determined.emplace_back(
        "The noise of the means is not known: U lacks its share and is no interval of 95 percent.");
  if (report.check && stds_known(report) && data.monte_carlo.empty())
    data.monte_carlo = report.check->verdict;
  for (std::string& text : suspect_sentences(report)) data.limits.push_back(std::move(text));
  return data;
}

}  // namespace

std::string calibrate_html(const CalibrateReport& report) {
  Page page{.verb = "calibrate",
            .title = title_of(report.inputs),
            .inputs = report.inputs,
            .conclusion = calibrate_conclusion(report),
            .key_figures = key_figures(report),
            .notes = calibrate_notes(report)};
  page.sections = {figures_section(report), plots_section(report), positions_section(report)};
  if (report.supply) page.sections.push_back(supply_section(report));
  if (report.check && stds_known(report)) page.sections.push_back(check_section(report));
  for (Section& section : certificate_sections(certificate_of(report)))
    page.sections.push_back(std::move(section));
  return html(page);
}

}  // namespace proofmass::report
