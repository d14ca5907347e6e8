#include "proofmass/estimate/wheel/baseline_methods.hpp"

#include <cmath>
#include <limits>
#include <numbers>

namespace proofmass::estimate {
namespace {

struct Planar {
  double u = 0.0, v = 0.0;
};

/// Mean over the sensors of `see` applied to each one's last measurement, at every epoch; a sensor
/// keeps its last measurement until its next. NaN until all have one.
template <class See, class Visit>
void at_each_epoch(const WheelReadings& readings, See&& see, Visit&& visit) {
  std::array<Planar, 2> seen;
  std::array<bool, 2> ready{};
  for (std::size_t k = 0; k < readings.epochs.size(); ++k) {
    bool all = true;
    Planar mean;
    for (std::size_t s = 0; s < readings.sensors.size(); ++s) {
      const std::int64_t row = readings.epochs[k].row[s];
      const auto at = static_cast<std::size_t>(row);
      if (row != WheelEpoch::no_row && readings.sensors[s].has(at)) {
        seen[s] = see(s, Planar{readings.sensors[s].u_mps2[at], readings.sensors[s].v_mps2[at]});
        ready[s] = true;
      }
      all = all && ready[s];
      mean.u += seen[s].u / static_cast<double>(readings.sensors.size());
      mean.v += seen[s].v / static_cast<double>(readings.sensors.size());
    }
    visit(k, mean, all);
  }
}

}  // namespace

std::vector<double> atan2_angle(const WheelReadings& readings) {
  std::vector<double> angle(readings.epochs.size(), std::numeric_limits<double>::quiet_NaN());
  const double sin_phase = std::sin(readings.phase_rad), cos_phase = std::cos(readings.phase_rad);
  double last = std::numeric_limits<double>::quiet_NaN();
  at_each_epoch(
      readings,
      [&](std::size_t s, Planar f) {
        // Sensor 2 sees the phase θ + μ; rotating its vector back by μ gives what sensor 1 would
        // measure.
        if (s == 0) return f;
        return Planar{f.u * cos_phase - f.v * sin_phase, f.u * sin_phase + f.v * cos_phase};
      },
      [&](std::size_t k, Planar f, bool ready) {
        if (!ready) return;
        const double phase = std::atan2(f.u, f.v);
        last = std::isnan(last) ? phase : last + std::remainder(phase - last, rad_per_turn);
        angle[k] = last;
      });
  return angle;
}

std::optional<PlainPlaces> plain_places(const std::vector<WheelSensorFit>& sensors,
                                        double phase_rad) {
  PlainPlaces plain{Eigen::VectorXd::Zero(static_cast<Eigen::Index>(2 * sensors.size()))};
  double first_rad = 0.0;  // of the first sensor's spoke, ahead of its first axis
  for (std::size_t s = 0; s < sensors.size(); ++s) {
    if (!sensors[s].radius_m) return std::nullopt;
    double spoke_rad = s == 0 ? 0.0 : first_rad + std::numbers::pi - phase_rad;
    if (sensors[s].mounting_rad)
      spoke_rad = -sensors[s].mounting_rad->value;
    else
      plain.taken = true;
    if (s == 0) first_rad = spoke_rad;
    plain.places_m.segment<2>(static_cast<Eigen::Index>(2 * s)) =
        sensors[s].radius_m->value * Eigen::Vector2d(std::cos(spoke_rad), std::sin(spoke_rad));
  }
  return plain;
}

std::vector<double> double_integral_angle(const WheelReadings& readings,
                                          const Eigen::VectorXd& places,
                                          double start_angle_rad,
                                          double start_speed_radps) {
  for (Eigen::Index s = 0; s < places.size() / 2; ++s)
    if (places.segment(2 * s, 2).norm() < 1e-6) return {};
  std::vector<double> angle(readings.epochs.size(), start_angle_rad);
  double speed = start_speed_radps, position = start_angle_rad, last_accel = 0.0;
  bool started = false;
  at_each_epoch(
      readings,
      [&](std::size_t s, Planar f) {
        // An angular acceleration α moves a mass at (r_u, r_v) with α (−r_v, r_u): its component
        // along that, over r².
        const double ru = places(static_cast<Eigen::Index>(2 * s));
        const double rv = places(static_cast<Eigen::Index>(2 * s + 1));
        return Planar{(f.v * ru - f.u * rv) / (ru * ru + rv * rv), 0.0};
      },
      [&](std::size_t k, Planar accel, bool ready) {
        const double dt = readings.epochs[k].dt_s;
        const double mean_accel = started ? 0.5 * (last_accel + accel.u) : 0.0;
        position += dt * (speed + 0.5 * dt * mean_accel);
        speed += dt * mean_accel;
        angle[k] = position;
        if (ready) last_accel = accel.u;
        started = started || ready;
      });
  return angle;
}

}  // namespace proofmass::estimate
