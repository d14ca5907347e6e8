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

/// What a calibration found, as Calibration has it: bias and scale of x, y, z and α_yz, α_zy, α_zx
/// in rad, of readings to which no other calibration was applied. What it did not find is absent.
struct MeasuredCalibration {
  std::array<std::optional<Uncertain>, 3> bias, scale, misalignment;
  std::string bias_unit = "m/s^2";  ///< of the reading: "m/s^2", "V" or "counts", or a multiple
  std::string scale_unit = "1";     ///< "1", "V/(m/s^2)" or "counts/(m/s^2)", or a multiple
  /// Of bias x y z, scale x y z, misalignment, in the units above and rad.
  std::optional<std::array<std::array<double, 9>, 9>> covariance;
  /// Calibration::stability, in the unit of the bias.
  std::array<std::optional<double>, 3> stability{};
  /// False where part of the uncertainty is not known: figures are then written without standard
  /// deviations, and there must be no covariance.
  bool std_known = true;
  /// Effective degrees of freedom of the standard deviations; absent: so many that it does not
  /// matter. Who compares two calibrations takes more scatter for chance where they are few.
  std::optional<double> dof;
  std::optional<Uncertain> gravity_mps2;  ///< that was taken for true; a std of 0 is not written
  std::optional<double> temperature_k;    ///< of the sensor
  /// Of readings in volts of a ratiometric sensor: the supply at which they were taken, V_ref where
  /// they were brought to it already. Absent: the file's electrical.supply.
  std::optional<double> supply_v;
  std::string origin;              ///< "proofmass calibrate poses.csv, 24 positions"
  std::string name, serial, date;  ///< of the sensor and of the day (ISO 8601), where known
};

/// Puts the calibration into the model; what was not measured stays. Volts are brought to the
/// reference supply, as apply() will bring the readings. An old covariance goes as soon as one of
/// its figures is replaced; the new one is kept if it covers every figure there is; of degrees of
/// freedom the fewest hold where figures stay. Gravity and temperature go where all biases and
/// scales are replaced and nobody says them anew. Returns what a person should know of it: what
/// was kept from before, and what had to go.
///
/// Errors: invalid_argument (nothing measured, units that do not go together or are not those of
/// the figures that stay, a scale of 0, a negative std, a covariance that is none or not of these
/// stds, a supply that nobody knows, the serial number of another sensor),
/// not_finite. The model is then as it was.
[[nodiscard]] Result<std::vector<Note>> update_calibration(SensorModel& model,
                                                           const MeasuredCalibration& measured);

/// The same in a sensor file, of which all else stays as it is, save comments; a file that is not
/// there is made, with the sensor named after it.
/// Errors: as above, and those of read_sensor_file and write_sensor_file. The file is then as it
/// was.
[[nodiscard]] Result<std::vector<Note>> update_calibration(const std::string& path,
                                                           const MeasuredCalibration& measured);

}  // namespace proofmass::sensor
