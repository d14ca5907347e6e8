#include "proofmass/report/sensor/diff_wording.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <optional>

#include "proofmass/core/units.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using sensor::FigureComparison;
using sensor::LargestError;
using sensor::SensorComparison;
using sensor::Verdict;

constexpr double mps2_per_mg = 1e-3 * standard_gravity_mps2;

/// The error in a unit equal to `si` SI units.
std::string words(const LargestError& error, double si, std::string_view unit) {
  if (error.std && *error.std > 0.0) return with_std({error.value / si, *error.std / si}, unit);
  return compact(error.value / si, 3) + (unit == "°" ? "" : " ") + std::string(unit);
}

bool in_calibration(const FigureComparison& figure) {
  return figure.before.section == "calibration";
}

/// Names of the figures with one verdict, inside or outside the calibration.
std::vector<std::string> names_of(const SensorComparison& comparison,
                                  Verdict verdict,
                                  bool calibration) {
  std::vector<std::string> names;
  for (const FigureComparison& figure : comparison.figures)
    if (figure.verdict == verdict && in_calibration(figure) == calibration)
      names.push_back(figure.before.name());
  return names;
}

std::string listed(std::vector<std::string> names) {
  constexpr std::size_t most = 9;
  const std::size_t left = names.size() > most ? names.size() - most : 0;
  names.resize(names.size() - left);
  std::string out = fmt::format("{}", fmt::join(names, ", "));
  return left == 0 ? out : out + fmt::format(" and {} more", left);
}

std::string calibration_words(const SensorComparison& comparison) {
  const std::string p =
      comparison.joint
          ? fmt::format(" (together, p {})", probability_words(comparison.joint->p_adjusted))
          : std::string();
  switch (comparison.calibration) {
    case Verdict::changed:
      return "The calibration has changed by more than its uncertainty" + p + ".";
    case Verdict::same:
      return "The calibration is the same within its uncertainty" + p + ".";
    case Verdict::unchanged:
      return "The calibration is the same in both files.";
    default:
      break;
  }
  if (std::ranges::none_of(comparison.figures, in_calibration))
    return "Neither file has a calibration.";
  return "The files do not determine whether the calibration has changed.";
}

void add_changes(const SensorComparison& comparison, std::vector<std::string>& findings) {
  const auto inside = names_of(comparison, Verdict::changed, true);
  if (!inside.empty())
    findings.push_back(fmt::format("Changed by more than their uncertainty: {}.", listed(inside)));
  else if (comparison.calibration == Verdict::changed)
    findings.emplace_back("No single figure of it has changed significantly by itself.");
  const auto others = names_of(comparison, Verdict::changed, false);
  const auto same = names_of(comparison, Verdict::same, false);
  if (!others.empty())
    findings.push_back(fmt::format(
        "Beside the calibration, changed by more than their uncertainty: {}.", listed(others)));
  else if (!same.empty())
    findings.push_back(fmt::format("Beside the calibration, the same within their uncertainty: {}.",
                                   listed(same)));
  auto open = names_of(comparison, Verdict::cannot_tell, true);
  for (auto& name : names_of(comparison, Verdict::cannot_tell, false)) open.push_back(name);
  if (!open.empty()) findings.push_back(fmt::format("Undetermined: {}.", listed(open)));
}

void add_effect(const SensorComparison& comparison, std::vector<std::string>& findings) {
  if (!comparison.effect) {
    findings.push_back("The largest error is undetermined: " + comparison.no_effect + ".");
    return;
  }
  const sensor::CalibrationEffect& effect = *comparison.effect;
  const LargestError& force = effect.force_mps2;
  if (force.value == 0.0) return;
  findings.push_back(
      fmt::format("Using OLD instead of NEW causes an error of up to {} ({}) at 1 g, and of up to "
                  "{} in direction.",
                  milli_g_words(force), words(force, 1.0, "m/s²"), angle_words(effect.angle_rad)));
  if (force.by_chance_95 && *force.by_chance_95 > 0.0)
    findings.push_back(fmt::format(
        "By their uncertainty alone, two calibrations of one unchanged sensor differ by "
        "up to {} in 95 % of cases.",
        chance_words(effect)));
  if (!effect.without_std.empty())
    findings.push_back("The uncertainty of this error is undetermined: " + effect.without_std +
                       ".");
}

}  // namespace

std::string milli_g_words(const LargestError& force_mps2) {
  return words(force_mps2, mps2_per_mg, "mg");
}

std::string angle_words(const LargestError& angle_rad) {
  return words(angle_rad, rad_per_deg, "°");
}

std::string chance_words(const sensor::CalibrationEffect& effect) {
  return fmt::format("{} mg and {}°", compact(*effect.force_mps2.by_chance_95 / mps2_per_mg, 2),
                     compact(*effect.angle_rad.by_chance_95 * deg_per_rad, 2));
}

std::string direction_words(const LargestError& error) {
  return fmt::format("({}, {}, {})", fixed(error.up.x(), 2), fixed(error.up.y(), 2),
                     fixed(error.up.z(), 2));
}

std::string probability_words(double p) {
  return p < 1e-6 ? "below 1e-6" : compact(p, 2);
}

std::string verdict_words(const FigureComparison& figure) {
  std::string out(words_of(figure.verdict));
  if (!figure.reason.empty()) out += ": " + figure.reason;
  return out;
}

std::vector<std::string> sensor_diff_findings(const SensorDiff& report) {
  const SensorComparison& comparison = report.comparison;
  std::vector<std::string> findings{calibration_words(comparison)};
  add_changes(comparison, findings);
  add_effect(comparison, findings);
  if (!comparison.joint && comparison.calibration != Verdict::unchanged &&
      std::ranges::any_of(comparison.figures, in_calibration))
    findings.push_back("No test of the calibration as a whole: " + comparison.no_joint + ".");
  return findings;
}

}  // namespace proofmass::report
