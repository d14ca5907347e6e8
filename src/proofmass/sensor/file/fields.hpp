#pragma once

#include <array>
#include <initializer_list>
#include <string_view>

#include "proofmass/sensor/sensor_model.hpp"

namespace proofmass::sensor {

inline constexpr std::array<std::string_view, 7> sections{
    "sensor", "electrical", "calibration", "noise", "drift", "gyroscope", "encoder"};

/// Rows of Gyroscope::covariance.
inline constexpr std::string_view gyroscope_order =
    "bias x y z, scale x y z, misalignment yz zy zx, alignment x y z, g_sensitivity_x, _y, _z";

/// Every figure of a sensor file, once: section, key, permitted SI units, member. To add a figure,
/// add a line here. Model is SensorModel or const SensorModel.
template <class Model, class Visit>
void visit_figures(Model& model, Visit&& visit) {
  using Units = std::initializer_list<std::string_view>;
  auto& e = model.electrical;
  visit("electrical", "supply", Units{"V"}, e.supply);
  visit("electrical", "reference_supply", Units{"V"}, e.reference_supply);
  visit("electrical", "sensitivity", Units{"V/(m/s^2)"}, e.sensitivity);
  visit("electrical", "zero_g_fraction", Units{"1"}, e.zero_g_fraction);
  visit("electrical", "bandwidth", Units{"Hz"}, e.bandwidth);
  visit("electrical", "lsb", Units{"V", "m/s^2"}, e.lsb);
  auto& c = model.calibration;
  visit("calibration", "bias", Units{"m/s^2", "V", "counts"}, c.bias);
  visit("calibration", "scale", Units{"1", "V/(m/s^2)", "counts/(m/s^2)"}, c.scale);
  visit("calibration", "misalignment", Units{"rad"}, c.misalignment);
  visit("calibration", "stability", Units{"m/s^2", "V", "counts"}, c.stability);
  visit("calibration", "dof", Units{"1"}, c.dof);
  visit("calibration", "gravity", Units{"m/s^2"}, c.gravity);
  visit("calibration", "temperature", Units{"K"}, c.temperature);
  visit("calibration", "alignment_std", Units{"rad"}, c.alignment_std);
  auto& n = model.noise;
  visit("noise", "white", Units{"m/s^2/sqrt(Hz)"}, n.white);
  visit("noise", "quantisation", Units{"m/s"}, n.quantisation);
  visit("noise", "flicker", Units{"m/s^2"}, n.flicker);
  visit("noise", "random_walk", Units{"m/s^2/sqrt(s)"}, n.random_walk);
  visit("noise", "ramp", Units{"m/s^3"}, n.ramp);
  auto& d = model.drift;
  visit("drift", "a1", Units{"m/s^2"}, d.a1);
  visit("drift", "a2", Units{"m/s^2"}, d.a2);
  visit("drift", "T", Units{"s"}, d.time_constant);
  auto& g = model.gyroscope;
  const Units g_units{"rad/s/(m/s^2)", "V/(m/s^2)", "counts/(m/s^2)"};
  visit("gyroscope", "bias", Units{"rad/s", "V", "counts"}, g.bias);
  visit("gyroscope", "scale", Units{"1", "V/(rad/s)", "counts/(rad/s)"}, g.scale);
  visit("gyroscope", "misalignment", Units{"rad"}, g.misalignment);
  visit("gyroscope", "alignment", Units{"rad"}, g.alignment);
  visit("gyroscope", "g_sensitivity_x", g_units, g.g_sensitivity[0]);
  visit("gyroscope", "g_sensitivity_y", g_units, g.g_sensitivity[1]);
  visit("gyroscope", "g_sensitivity_z", g_units, g.g_sensitivity[2]);
  visit("gyroscope", "white", Units{"rad/s/sqrt(Hz)"}, g.white);
  visit("gyroscope", "flicker", Units{"rad/s"}, g.flicker);
  visit("gyroscope", "random_walk", Units{"rad/s/sqrt(s)"}, g.random_walk);
  auto& turning = model.encoder;
  visit("encoder", "counts_per_turn", Units{"1"}, turning.counts_per_turn);
  visit("encoder", "once_cos", Units{"rad"}, turning.once_cos);
  visit("encoder", "once_sin", Units{"rad"}, turning.once_sin);
  visit("encoder", "twice_cos", Units{"rad"}, turning.twice_cos);
  visit("encoder", "twice_sin", Units{"rad"}, turning.twice_sin);
}

/// The nine figures of a calibration in the order of its covariance, as pointers to
/// std::optional<Figure>, or to const of it.
template <class C>
auto nine_figures(C& calibration) {
  auto& [bx, by, bz] = calibration.bias;
  auto& [sx, sy, sz] = calibration.scale;
  auto& [yz, zy, zx] = calibration.misalignment;
  return std::array{&bx, &by, &bz, &sx, &sy, &sz, &yz, &zy, &zx};
}

/// The same for text entries.
template <class Model, class Visit>
void visit_texts(Model& model, Visit&& visit) {
  visit("sensor", "name", model.name);
  visit("sensor", "serial", model.serial);
  visit("sensor", "date", model.date);
  visit("electrical", "supply_channel", model.electrical.supply_channel);
}

}  // namespace proofmass::sensor
