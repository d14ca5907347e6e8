#include <algorithm>
#include <fmt/format.h>
#include <optional>

#include "proofmass/core/units.hpp"
#include "proofmass/report/json.hpp"
#include "proofmass/report/sensor_report.hpp"

namespace proofmass::report {
namespace {

using sensor::FigureComparison;
using sensor::LargestError;
using sensor::SensorComparison;
using sensor::Verdict;

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

Value number(const std::optional<double>& value) {
  return value ? Value(*value) : Value();
}

Value with_unit(const std::optional<double>& value,
                const std::optional<double>& std,
                std::string_view unit) {
  if (!value) return {};
  return Object{{"value", *value}, {"std", number(std)}, {"unit", unit}};
}

Value figure_or_null(const std::optional<sensor::Figure>& figure) {
  if (!figure) return {};
  return with_unit(figure->si(), figure->std_si(), figure->unit.si_symbol);
}

Value json_of(const FigureComparison& figure) {
  Object out{{"section", figure.before.section}, {"key", figure.before.key}};
  if (figure.before.axis) out.push_back({"axis", figure.before.axis_name()});
  out.push_back({"old", figure_or_null(figure.before.figure)});
  out.push_back({"new", figure_or_null(figure.after.figure)});
  out.push_back({"change", with_unit(figure.change, figure.change_std, figure.unit)});
  out.push_back({"in_std", number(figure.in_stds())});
  out.push_back({"p", number(figure.p)});
  out.push_back({"p_adjusted", number(figure.p_adjusted)});
  out.push_back({"verdict", code(figure.verdict)});
  out.push_back({"words", words_of(figure.verdict)});
  if (!figure.reason.empty()) out.push_back({"reason", figure.reason});
  return out;
}

Value json_of(const LargestError& error, double factor, std::string_view unit) {
  const auto scaled_by = [&](const std::optional<double>& value) {
    return value ? std::optional(*value * factor) : std::nullopt;
  };
  return Object{{"value", error.value * factor},
                {"std", number(scaled_by(error.std))},
                {"unit", unit},
                {"by_chance_95", number(scaled_by(error.by_chance_95))},
                {"direction", Array{error.up.x(), error.up.y(), error.up.z()}}};
}

Value effect_json(const SensorComparison& comparison) {
  if (!comparison.effect) return {};
  const sensor::CalibrationEffect& effect = *comparison.effect;
  constexpr double mg_per_mps2 = 1e3 / standard_gravity_mps2;
  return Object{{"reading_unit", effect.reading_unit},
                {"error", json_of(effect.force_mps2, 1.0, "m/s^2")},
                {"error_mg", json_of(effect.force_mps2, mg_per_mps2, "mg")},
                {"angle", json_of(effect.angle_rad, 1.0, "rad")},
                {"angle_deg", json_of(effect.angle_rad, 1.0 / rad_per_deg, "deg")}};
}

Value joint_json(const SensorComparison& comparison) {
  if (!comparison.joint) return {};
  const sensor::JointTest& joint = *comparison.joint;
  Object out{{"statistic", joint.statistic},
             {"degrees_of_freedom", static_cast<std::uint64_t>(joint.figures)}};
  if (joint.dof) out.push_back({"covariance_degrees_of_freedom", *joint.dof});
  out.push_back({"p", joint.p});
  out.push_back({"p_adjusted", joint.p_adjusted});
  return out;
}

// The reason of every null, where there is one.
std::vector<std::string> null_reasons(const SensorComparison& comparison) {
  std::vector<std::string> reasons;
  const bool any = std::ranges::any_of(comparison.figures, [](const FigureComparison& f) {
    return !f.before.figure || !f.after.figure || !f.before.figure->std || !f.after.figure->std ||
           !f.change_std || !f.p || !f.in_stds();
  });
  if (any)
    reasons.emplace_back(
        "figures: old, new, change: null where a file does not have the figure or has it in "
        "another quantity; std, in_std, p, p_adjusted: null where a file gives no standard "
        "deviation, or nothing was to be tested");
  if (!comparison.joint) reasons.push_back("joint: null: " + comparison.no_joint);
  if (!comparison.effect)
    reasons.push_back("effect: null: " + comparison.no_effect);
  else if (!comparison.effect->without_std.empty())
    reasons.push_back("effect: std, by_chance_95: null: " + comparison.effect->without_std);
  return reasons;
}

}  // namespace

std::string sensor_diff_json(const SensorDiff& report) {
  const SensorComparison& comparison = report.comparison;
  std::vector<std::string> warnings = texts(report.notes, Severity::warning);
  for (const auto& more : {texts(comparison.notes, Severity::warning), null_reasons(comparison)})
    warnings.insert(warnings.end(), more.begin(), more.end());
  Array figures;
  for (const FigureComparison& figure : comparison.figures) figures.push_back(json_of(figure));
  return to_json({"sensor", {report.old_file, report.new_file}, std::move(warnings)},
                 {{"action", "diff"},
                  {"verdict", code(comparison.all)},
                  {"calibration_verdict", code(comparison.calibration)},
                  {"findings", array_of(sensor_diff_findings(report))},
                  {"level", comparison.level},
                  {"tests", static_cast<std::uint64_t>(comparison.tests)},
                  {"figures", std::move(figures)},
                  {"joint", joint_json(comparison)},
                  {"effect", effect_json(comparison)}});
}

}  // namespace proofmass::report
