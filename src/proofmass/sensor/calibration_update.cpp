#include "proofmass/sensor/calibration_update.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <string_view>
#include <utility>

#include "proofmass/sensor/calibration.hpp"
#include "proofmass/sensor/calibration_check.hpp"
#include "proofmass/sensor/file/change.hpp"
#include "proofmass/sensor/file/fields.hpp"

namespace proofmass::sensor {
namespace {

using Covariance = std::array<std::array<double, 9>, 9>;
using Measured = std::array<std::optional<Uncertain>, 3>;

std::string listed(const std::vector<std::string_view>& items) {
  return fmt::format("{}", fmt::join(items, ", "));
}

/// Factor for a reading in volts: V_ref / V_s; see Electrical.
Result<double> supply_factor(const Electrical& electrical, const MeasuredCalibration& measured) {
  if (!electrical.reference_supply) return 1.0;
  const double reference_v = electrical.reference_supply->si();
  if (measured.supply_v) {
    if (std::isfinite(*measured.supply_v) && *measured.supply_v > 0.0)
      return reference_v / *measured.supply_v;
    return Error{Errc::invalid_argument, "the supply must be above 0 V"};
  }
  if (!electrical.supply_channel.empty())
    return Error{Errc::invalid_argument,
                 fmt::format("the sensor's output follows its supply, which the file takes from "
                             "channel \"{}\": the supply during the calibration must be known",
                             electrical.supply_channel)};
  return electrical.supply ? reference_v / electrical.supply->si() : 1.0;
}

/// Units of the figures, and the conversion to those written.
struct Units {
  FigureUnit bias, scale;
  double factor = 1.0;  ///< for volts: V_ref / V_s
};

Result<Units> units_of(const Electrical& electrical, const MeasuredCalibration& measured) {
  const auto bias = parse_figure_unit(measured.bias_unit);
  const auto scale = parse_figure_unit(measured.scale_unit);
  if (!bias || !scale)
    return Error{Errc::invalid_argument,
                 fmt::format("a calibration cannot be in \"{}\"; expected m/s^2, V or counts, with "
                             "a scale in 1, V/(m/s^2) or counts/(m/s^2)",
                             bias ? measured.scale_unit : measured.bias_unit)};
  Units units{*bias, *scale};
  if (bias->si_symbol != "V") return units;
  const auto factor = supply_factor(electrical, measured);
  if (!factor) return factor.error();
  units.factor = *factor;
  return units;
}

void put_figures(const MeasuredCalibration& measured,
                 const Units& units,
                 Calibration& calibration) {
  const auto figures = nine_measured(measured);
  const auto places = nine_figures(calibration);
  const FigureUnit radian{"rad", "rad"};
  for (std::size_t k = 0; k < 9; ++k) {
    if (!figures[k]) continue;
    const double factor = k < 6 ? units.factor : 1.0;
    const FigureUnit& unit = k < 3 ? units.bias : k < 6 ? units.scale : radian;
    const std::optional<double> std =
        measured.std_known ? std::optional(figures[k]->std * std::abs(factor)) : std::nullopt;
    *places[k] = Figure{figures[k]->value * factor, std, unit, measured.origin};
  }
}

void put_stability(const MeasuredCalibration& measured,
                   const Units& units,
                   Calibration& calibration) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!measured.bias[axis]) continue;
    auto& figure = calibration.stability[axis];
    figure.reset();
    if (measured.stability[axis])
      figure = Figure{*measured.stability[axis] * std::abs(units.factor), std::nullopt, units.bias,
                      measured.origin};
  }
}

/// In SI, and exactly symmetric, as a sensor file requires.
Covariance written(const Covariance& covariance, const Units& units) {
  const auto factor = [&](std::size_t k) {
    return k < 3 ? units.factor * units.bias.to_si : k < 6 ? units.factor * units.scale.to_si : 1.0;
  };
  Covariance out{};
  for (std::size_t i = 0; i < 9; ++i)
    for (std::size_t j = 0; j <= i; ++j)
      out[i][j] = out[j][i] = 0.5 * (covariance[i][j] + covariance[j][i]) * (factor(i) * factor(j));
  return out;
}

/// Existing figures that were not measured now.
std::vector<std::string_view> kept_figures(const MeasuredCalibration& measured,
                                           Calibration& calibration) {
  const auto figures = nine_measured(measured);
  const auto places = nine_figures(calibration);
  std::vector<std::string_view> kept;
  for (std::size_t k = 0; k < 9; ++k)
    if (!figures[k] && *places[k]) kept.push_back(nine_names[k]);
  return kept;
}

bool all(const Measured& figures) {
  return std::ranges::all_of(figures, [](const auto& f) { return f.has_value(); });
}

void put_covariance(const MeasuredCalibration& measured,
                    const Units& units,
                    Calibration& calibration,
                    std::vector<Note>& notes) {
  const bool had = calibration.covariance.has_value();
  calibration.covariance.reset();
  const auto kept = kept_figures(measured, calibration);
  if (!kept.empty())
    notes.push_back(
        {Severity::warning,
         fmt::format("calibration: {} stay as they were, for they were not measured now",
                     listed(kept))});
  auto& dof = calibration.dof;
  if (kept.empty()) dof.reset();
  if (measured.dof && (!dof || *measured.dof < dof->value))
    dof = make_figure(*measured.dof, "1", measured.origin);
  if (measured.covariance && kept.empty()) {
    calibration.covariance = written(*measured.covariance, units);
  } else if (had || measured.covariance) {
    notes.push_back({Severity::warning,
                     "calibration.covariance is left out: no one measurement made all of the "
                     "figures; each keeps its own standard deviation"});
  }
}

/// Stores the conditions of the calibration.
void put_conditions(const MeasuredCalibration& measured,
                    Calibration& calibration,
                    std::vector<Note>& notes) {
  const bool anew = all(measured.bias) && all(measured.scale);
  if (measured.gravity_mps2) {
    Figure gravity = make_figure(measured.gravity_mps2->value, "m/s^2", measured.origin);
    if (measured.gravity_mps2->std > 0.0) gravity.std = measured.gravity_mps2->std;
    if (!anew && calibration.gravity && calibration.gravity->si() != gravity.value)
      notes.push_back({Severity::warning,
                       fmt::format("calibration.gravity was {} m/s² and is {} m/s² now: what was "
                                   "not measured now stays as the former made it",
                                   calibration.gravity->si(), gravity.value)});
    calibration.gravity = std::move(gravity);
  } else if (anew) {
    calibration.gravity.reset();
  }
  if (measured.temperature_k)
    calibration.temperature = make_figure(*measured.temperature_k, "K", measured.origin);
  else if (anew)
    calibration.temperature.reset();
}

Status put_identity(const MeasuredCalibration& measured, SensorModel& model) {
  if (!measured.serial.empty() && !model.serial.empty() && measured.serial != model.serial)
    return Error{Errc::invalid_argument,
                 fmt::format("the file is of the sensor with serial number {}, the calibration of "
                             "{}: give each sensor a file of its own",
                             model.serial, measured.serial)};
  if (!measured.name.empty()) model.name = measured.name;
  if (!measured.serial.empty()) model.serial = measured.serial;
  if (!measured.date.empty()) model.date = measured.date;
  return Done{};
}

/// Checks that the figures are consistent, by apply().
Status check_together(const Calibration& calibration) {
  SensorModel alone;
  alone.calibration = calibration;
  Recording nothing;
  const Status fits = apply(alone, Triad{}, nothing);
  if (fits) return fits;
  return Error{fits.error().code,
               fits.error().message +
                   "; figures that were not measured now stay: calibrate all axes at once, or "
                   "write to a file that is not there yet"};
}

/// Without a scale, an axis in volts or counts cannot be converted.
void note_unreadable_axes(const Calibration& calibration,
                          const Units& units,
                          std::vector<Note>& notes) {
  std::vector<std::string_view> missing;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (!calibration.scale[axis]) missing.push_back(std::string_view("xyz").substr(axis, 1));
  if (missing.empty() || units.bias.si_symbol == "m/s^2") return;
  notes.push_back({Severity::warning,
                   fmt::format("calibration.scale is not known of axis {}: a recording that has it "
                               "can be read with this file only once it is",
                               listed(missing))});
}

}  // namespace

Result<std::vector<Note>> update_calibration(SensorModel& model,
                                             const MeasuredCalibration& measured) {
  if (const Status fits = check_measured(measured); !fits) return fits.error();
  const auto units = units_of(model.electrical, measured);
  if (!units) return units.error();
  SensorModel updated = model;
  if (const Status fits = put_identity(measured, updated); !fits) return fits.error();
  std::vector<Note> notes;
  Calibration& calibration = updated.calibration;
  put_figures(measured, *units, calibration);
  put_stability(measured, *units, calibration);
  if (const Status fits = check_together(calibration); !fits) return fits.error();
  put_covariance(measured, *units, calibration, notes);
  put_conditions(measured, calibration, notes);
  note_unreadable_axes(calibration, *units, notes);
  if (units->factor != 1.0)
    notes.push_back({Severity::info,
                     fmt::format("calibration: brought to the reference supply of {:.6g} V, from "
                                 "{:.6g} V",
                                 model.electrical.reference_supply->si(),
                                 model.electrical.reference_supply->si() / units->factor)});
  model = std::move(updated);
  return notes;
}

Result<std::vector<Note>> update_calibration(const std::string& path,
                                             const MeasuredCalibration& measured) {
  std::vector<Note> notes;
  const Status done = change_sensor_file(path, [&](SensorModel& model) -> Status {
    auto updated = update_calibration(model, measured);
    if (!updated) return updated.error();
    notes = std::move(updated).value();
    return Done{};
  });
  if (!done) return done.error();
  return notes;
}

}  // namespace proofmass::sensor
