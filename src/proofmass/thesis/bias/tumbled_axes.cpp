#include "proofmass/thesis/bias/tumbled_axes.hpp"

#include <cmath>
#include <cstddef>
#include <utility>

#include "proofmass/core/units.hpp"
#include "proofmass/sensor/datasheet.hpp"
#include "proofmass/sensor/gravity.hpp"

namespace proofmass::thesis {
namespace {

using calibrate::TumblePosition;

// A wheel's marks are not finer than this.
constexpr double same_angle_rad = 0.5 * rad_per_deg;

std::string si_symbol(const Unit& unit) {
  if (unit.quantity == Quantity::acceleration) return "m/s^2";
  if (unit.quantity == Quantity::voltage) return "V";
  return unit.symbol;
}

// The positions with this channel's outputs as an ideal sensor's force, or as they are.
std::vector<TumblePosition> positions_of(const TumbleRecord& record,
                                         const TumbleChannel& channel,
                                         const std::optional<IdealOutput>& ideal) {
  const IdealOutput as = ideal.value_or(IdealOutput{});
  std::vector<TumblePosition> positions = record.positions;
  for (std::size_t k = 0; k < positions.size(); ++k) {
    const double std = channel.std[k] * channel.unit.to_si;
    positions[k].output = (channel.unit.si(channel.output[k]) - as.zero) / as.scale;
    positions[k].output_std = std::isfinite(std) ? std / as.scale : 0.0;
  }
  return positions;
}

Result<TumbledAxis> fitted(const TumbleRecord& record,
                           const TumbleChannel& channel,
                           const calibrate::TumbleAxis& axis,
                           double gravity_mps2) {
  TumbledAxis out{.name = channel.name,
                  .unit = si_symbol(channel.unit),
                  .ideal = ideal_output(channel.unit),
                  .axis = axis,
                  .positions = {},
                  .noise_dof = channel.noise_dof,
                  .fit = {}};
  for (TumblePosition& p : positions_of(record, channel, out.ideal))
    if (axis.phase_rad[p.plane == 2 ? 1 : 0]) out.positions.push_back(std::move(p));
  Result<calibrate::TumbleFit> fit = calibrate::fit_tumble(
      out.positions,
      {.gravity_mps2 = gravity_mps2,
       .gravity_std_mps2 = gravity_std_mps2(record, gravity_mps2),
       .indexing_std_rad = 0.0,  // as the thesis takes the wheel's marks
       .drift_std_mps2 = 0.0,
       .noise_dof = channel.noise_dof,
       .output_unit = out.ideal ? "m/s^2" : out.unit,
       .phase_rad = {axis.phase_rad[0].value_or(0.0), axis.phase_rad[1].value_or(0.0)}});
  if (!fit) return fit.error().at(channel.name);
  out.fit = std::move(fit).value();
  return out;
}

// Where the axis lies level as the table shows 0°.
bool follows_sine(const calibrate::TumbleAxis& axis) {
  const double phase = axis.phase_rad[0].value_or(*axis.phase_rad[axis.phase_rad[0] ? 0 : 1]);
  return std::abs(std::sin(phase)) < 0.5;
}

}  // namespace

std::optional<IdealOutput> ideal_output(const Unit& unit) {
  constexpr double supply_v = 3.3, part = supply_v / sensor::adxl335.reference_supply_v;
  if (unit.quantity == Quantity::acceleration) return IdealOutput{};
  if (unit.quantity == Quantity::voltage)
    return IdealOutput{.zero = part * *sensor::adxl335.zero_g_v[0].typ,
                       .scale = part * *sensor::adxl335.sensitivity_v_per_mps2.typ};
  return std::nullopt;
}

double gravity_std_mps2(const TumbleRecord& record, double gravity_mps2) {
  if (record.simulated) return 0.0;
  return gravity_mps2 == standard_gravity_mps2 ? sensor::gravity_std_on_earth_mps2
                                               : sensor::gravity_anomaly_std_mps2;
}

double TumbledAxis::phi_rad(const TumblePosition& position) const {
  return position.angle_rad + position.mount_rad +
         axis.phase_rad[position.plane == 2 ? 1 : 0].value_or(0.0);
}

double TumbledAxis::output(double reading) const {
  return ideal ? ideal->zero + ideal->scale * reading : reading;
}

double TumbledAxis::output_size(double reading) const {
  return ideal ? ideal->scale * reading : reading;
}

std::optional<Uncertain> TumbledAxis::mean_at(double angle_rad) const {
  double sum = 0.0, variance = 0.0, count = 0.0;
  bool known = true;
  for (const TumblePosition& p : positions) {
    const double off = std::remainder(p.angle_rad + p.mount_rad - angle_rad, rad_per_turn);
    if (p.plane != 1 || std::abs(off) > same_angle_rad) continue;
    sum += p.output;
    variance += p.output_std * p.output_std;
    known = known && p.output_std > 0.0;
    count += 1.0;
  }
  if (count == 0.0) return std::nullopt;
  return Uncertain{.value = sum / count, .std = known ? std::sqrt(variance) / count : 0.0};
}

double TumbledAxis::value_of(calibrate::TumbleQuantity quantity) const {
  const calibrate::TumbleCoefficient* found = fit.find(quantity);
  return found == nullptr ? 0.0 : found->value.value_or(0.0);
}

Result<TumbledAxes> analyse_tumble(const TumbleRecord& record, double gravity_mps2) {
  std::vector<std::vector<double>> outputs;
  outputs.reserve(record.channels.size());
  for (const TumbleChannel& channel : record.channels) outputs.push_back(channel.output);
  const auto axes = calibrate::tumble_axes(record.positions, outputs);
  TumbledAxes out;
  for (std::size_t k = 0; k < axes.size(); ++k) {
    const TumbleChannel& channel = record.channels[k];
    if (!axes[k].follows_angle()) {
      out.refused.push_back(channel.name + ": the output " + axes[k].words +
                            ", and a tumble about it does not excite it.");
      continue;
    }
    std::optional<TumbledAxis>& place = follows_sine(axes[k]) ? out.x : out.y;
    if (place) {
      out.refused.push_back(channel.name + ": the output " + axes[k].words + ", as that of " +
                            place->name + ", which stands for it here.");
      continue;
    }
    Result<TumbledAxis> axis = fitted(record, channel, axes[k], gravity_mps2);
    if (!axis) return axis.error();
    place = std::move(axis).value();
  }
  return out;
}

}  // namespace proofmass::thesis
