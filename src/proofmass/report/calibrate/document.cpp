#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/calibrate/rest_accuracy.hpp"
#include "proofmass/report/calibrate/figures.hpp"
#include "proofmass/report/calibrate/report.hpp"
#include "proofmass/report/calibrate/wording.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using calibrate::BudgetSize;
using calibrate::MultiPosition;
using calibrate::PoseModel;
using calibrate::PoseResidual;

constexpr double rounding_g = 1e-9;  // residuals below it are rounding

std::string used_words(const MultiPosition& fit) {
  const auto used = std::ranges::count_if(fit.poses, &PoseResidual::used);
  if (static_cast<std::size_t>(used) == fit.poses.size()) return fmt::format("all {}", used);
  return fmt::format("{} of {}", used, fit.poses.size());
}

std::vector<KeyFigure> figures_of(const CalibrateReport& report) {
  const std::optional<calibrate::RestAccuracy> found = calibrate::rest_accuracy(report.fit);
  const auto& test = report.fit.lack_of_fit;
  std::vector<KeyFigure> out{
      {"Accuracy at rest (68 %)", found ? mg_words(found->overall_mps2) : std::string(absent)},
      {"Positions used", used_words(report.fit)},
      {"Residuals relative to the noise",
       test ? significant(std::sqrt(test->statistic), 2) + " times" : std::string(absent)}};
  const std::vector<CalibrationFigure> figures = calibration_figures(report);
  for (std::size_t k = 0; k < 6; ++k)
    out.push_back({figures[k].label, figure_words(figures[k], stds_known(report)), true});
  return out;
}

Section figures_section(const CalibrateReport& report) {
  Table table{stds_known(report) ? "± is one standard deviation"
                                 : "No standard deviations: the noise of the means is not known "
                                   "and there is no redundant position",
              {},
              figure_rows(report)};
  table.head = std::move(table.rows.front());
  table.rows.erase(table.rows.begin());
  return {.heading = "Bias, scale and misalignment",
          .points = calibrate_findings(report),
          .tables = {std::move(table)},
          .on_terminal = true};
}

Section positions_section(const CalibrateReport& report) {
  Table table{
      "Residual: norm of the calibrated force less gravity; leave-one-out: by a fit to the "
      "other positions; t: that over its standard deviation",
      {},
      position_rows(report)};
  table.head = std::move(table.rows.front());
  table.rows.erase(table.rows.begin());
  table.long_list = true;
  return {.heading = "Positions", .tables = {std::move(table)}, .on_terminal = true};
}

Section plots_section(const CalibrateReport& report) {
  Section section{.heading = "Residuals and directions"};
  if (report.fit.residual_rms_mps2 > rounding_g * report.fit.gravity_mps2)
    section.figures.emplace_back([&] { return residual_figure(report); });
  section.figures.emplace_back([&] { return direction_figure(report); });
  return section;
}

std::string agreement_words(BudgetSize size) {
  return size == BudgetSize::right       ? "agrees"
         : size == BudgetSize::too_small ? "budget too small"
                                         : "budget too large";
}

Section check_section(const CalibrateReport& report) {
  const std::vector<CalibrationFigure> figures = calibration_figures(report);
  Table table{"", {"Figure", "Std by budget", "Std by draws", "Draws within its 95 %", ""}, {}};
  for (const calibrate::ParameterCheck& one : report.check->parameters) {
    const auto found = std::ranges::find(figures, one.quantity, &CalibrationFigure::key);
    const auto std_words = [&](double std) {
      if (found == figures.end()) return significant(std, 2);
      return significant(found->factor * std, 2) +
             (found->printed_unit.empty() ? "" : " " + found->printed_unit);
    };
    table.rows.push_back({one.quantity, std_words(one.budget_std), std_words(one.drawn_std),
                          fixed(100.0 * one.inside, 1) + " %", agreement_words(one.agreement)});
  }
  return {.heading = "Check of the uncertainties by Monte Carlo",
          .paragraphs = {report.check->verdict},
          .tables = {std::move(table)}};
}

// Bias and scale of each file, with units in the head.
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
        table.head.push_back(figure.label + (figure.printed_unit.empty() ? "" : ", ") +
                             figure.printed_unit);
      figure.printed_unit.clear();
      row.push_back(figure_words(figure, stds_known(at)));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

Section supply_section(const CalibrateReport& report) {
  Section section{.heading = "Effect of the supply", .tables = {supply_table(report)}};
  for (const auto& axis : report.supply->axes)
    if (axis) section.points.push_back(axis->words);
  if (report.unit.quantity == Quantity::voltage)
    section.paragraphs.emplace_back(
        "A ratiometric output is proportional to the supply: so is its scale, and its bias is a "
        "constant fraction of it.");
  section.figures = {[&] { return supply_bias_figure(report); },
                     [&] { return supply_scale_figure(report); }};
  return section;
}

// The report's certificate, with what the fit adds to it.
CertificateData certificate_of(const CalibrateReport& report) {
  CertificateData data = report.certificate;
  data.method = "multi-position, " + model_words(report.fit.model);
  if (has_free_directions(report.fit.model)) data.method += ", against the norm of local gravity";
  data.equations = {"f = T diag(1/scale) (output − bias)", "T = [1 −α_yz α_zy; 0 1 −α_zx; 0 0 1]"};
  if (report.fit.model != PoseModel::given_12) data.equations.emplace_back("|f| = g");
  if (data.budgets.empty()) data.budgets = report.budgets;
  if (!report.fit.misalignment_rad[0])
    data.not_determined.emplace_back("Misalignment of the axes was not determined.");
  if (!stds_known(report))
    data.not_determined.emplace_back(
        "The noise of the means is not known: U does not include it and is no 95 percent "
        "interval.");
  if (report.check && stds_known(report)) data.monte_carlo = report.check->verdict;
  for (std::string& text : suspect_sentences(report)) data.limits.push_back(std::move(text));
  if (report.gyroscope) add_to_certificate(*report.gyroscope, data);
  return data;
}

}  // namespace

std::vector<Note> calibrate_notes(const CalibrateReport& report) {
  std::vector<Note> notes = report.notes;
  const auto add = [&](Severity severity, std::string text) {
    notes.push_back({severity, std::move(text)});
  };
  for (std::string& text : suspect_sentences(report)) add(Severity::bad, std::move(text));
  if (std::string text = doubtful_sentence(report); !text.empty())
    add(Severity::warning, std::move(text));
  if (report.fit.lack_of_fit && report.fit.lack_of_fit->p < some_p)
    add(Severity::warning, lack_of_fit_sentence(report));
  // Residuals that are pure rounding give the solver no descent to converge on.
  if (!report.fit.converged && report.fit.residual_rms_mps2 > rounding_g * report.fit.gravity_mps2)
    add(Severity::bad, "the fit did not converge: do not use its figures");
  if (!report.why_no_check.empty())
    add(Severity::warning, "Monte Carlo check failed: " + report.why_no_check);
  if (report.check && !report.check->agrees && stds_known(report))
    add(Severity::warning, "Monte Carlo: " + report.check->verdict);
  if (report.validation && report.validation->p && *report.validation->p < some_p)
    add(Severity::warning, fmt::format("residuals of the new positions: {} rms, {} expected",
                                       mg_words(report.validation->rms_mps2),
                                       mg_words(report.validation->expected_rms_mps2)));
  for (const std::string& text : report.fit.notes)
    if (!is_reason_of_null(text)) add(Severity::warning, text);
  if (report.supply)
    for (const std::string& text : report.supply->notes) add(Severity::warning, text);
  if (report.gyroscope)
    for (Note& note : gyroscope_notes(*report.gyroscope)) notes.push_back(std::move(note));
  return notes;
}

Document describe(const CalibrateReport& report) {
  Document document{.page = {.verb = "calibrate",
                             .title = file_names(report.inputs),
                             .inputs = report.inputs,
                             .conclusion = calibrate_conclusion(report),
                             .key_figures = figures_of(report),
                             .notes = calibrate_notes(report)},
                    .fields = calibrate_fields(report)};
  std::vector<Section>& sections = document.page.sections;
  sections = {figures_section(report), plots_section(report), positions_section(report)};
  if (report.supply) sections.push_back(supply_section(report));
  if (report.gyroscope)
    for (Section& section : gyroscope_sections(*report.gyroscope))
      sections.push_back(std::move(section));
  if (report.check && stds_known(report)) sections.push_back(check_section(report));
  for (Section& section : certificate_sections(certificate_of(report)))
    sections.push_back(std::move(section));
  return document;
}

}  // namespace proofmass::report
