#include "proofmass/sensor/calibration_error.hpp"

#include <array>
#include <utility>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/sensor/calibration.hpp"

namespace proofmass::sensor {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;

void add_supply(const SensorModel& model, Recording& recording) {
  const Electrical& electrical = model.electrical;
  const std::string& name = electrical.supply_channel;
  if (name.empty() || recording.find(name) != nullptr) return;
  const auto& supply = electrical.supply ? electrical.supply : electrical.reference_supply;
  if (!supply) return;
  Channel channel{name, parse_unit("V").value(), {}};
  channel.values.edit().assign(recording.samples(), supply->si());
  recording.channels.push_back(std::move(channel));
}

/// The affine map of apply() for readings in that unit, from the readings 0, e_x, e_y and e_z.
Result<Affine> force_of_reading(const SensorModel& model, const std::string& unit) {
  Recording recording;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Channel channel{std::string(1, "xyz"[axis]), parse_unit(unit).value(), {0.0, 0.0, 0.0, 0.0}};
    channel.values.edit()[axis + 1] = 1.0;
    recording.channels.push_back(std::move(channel));
  }
  add_supply(model, recording);
  const Triad triad{"", 0, 1, 2};
  if (const Status done = apply(model, triad, recording); !done) return done.error();
  Affine force;
  for (std::size_t row = 0; row < 3; ++row) {
    const auto& f = recording.channels[row].values;
    const auto i = static_cast<Index>(row);
    force.offset(i) = f[0];
    for (Index axis = 0; axis < 3; ++axis)
      force.matrix(i, axis) = f[static_cast<std::size_t>(axis) + 1] - f[0];
  }
  return force;
}

}  // namespace

Result<Affine> error_between(const SensorModel& before,
                             const SensorModel& after,
                             const std::string& unit) {
  const auto old_force = force_of_reading(before, unit);
  if (!old_force) return old_force.error().at("OLD");
  const auto new_force = force_of_reading(after, unit);
  if (!new_force) return new_force.error().at("NEW");
  // apply()'s matrix is upper triangular: row i uses only the axes from i on.
  const auto reading = new_force->matrix.triangularView<Eigen::Upper>();
  const Matrix3d inverse = reading.solve(Matrix3d::Identity());
  const Matrix3d A = old_force->matrix * inverse;
  Affine error{standard_gravity_mps2 * (A - Matrix3d::Identity()),
               old_force->offset - A * new_force->offset};
  if (!error.matrix.allFinite() || !error.offset.allFinite())
    return Error{Errc::invalid_argument, "the two calibrations are too far apart to compare"};
  // Differences below this are rounding errors.
  constexpr double rounding_mps2 = 1e-11;
  if (error.matrix.cwiseAbs().maxCoeff() < rounding_mps2 &&
      error.offset.cwiseAbs().maxCoeff() < rounding_mps2)
    return Affine{};
  return error;
}

std::string common_unit(const SensorModel& before, const SensorModel& after) {
  const auto mine = reading_unit(after.calibration);
  const auto other = reading_unit(before.calibration);
  for (const std::string& unit : {mine ? *mine : "counts", other ? *other : "counts",
                                  std::string("counts"), std::string("V")})
    if (error_between(before, after, unit)) return unit;
  return mine ? *mine : "m/s^2";
}

}  // namespace proofmass::sensor
