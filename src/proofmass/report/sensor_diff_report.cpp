#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <optional>

#include "proofmass/core/units.hpp"
#include "proofmass/report/json.hpp"
#include "proofmass/report/page.hpp"
#include "proofmass/report/sensor_diff_wording.hpp"
#include "proofmass/report/sensor_report.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using sensor::FigureComparison;
using sensor::SensorComparison;
using sensor::Verdict;

/// A value in the unit of the new file's figure, or else of the old one's.
struct InUnit {
  sensor::FigureUnit unit;

  [[nodiscard]] std::string value(const std::optional<sensor::Figure>& figure) const {
    if (!figure) return "none";
    const double value = (figure->si() - unit.offset_si) / unit.to_si;
    const auto std = figure->std_si();
    return std && *std > 0.0 ? with_std({value, *std / unit.to_si}) : compact(value, 9);
  }
  [[nodiscard]] std::string change(const FigureComparison& figure) const {
    if (!figure.change) return "";
    const double change = *figure.change / unit.to_si;
    if (figure.change_std && *figure.change_std > 0.0)
      return with_std({change, *figure.change_std / unit.to_si});
    return compact(change, 3);
  }
};

std::vector<std::string> cells(const FigureComparison& figure, std::size_t number) {
  const auto& latest = figure.after.figure ? figure.after.figure : figure.before.figure;
  const bool units_agree =
      !figure.before.figure || !figure.after.figure ||
      figure.before.figure->unit.si_symbol == figure.after.figure->unit.si_symbol;
  const InUnit in{latest->unit};
  const InUnit in_old{units_agree ? latest->unit : figure.before.figure->unit};
  const auto stds = figure.in_stds();
  return {fmt::format("{}", number),
          figure.before.name(),
          verdict_words(figure),
          latest->unit.symbol == "1" ? "" : print_unit(latest->unit.symbol),
          in_old.value(figure.before.figure),
          in.value(figure.after.figure),
          in.change(figure),
          stds ? fixed(*stds, 1) : "",
          figure.p_adjusted ? probability_words(*figure.p_adjusted) : ""};
}

const std::vector<std::string>& heading() {
  static const std::vector<std::string> head{"#",   "figure", "verdict", "unit", "OLD",
                                             "NEW", "change", "in std",  "p"};
  return head;
}

std::vector<std::vector<std::string>> rows_of(const SensorComparison& comparison) {
  std::vector<std::vector<std::string>> rows;
  for (const FigureComparison& figure : comparison.figures)
    rows.push_back(cells(figure, rows.size() + 1));
  return rows;
}

// A page is narrower than the sentence: what it means stands above the table.
std::string short_verdict(const FigureComparison& figure) {
  if (figure.verdict == Verdict::changed) return "changed";
  return figure.verdict == Verdict::same ? "the same" : verdict_words(figure);
}

// A table for each section of the file.
std::vector<Table> tables_of(const SensorComparison& comparison) {
  std::vector<Table> tables;
  const auto rows = rows_of(comparison);
  std::string section;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const sensor::FigureSlot& slot = comparison.figures[k].before;
    if (tables.empty() || slot.section != section)
      tables.push_back(
          {"[" + slot.section + "], values in the unit of the new file", heading(), {}});
    section = slot.section;
    std::vector<std::string>& cells = tables.back().rows.emplace_back(rows[k]);
    cells[1] = slot.key + (slot.axis ? " " + slot.axis_name() : std::string());
    cells[2] = short_verdict(comparison.figures[k]);
  }
  return tables;
}

// Changes in units of their standard deviation; those without one are not drawn.
Figure changes_figure(const SensorComparison& comparison) {
  Figure figure{.title = "Changes in units of their standard deviation",
                .description =
                    "One dot for each figure that both files have with its standard "
                    "deviation, by its number in the table. Of figures that have not "
                    "changed 95 % lie in the band.",
                .x = {.label = "Figure (number in the table)"},
                .y = {.label = "New − old (standard deviations)"},
                .height = 280.0};
  const auto last = static_cast<double>(comparison.figures.size());
  figure.x.min = 0.0;
  figure.x.max = last + 1.0;
  Curve same{"the same within their uncertainty", {}, {}, Ink::blue, Mark::points};
  Curve changed{"changed by more", {}, {}, Ink::red, Mark::points};
  double largest = 3.0;
  for (std::size_t k = 0; k < comparison.figures.size(); ++k) {
    const FigureComparison& item = comparison.figures[k];
    const auto stds = item.in_stds();
    if (!stds || !item.p) continue;
    Curve& curve = item.verdict == Verdict::changed ? changed : same;
    const auto x = static_cast<double>(k + 1);
    curve.x.push_back(x);
    curve.y.push_back(*stds);
    largest = std::max(largest, std::abs(*stds));
    if (item.verdict == Verdict::changed)
      figure.callouts.push_back({.text = item.before.key + " " + item.before.axis_name(),
                                 .x = x,
                                 .y = *stds,
                                 .ink = Ink::red,
                                 .below = *stds<0.0, .left = 2.0 * x> last});
  }
  figure.y.min = -1.25 * largest;
  figure.y.max = 1.25 * largest;
  figure.bands = {
      {"95 % of unchanged figures", {0.0, last + 1.0}, {-1.96, -1.96}, {1.96, 1.96}, Ink::grey}};
  figure.levels = {{"", 0.0}};
  if (!same.x.empty()) figure.curves.push_back(std::move(same));
  if (!changed.x.empty()) figure.curves.push_back(std::move(changed));
  return figure;
}

std::vector<KeyFigure> key_figures(const SensorComparison& comparison) {
  std::vector<KeyFigure> figures;
  const auto changed =
      std::ranges::count(comparison.figures, Verdict::changed, &FigureComparison::verdict);
  if (comparison.effect) {
    const sensor::CalibrationEffect& effect = *comparison.effect;
    figures.push_back({"Largest error by OLD at 1 g", milli_g_words(effect.force_mps2)});
    figures.push_back({"Largest error of direction", angle_words(effect.angle_rad)});
    if (effect.force_mps2.by_chance_95)
      figures.push_back({"By uncertainty alone, 95 %", chance_words(effect)});
  }
  figures.push_back({"Figures changed", fmt::format("{}", changed)});
  return figures;
}

std::vector<std::string> method(const SensorComparison& comparison) {
  std::vector<std::string> out{fmt::format(
      "A change is new − old, its standard deviation √(u_old² + u_new²): the two files are taken "
      "for independent, save for entries that are the same in both, which are not tested. {} made; "
      "the probabilities p are adjusted for their number (Holm), so that files of an unchanged "
      "sensor give any alarm in {} % of cases at most.",
      comparison.tests == 1 ? "One test was" : fmt::format("{} tests were", comparison.tests),
      compact(100.0 * comparison.level, 3))};
  if (comparison.joint)
    out.push_back(fmt::format(
        "The calibration was tested as a whole, with the correlations of its figures: Δᵀ (C_old + "
        "C_new)⁻¹ Δ = {} for {}{}. Its single figures are looked into only if it has changed.",
        compact(comparison.joint->statistic, 3),
        count_words(comparison.joint->figures, "degree") + " of freedom",
        comparison.joint->dof ? fmt::format(", over {} of the covariances (Fisher's F)",
                                            compact(*comparison.joint->dof, 3))
                              : std::string()));
  else
    out.push_back("The calibration was not tested as a whole: " + comparison.no_joint + ".");
  if (comparison.effect)
    out.push_back(fmt::format(
        "The largest error is that of f = g u over all directions u, with both files applied to "
        "the reading, in {}, of which NEW makes f; it is largest along {} in the sensor's axes.",
        print_unit(comparison.effect->reading_unit),
        direction_words(comparison.effect->force_mps2)));
  return out;
}

std::vector<Note> all_notes(const SensorDiff& report) {
  std::vector<Note> notes = report.notes;
  notes.insert(notes.end(), report.comparison.notes.begin(), report.comparison.notes.end());
  return notes;
}

}  // namespace

std::string sensor_diff_text(const SensorDiff& report) {
  std::string out = fmt::format("OLD is {}, NEW is {}.\n", report.old_file, report.new_file);
  for (const std::string& finding : sensor_diff_findings(report)) out += finding + "\n";
  auto rows = rows_of(report.comparison);
  if (rows.empty()) return out;
  rows.insert(rows.begin(), heading());
  return out + "\n" + aligned(rows);
}

std::string sensor_diff_html(const SensorDiff& report) {
  const std::vector<std::string> findings = sensor_diff_findings(report);
  Page page{
      .verb = "sensor diff",
      .title = fmt::format("{} against {}", file_name(report.new_file), file_name(report.old_file)),
      .inputs = {"OLD: " + report.old_file, "NEW: " + report.new_file},
      .conclusion = findings.front(),
      .key_figures = key_figures(report.comparison),
      .notes = all_notes(report)};
  Section changes{.heading = "What has changed", .points = {findings.begin() + 1, findings.end()}};
  Figure figure = changes_figure(report.comparison);
  if (!figure.curves.empty()) changes.figures.push_back(std::move(figure));
  page.sections = {
      std::move(changes),
      {.heading = "Figure by figure",
       .paragraphs =
           {"“Changed” is by more than the uncertainty of the two figures, “the same” within it."},
       .tables = tables_of(report.comparison)},
      {.heading = "How it was computed", .paragraphs = method(report.comparison)}};
  return html(page);
}

}  // namespace proofmass::report
