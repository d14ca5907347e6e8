#include "proofmass/sensor/sensor_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <utility>

#include "proofmass/core/chi_square.hpp"
#include "proofmass/sensor/joint_test.hpp"

namespace proofmass::sensor {
namespace {

/// True for a figure that describes a condition, not the sensor.
bool is_condition(const FigureSlot& slot) {
  if (slot.section == "calibration")
    return slot.key == "gravity" || slot.key == "temperature" || slot.key == "dof" ||
           slot.key == "stability";
  return slot.section == "electrical" && (slot.key == "supply" || slot.key == "reference_supply");
}

bool is_calibration(const FigureComparison& figure) {
  return figure.before.section == "calibration" && figure.before.axis.has_value() &&
         !is_condition(figure.before);
}

/// The model with session-to-session uncertainties of the biases.
SensorModel over_sessions(SensorModel model) {
  Calibration& calibration = model.calibration;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    auto& bias = calibration.bias[axis];
    const auto& stability = calibration.stability[axis];
    if (!bias || !bias->std || !stability || stability->unit.si_symbol != bias->unit.si_symbol)
      continue;
    bias->std = std::hypot(*bias->std, stability->si() / bias->unit.to_si);
    if (calibration.covariance)
      (*calibration.covariance)[axis][axis] += stability->si() * stability->si();
  }
  return model;
}

/// Calibrations with only the repeatability within each session do not account for changes between
/// sessions.
void note_repeatability(const SensorModel& before,
                        const SensorModel& after,
                        std::vector<Note>& notes) {
  const auto lacks = [](const SensorModel& model) {
    const Calibration& c = model.calibration;
    return c.bias[0] && c.bias[0]->std && !c.stability[0];
  };
  if (!lacks(before) || !lacks(after)) return;
  notes.push_back(
      {Severity::warning,
       "calibration.stability: neither file states the repeatability of the biases between "
       "sessions: a change of them is tested against the repeatability "
       "within one recording only, and an unchanged sensor may fail that"});
}

/// Two-sided probability of a change by chance.
double p_of(double change, double std, std::optional<double> dof) {
  if (change == 0.0) return 1.0;
  if (std == 0.0) return 0.0;
  const double z = change / std;
  return dof ? student_t_p(z, *dof) : chi_square_p(std::min(z * z, 1e6), 1.0);
}

/// The comparison of one figure, without the parts that depend on the other tests.
FigureComparison compared(FigureSlot before,
                          FigureSlot after,
                          std::optional<double> old_dof,
                          std::optional<double> new_dof) {
  FigureComparison out;
  out.before = std::move(before);
  out.after = std::move(after);
  const auto& old_figure = out.before.figure;
  const auto& new_figure = out.after.figure;
  out.unit = (new_figure ? new_figure : old_figure)->unit.si_symbol;
  if (!old_figure || !new_figure) {
    out.verdict = old_figure ? Verdict::only_old : Verdict::only_new;
    return out;
  }
  if (old_figure->unit.si_symbol != new_figure->unit.si_symbol) {
    out.reason =
        fmt::format("OLD is in {}, NEW in {}", old_figure->unit.symbol, new_figure->unit.symbol);
    return out;
  }
  out.change = new_figure->si() - old_figure->si();
  const auto old_std = old_figure->std_si(), new_std = new_figure->std_si();
  if (old_std && new_std) out.change_std = std::hypot(*old_std, *new_std);
  if (carried_over(old_figure, new_figure)) {
    out.verdict = Verdict::unchanged;
    out.change_std.reset();
  } else if (is_condition(out.before)) {
    out.verdict = Verdict::condition;
  } else if (!out.change_std) {
    out.reason = fmt::format("no uncertainty in {}", whose(!old_std, !new_std));
  } else {
    const bool few = is_calibration(out);
    out.p = p_of(
        *out.change, *out.change_std,
        few ? welch(*old_std * *old_std, old_dof, *new_std * *new_std, new_dof) : std::nullopt);
    out.verdict = Verdict::same;
  }
  return out;
}

std::vector<FigureComparison> compared(const SensorModel& before, const SensorModel& after) {
  std::vector<FigureSlot> olds = figure_slots(before), news = figure_slots(after);
  std::vector<FigureComparison> figures;
  for (std::size_t k = 0; k < olds.size(); ++k)
    if (olds[k].figure || news[k].figure)
      figures.push_back(
          compared(std::move(olds[k]), std::move(news[k]), dof_of(before), dof_of(after)));
  return figures;
}

/// Holm's adjusted probabilities, in the order of the input.
std::vector<double> holm(const std::vector<double>& p) {
  std::vector<std::size_t> order(p.size());
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
  std::ranges::sort(order, std::less{}, [&](std::size_t k) { return p[k]; });
  std::vector<double> adjusted(p.size());
  double largest = 0.0;
  for (std::size_t rank = 0; rank < order.size(); ++rank) {
    const auto remaining = static_cast<double>(order.size() - rank);
    largest = std::max(largest, std::min(remaining * p[order[rank]], 1.0));
    adjusted[order[rank]] = largest;
  }
  return adjusted;
}

/// Adjusts the probabilities of the figures for which `chosen` holds, and of the joint test if it
/// is included. Returns the number of tests.
template <class Chosen>
std::size_t adjust(SensorComparison& comparison, bool with_joint, Chosen chosen) {
  std::vector<double> p;
  std::vector<std::optional<double>*> places;
  std::optional<double> joint;
  for (FigureComparison& figure : comparison.figures)
    if (figure.p && chosen(figure)) {
      p.push_back(*figure.p);
      places.push_back(&figure.p_adjusted);
    }
  if (with_joint) {
    p.push_back(comparison.joint->p);
    places.push_back(&joint);
  }
  const std::vector<double> adjusted = holm(p);
  for (std::size_t k = 0; k < p.size(); ++k) *places[k] = adjusted[k];
  if (joint) comparison.joint->p_adjusted = *joint;
  return p.size();
}

/// Adjusts all probabilities together: the calibration as a whole first, if possible.
void adjust(SensorComparison& comparison) {
  if (!comparison.joint) {
    comparison.tests = adjust(comparison, false, [](const FigureComparison&) { return true; });
    return;
  }
  comparison.tests =
      adjust(comparison, true, [](const FigureComparison& f) { return !is_calibration(f); });
  adjust(comparison, false, is_calibration);
  for (FigureComparison& figure : comparison.figures)
    if (figure.p_adjusted && is_calibration(figure))
      figure.p_adjusted = std::max(*figure.p_adjusted, comparison.joint->p_adjusted);
}

/// Combined verdict on some figures.
template <class Chosen>
Verdict verdict_on(const SensorComparison& comparison, bool with_joint, Chosen chosen) {
  const auto any = [&](Verdict verdict) {
    return std::ranges::any_of(comparison.figures, [&](const FigureComparison& f) {
      return f.verdict == verdict && chosen(f);
    });
  };
  const bool joint = with_joint && comparison.joint.has_value();
  if (any(Verdict::changed) || (joint && comparison.joint->p_adjusted < comparison.level))
    return Verdict::changed;
  if (joint || any(Verdict::same)) return Verdict::same;
  const bool open = any(Verdict::cannot_tell) || any(Verdict::only_old) || any(Verdict::only_new);
  return any(Verdict::unchanged) && !open ? Verdict::unchanged : Verdict::cannot_tell;
}

void put_effect(const SensorModel& before, const SensorModel& after, SensorComparison& out) {
  auto effect = calibration_effect(before, after);
  if (effect)
    out.effect = std::move(effect).value();
  else
    out.no_effect = effect.error().message;
}

void note_other_sensor(const SensorModel& before,
                       const SensorModel& after,
                       std::vector<Note>& notes) {
  if (!before.serial.empty() && !after.serial.empty() && before.serial != after.serial)
    notes.push_back(
        {Severity::warning, fmt::format("OLD is of the sensor with serial number {}, NEW of {}",
                                        before.serial, after.serial)});
}

/// The effect is for readings in m/s^2; the conversion to volts or counts may have changed too.
void note_electrical(const SensorModel& before,
                     const SensorModel& after,
                     const SensorComparison& comparison,
                     std::vector<Note>& notes) {
  const Electrical& o = before.electrical;
  const Electrical& n = after.electrical;
  const auto differs = [](const std::optional<Figure>& a, const std::optional<Figure>& b) {
    return a.has_value() != b.has_value() || (a && a->si() != b->si());
  };
  bool any = differs(o.supply, n.supply) || differs(o.reference_supply, n.reference_supply) ||
             differs(o.lsb, n.lsb);
  for (std::size_t axis = 0; axis < 3; ++axis)
    any = any || differs(o.sensitivity[axis], n.sensitivity[axis]) ||
          differs(o.zero_g_fraction[axis], n.zero_g_fraction[axis]);
  if (any && comparison.effect && comparison.effect->reading_unit == "m/s^2")
    notes.push_back(
        {Severity::warning,
         "the electrical figures differ: they convert a recording in volts or counts to "
         "other values in m/s², which the largest error does not include"});
}

/// Notes circumstances that may explain changes of figures.
void note_circumstances(const SensorModel& before,
                        const SensorModel& after,
                        std::vector<Note>& notes) {
  const auto& old_temperature = before.calibration.temperature;
  const auto& new_temperature = after.calibration.temperature;
  if (old_temperature && new_temperature &&
      std::abs(old_temperature->si() - new_temperature->si()) > 2.0)
    notes.push_back({Severity::warning,
                     fmt::format("the calibrations were made {:.1f} K apart in temperature: a "
                                 "change may be due to temperature",
                                 std::abs(old_temperature->si() - new_temperature->si()))});
  const auto& old_gravity = before.calibration.gravity;
  const auto& new_gravity = after.calibration.gravity;
  if (!old_gravity || !new_gravity) return;
  const double relative = new_gravity->si() / old_gravity->si() - 1.0;
  if (std::abs(relative) > 1e-5)
    notes.push_back(
        {Severity::warning,
         fmt::format("gravity was {:.6g} m/s² in OLD and {:.6g} m/s² in "
                     "NEW: at one location the scales differ by {:.2g} % due to this alone",
                     old_gravity->si(), new_gravity->si(), 100.0 * std::abs(relative))});
}

}  // namespace

std::optional<double> FigureComparison::in_stds() const {
  if (!change || !change_std || *change_std == 0.0) return std::nullopt;
  return *change / *change_std;
}

SensorComparison compare(const SensorModel& old_file,
                         const SensorModel& new_file,
                         const ComparisonOptions& options) {
  const SensorModel before = over_sessions(old_file), after = over_sessions(new_file);
  SensorComparison out;
  out.level = options.level;
  out.figures = compared(before, after);
  auto joint = joint_test(before, after);
  if (joint)
    out.joint = *joint;
  else
    out.no_joint = joint.error().message;
  adjust(out);
  for (FigureComparison& figure : out.figures)
    if (figure.p_adjusted)
      figure.verdict = *figure.p_adjusted < options.level ? Verdict::changed : Verdict::same;
  if (options.with_effect) put_effect(before, after, out);
  out.calibration = verdict_on(out, true, is_calibration);
  out.all = verdict_on(out, true, [](const FigureComparison&) { return true; });
  note_other_sensor(before, after, out.notes);
  note_circumstances(before, after, out.notes);
  note_repeatability(before, after, out.notes);
  note_electrical(before, after, out, out.notes);
  return out;
}

std::string_view words_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::changed:
      return "changed by more than their uncertainty";
    case Verdict::same:
      return "the same within their uncertainty";
    case Verdict::unchanged:
      return "the same entry in both files";
    case Verdict::only_old:
      return "in OLD only";
    case Verdict::only_new:
      return "in NEW only";
    case Verdict::condition:
      return "a condition, not tested";
    case Verdict::cannot_tell:
      break;
  }
  return "undetermined";
}

}  // namespace proofmass::sensor
