#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/core/quantity.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/sensor/sensor_model.hpp"

namespace proofmass::sensor {

/// Result of a calibration, laid out as in Calibration: bias and scale of x, y, z and α_yz, α_zy,
/// α_zx in rad, for readings without any other calibration. Figures that were not determined are
/// absent.
struct MeasuredCalibration {
  std::array<std::optional<Uncertain>, 3> bias, scale, misalignment;
  std::string bias_unit = "m/s^2";  ///< unit of the reading: "m/s^2", "V", "counts", or a multiple
  std::string scale_unit = "1";     ///< "1", "V/(m/s^2)" or "counts/(m/s^2)", or a multiple
  /// Covariance of bias x y z, scale x y z, misalignment, in the units above and rad.
  std::optional<std::array<std::array<double, 9>, 9>> covariance;
  /// Calibration::stability, in the unit of the bias.
  std::array<std::optional<double>, 3> stability{};
  /// False if part of the uncertainty is unknown: figures are then written without standard
  /// deviations, and there must be no covariance.
  bool std_known = true;
  /// Effective degrees of freedom of the standard deviations; absent: many. A comparison of two
  /// calibrations allows for more scatter if they are few.
  std::optional<double> dof;
  std::optional<Uncertain> gravity_mps2;  ///< assumed gravity; a std of 0 is not written
  std::optional<double> temperature_k;    ///< temperature of the sensor
  /// For readings in volts of a ratiometric sensor: the supply during the calibration, or V_ref if
  /// the readings are already scaled to it. Absent: the file's electrical.supply.
  std::optional<double> supply_v;
  std::string origin;              ///< "proofmass calibrate poses.csv, 24 positions"
  std::string name, serial, date;  ///< sensor's name and number; date (ISO 8601), if known
};

/// Stores the calibration in the model; figures that were not measured are kept.
///
/// - Volts are scaled to the reference supply, as apply() scales the readings.
/// - An old covariance is dropped as soon as one of its figures is replaced; the new one is kept if
///   it covers every existing figure.
/// - If old figures are kept, the smaller number of degrees of freedom applies.
/// - Gravity and temperature are dropped if all biases and scales are replaced and no new value is
///   given.
///
/// Returns notes for the user: what was kept from before, and what was dropped.
///
/// Errors: invalid_argument (nothing measured, units that are inconsistent or differ from those of
/// the figures kept, a scale of 0, a negative std, an invalid covariance or one that disagrees with
/// the stds, an unknown supply, the serial number of another sensor), not_finite. The model is then
/// unchanged.
[[nodiscard]] Result<std::vector<Note>> update_calibration(SensorModel& model,
                                                           const MeasuredCalibration& measured);

/// The same in a sensor file. Everything else in it is kept, except comments; a missing file is
/// created, with the sensor named after it.
/// Errors: as above, and those of read_sensor_file and write_sensor_file. The file is then
/// unchanged.
[[nodiscard]] Result<std::vector<Note>> update_calibration(const std::string& path,
                                                           const MeasuredCalibration& measured);

}  // namespace proofmass::sensor
