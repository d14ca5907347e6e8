#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <optional>

#include "proofmass/core/units.hpp"
#include "proofmass/report/sensor/diff_wording.hpp"
#include "proofmass/report/sensor/report.hpp"
#include "proofmass/report/sensor/slot_fields.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using sensor::FigureComparison;
using sensor::LargestError;
using sensor::SensorComparison;
using sensor::Verdict;

/// Converts to the unit of the new file's figure, or of the old one's if there is none.
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

// A column has room for one word; a paragraph explains the verdict.
std::string short_verdict(const FigureComparison& figure) {
  if (figure.verdict == Verdict::changed) return "changed";
  return figure.verdict == Verdict::same ? "same" : verdict_words(figure);
}

std::vector<std::string> cells(const FigureComparison& figure, std::size_t number) {
  const auto& latest = figure.after.figure ? figure.after.figure : figure.before.figure;
  const bool units_agree =
      !figure.before.figure || !figure.after.figure ||
      figure.before.figure->unit.si_symbol == figure.after.figure->unit.si_symbol;
  const InUnit in{latest->unit};
  const InUnit in_old{units_agree ? latest->unit : figure.before.figure->unit};
  const auto stds = figure.in_stds();
  return {
      fmt::format("{}", number),
      figure.before.key + (figure.before.axis ? " " + figure.before.axis_name() : std::string()),
      short_verdict(figure),
      latest->unit.symbol == "1" ? "" : print_unit(latest->unit.symbol),
      in_old.value(figure.before.figure),
      in.value(figure.after.figure),
      in.change(figure),
      stds ? fixed(*stds, 1) : "",
      figure.p_adjusted ? probability_words(*figure.p_adjusted) : ""};
}

// One table for each section of the file.
std::vector<Table> tables_of(const SensorComparison& comparison) {
  std::vector<Table> tables;
  std::string section;
  for (std::size_t k = 0; k < comparison.figures.size(); ++k) {
    const FigureComparison& figure = comparison.figures[k];
    if (tables.empty() || figure.before.section != section)
      tables.push_back({"[" + figure.before.section + "], values in the unit of the new file",
                        {"#", "figure", "verdict", "unit", "OLD", "NEW", "change", "in std", "p"},
                        {}});
    section = figure.before.section;
    tables.back().rows.push_back(cells(figure, k + 1));
  }
  return tables;
}

// Changes in units of their standard deviation; figures without one are omitted.
Figure changes_figure(const SensorComparison& comparison) {
  Figure figure{.title = "Changes in units of their standard deviation",
                .description =
                    "One dot for each figure that both files have with its standard "
                    "deviation, by its number in the table. 95 % of unchanged figures "
                    "are in the band.",
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

std::vector<KeyFigure> effect_figures(const SensorComparison& comparison) {
  std::vector<KeyFigure> figures;
  if (comparison.effect) {
    const sensor::CalibrationEffect& effect = *comparison.effect;
    figures.push_back({"Largest error by OLD at 1 g", milli_g_words(effect.force_mps2)});
    figures.push_back({"Largest error of direction", angle_words(effect.angle_rad)});
    if (effect.force_mps2.by_chance_95)
      figures.push_back({"By uncertainty alone, 95 %", chance_words(effect)});
  }
  const auto changed =
      std::ranges::count(comparison.figures, Verdict::changed, &FigureComparison::verdict);
  figures.push_back({"Figures changed", fmt::format("{}", changed)});
  return figures;
}

std::vector<std::string> method(const SensorComparison& comparison) {
  std::vector<std::string> out{fmt::format(
      "A change is new − old, its standard deviation √(u_old² + u_new²): the two files are assumed "
      "independent, except for entries that are the same in both, which are not tested. {} made; "
      "the probabilities p are adjusted for their number (Holm), so that files of an unchanged "
      "sensor give any alarm in {} % of cases at most.",
      comparison.tests == 1 ? "One test was" : fmt::format("{} tests were", comparison.tests),
      compact(100.0 * comparison.level, 3))};
  if (comparison.joint)
    out.push_back(fmt::format(
        "The calibration was tested as a whole, with the correlations of its figures: Δᵀ (C_old + "
        "C_new)⁻¹ Δ = {} for {}{}. Its single figures are tested only if it has changed.",
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
        "the measurement in {} that NEW converts to f; it is largest along {} in the sensor's "
        "axes.",
        print_unit(comparison.effect->reading_unit),
        direction_words(comparison.effect->force_mps2)));
  return out;
}

std::vector<Note> all_notes(const SensorDiff& report) {
  std::vector<Note> notes = report.notes;
  notes.insert(notes.end(), report.comparison.notes.begin(), report.comparison.notes.end());
  return notes;
}

std::string_view code(Verdict verdict) {
  switch (verdict) {
    case Verdict::changed:
      return "changed";
    case Verdict::same:
      return "same";
    case Verdict::unchanged:
      return "unchanged";
    case Verdict::only_old:
      return "only_old";
    case Verdict::only_new:
      return "only_new";
    case Verdict::condition:
      return "condition";
    case Verdict::cannot_tell:
      break;
  }
  return "cannot_be_told";
}

const std::vector<std::string>& verdict_codes() {
  static const std::vector<std::string> codes{"changed",  "same",      "unchanged",     "only_old",
                                              "only_new", "condition", "cannot_be_told"};
  return codes;
}

Field verdict_field(const char* key, Verdict verdict, const char* meaning) {
  return field::choice(key, code(verdict), verdict_codes(), {.meaning = meaning});
}

Field figure_or_null(const char* key,
                     const std::optional<sensor::Figure>& figure,
                     const char* why_null) {
  About about{.why_null = why_null, .why_no_std = "the file states no standard deviation"};
  if (!figure) return field::measured(key, std::nullopt, std::nullopt, "", std::move(about));
  return field::measured(key, figure->si(), figure->std_si(), figure->unit.si_symbol,
                         std::move(about));
}

// Reason why a figure was not compared or not tested.
std::string why_untested(const FigureComparison& figure) {
  return figure.reason.empty() ? std::string(words_of(figure.verdict)) : figure.reason;
}

Field probability(const char* key,
                  const std::optional<double>& p,
                  const FigureComparison& figure,
                  const char* meaning) {
  return field::magnitude(key, p, {.meaning = meaning, .why_null = why_untested(figure)});
}

Fields figure_fields(const FigureComparison& figure) {
  const bool is_tested = figure.p.has_value();
  const std::string why_no_std =
      figure.verdict == Verdict::condition ? "no uncertainty in OLD or NEW" : why_untested(figure);
  Fields fields = slot_fields(figure.before);
  append(fields,
         {figure_or_null("old", figure.before.figure, "in NEW only"),
          figure_or_null("new", figure.after.figure, "in OLD only"),
          field::measured(
              "change", figure.change, figure.change_std, figure.unit,
              {.meaning = "new - old", .why_null = why_untested(figure), .why_no_std = why_no_std}),
          field::number("in_std", figure.in_stds(),
                        {.meaning = "the change over its standard deviation",
                         .why_null = is_tested ? "the change has no standard deviation"
                                               : why_untested(figure)}),
          probability("p", figure.p, figure, "of such a change or a larger one by chance"),
          probability("p_adjusted", figure.p_adjusted, figure, "the same for all tests together"),
          verdict_field("verdict", figure.verdict,
                        "changed: by more than the uncertainty; same: within it; unchanged: the "
                        "same entry in both files; condition: under which the figures hold, not "
                        "tested"),
          field::text("words", words_of(figure.verdict))});
  if (!figure.reason.empty())
    fields.push_back(field::text("reason", figure.reason, {.meaning = "why it is undetermined"}));
  return fields;
}

Field joint_field(const SensorComparison& comparison) {
  std::optional<Fields> fields;
  if (comparison.joint) {
    const sensor::JointTest& joint = *comparison.joint;
    fields = Fields{field::magnitude("statistic", joint.statistic),
                    field::count("degrees_of_freedom", joint.figures)};
    if (joint.dof)
      fields->push_back(field::number("covariance_degrees_of_freedom", *joint.dof,
                                      {.meaning = "of the covariances, if they are few; p is then "
                                                  "from Fisher's F distribution"}));
    append(*fields,
           {field::magnitude("p", joint.p), field::magnitude("p_adjusted", joint.p_adjusted)});
  }
  return field::object_or_null(
      "joint", std::move(fields),
      {.meaning = "test of the calibration as a whole", .why_null = comparison.no_joint});
}

Field error_field(const char* key,
                  const LargestError& error,
                  double factor,
                  const char* unit,
                  const std::string& why_no_std) {
  const auto scaled_by = [&](const std::optional<double>& value) {
    return value ? std::optional(*value * factor) : std::nullopt;
  };
  return field::object(
      key,
      {field::magnitude("value", error.value * factor, {.meaning = "over all orientations at 1 g"}),
       field::magnitude("std", scaled_by(error.std), {.why_null = why_no_std}),
       field::choice("unit", unit, {unit}),
       field::magnitude("by_chance_95", scaled_by(error.by_chance_95),
                        {.meaning = "95 % of pairs of calibrations of one unchanged sensor stay "
                                    "below it",
                         .why_null = why_no_std}),
       field::numbers("direction", error.up,
                      {.meaning = "unit vector of the force in the sensor's axes"})});
}

Field effect_field(const SensorComparison& comparison) {
  constexpr double mg_per_mps2 = 1e3 / standard_gravity_mps2;
  std::optional<Fields> fields;
  if (comparison.effect) {
    const sensor::CalibrationEffect& effect = *comparison.effect;
    const std::string& why = effect.without_std;
    fields =
        Fields{field::text("reading_unit", effect.reading_unit,
                           {.meaning = "of the measurements to which both files were applied"}),
               error_field("error", effect.force_mps2, 1.0, "m/s^2", why),
               error_field("error_mg", effect.force_mps2, mg_per_mps2, "mg", why),
               error_field("angle", effect.angle_rad, 1.0, "rad", why),
               error_field("angle_deg", effect.angle_rad, 1.0 / rad_per_deg, "deg", why)};
  }
  return field::object_or_null(
      "effect", std::move(fields),
      {.meaning = "the largest error that using the old file instead of the new one causes",
       .why_null = comparison.no_effect});
}

Fields diff_fields(const SensorDiff& report) {
  const SensorComparison& comparison = report.comparison;
  return {field::choice("action", "diff", {"diff"}),
          verdict_field("verdict", comparison.all,
                        "of the whole files: changed, same, unchanged or cannot_be_told"),
          verdict_field("calibration_verdict", comparison.calibration,
                        "of the calibration: changed, same, unchanged or cannot_be_told"),
          field::texts("findings", sensor_diff_findings(report), {.meaning = "sentences"}),
          field::number("level", comparison.level,
                        {.meaning = "probability of any false alarm, at most"}),
          field::count("tests", comparison.tests, {.meaning = "made; the joint one counts as one"}),
          field::records("figures", comparison.figures, figure_fields),
          joint_field(comparison),
          effect_field(comparison)};
}

}  // namespace

Document describe(const SensorDiff& report) {
  const SensorComparison& comparison = report.comparison;
  const std::vector<std::string> findings = sensor_diff_findings(report);
  Section changes{
      .heading = "What has changed",
      .paragraphs = {fmt::format("OLD is {}, NEW is {}.", report.old_file, report.new_file)},
      .points = {findings.begin() + 1, findings.end()},
      .on_terminal = true};
  Figure figure = changes_figure(comparison);
  if (!figure.curves.empty()) changes.figures.emplace_back(std::move(figure));
  Section figures{.heading = "Figure by figure",
                  .paragraphs = {"“changed” means by more than the uncertainty of the two figures, "
                                 "“same” within it."},
                  .tables = tables_of(comparison),
                  .on_terminal = true};
  Document document{.page = {.verb = "sensor",
                             .action = "diff",
                             .title = fmt::format("{} against {}", file_name(report.new_file),
                                                  file_name(report.old_file)),
                             .inputs = {report.old_file, report.new_file},
                             .conclusion = findings.front(),
                             .key_figures = effect_figures(comparison),
                             .notes = all_notes(report)},
                    .fields = diff_fields(report)};
  document.page.sections.push_back(std::move(changes));
  if (!figures.tables.empty()) document.page.sections.push_back(std::move(figures));
  document.page.sections.push_back(
      {.heading = "How it was computed", .paragraphs = method(comparison)});
  return document;
}

}  // namespace proofmass::report
