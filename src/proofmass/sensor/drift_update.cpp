#include "proofmass/sensor/drift_update.hpp"

#include <array>
#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <string_view>
#include <utility>

#include "proofmass/core/contract.hpp"
#include "proofmass/sensor/file/change.hpp"

namespace proofmass::sensor {
namespace {

/// One figure: its name, its unit, its source and its destination.
struct Term {
  std::string_view name, unit;
  Uncertain MeasuredDrift::* measured;
  AxisFigures DriftModel::* figures;
};

constexpr std::array<Term, 3> terms{{
    {"a1", "m/s^2", &MeasuredDrift::a1_mps2, &DriftModel::a1},
    {"a2", "m/s^2", &MeasuredDrift::a2_mps2, &DriftModel::a2},
    {"T", "s", &MeasuredDrift::time_constant_s, &DriftModel::time_constant},
}};

Status check(const Uncertain& figure, bool positive) {
  if (!std::isfinite(figure.value) || !std::isfinite(figure.std))
    return Error{Errc::not_finite, "must be a finite number with a finite standard deviation"};
  if (figure.std < 0.0)
    return Error{Errc::invalid_argument, "its standard deviation must not be negative"};
  if (positive && figure.value <= 0.0) return Error{Errc::invalid_argument, "must be positive"};
  return Done{};
}

Status put(const MeasuredDrift& measured, const Term& term, DriftModel& drift) {
  const Uncertain& figure = measured.*term.measured;
  const bool is_time = term.figures == &DriftModel::time_constant;
  if (const Status fits = check(figure, is_time); !fits)
    return fits.error().at(fmt::format("drift.{} of axis {}", term.name, "xyz"[measured.axis]));
  Figure entry = make_figure(figure.value, term.unit, measured.origin);
  entry.std = figure.std;
  (drift.*term.figures)[measured.axis] = std::move(entry);
  return Done{};
}

}  // namespace

Status update_drift(SensorModel& model, View<MeasuredDrift> measured) {
  DriftModel updated = model.drift;
  std::array<bool, 3> seen{};
  for (const MeasuredDrift& axis : measured) {
    PM_EXPECTS(axis.axis < 3);
    if (std::exchange(seen[axis.axis], true))
      return Error{Errc::invalid_argument,
                   fmt::format("axis {} is there twice, but a sensor file is of one sensor: choose "
                               "its channels",
                               "xyz"[axis.axis])};
    for (const Term& term : terms)
      if (const Status done = put(axis, term, updated); !done) return done;
  }
  model.drift = std::move(updated);
  return Done{};
}

Status update_sensor_file(const std::string& path, View<MeasuredDrift> measured) {
  return change_sensor_file(path,
                            [&](SensorModel& model) { return update_drift(model, measured); });
}

}  // namespace proofmass::sensor
