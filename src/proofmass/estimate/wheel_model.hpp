#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "proofmass/estimate/kalman.hpp"

// The state-space model of accelerometers on a wheel that turns about a level axle.
//
// Each sensor has two axes u, v in the plane of the wheel, v a quarter turn ahead of u. With φ the
// angle of u from the horizontal, r = (r_u, r_v) the place of the sensor as seen in its own axes,
// ω and α speed and acceleration of the wheel, and a_h = −ρ α the axle's acceleration where the
// wheel rolls on a radius ρ (0 on a bench),
//
//   f_u = g sin φ + a_h cos φ − ω² r_u − α r_v
//   f_v = g cos φ − a_h sin φ − ω² r_v + α r_u
//   z_u = (1 + s_u)(f_u + κ f_v) + b_u,   z_v = (1 + s_v)(f_v + κ f_u) + b_v,
//
// with biases b, scale errors s and a skew κ of the two axes. Sensor 1 has φ = θ, the wheel's
// angle; sensor 2 has φ = θ + μ. A common turn of both axes of sensor 1 against the wheel's marks
// is in no reading, and so in no state. Nor is ρ: a_h shifts the apparent gravity by −ρ α / g,
// which is what a shift of φ does. Source: kinematics of a rigid body in a plane; for two opposite
// sensors with parallel axes, M. A. Lele (2010), section 4.4, with α = a_t / R.
namespace proofmass::estimate {

/// Where each quantity sits in the state; what belongs to a sensor counts from first_of(sensor).
namespace wheel {
inline constexpr int angle = 0, speed = 1, accel = 2, jerk = 3, moving = 4;
/// The angle at the first instant rides along as a constant, so that the turns since then have
/// their variance from one covariance.
inline constexpr int start = 4;
inline constexpr int bias = 0, scale = 2, skew = 4;  ///< of a sensor, from first_of on

[[nodiscard]] constexpr int first_of(int sensor) {
  return 5 + 5 * sensor;
}
/// Of the second sensor against the first.
inline constexpr int phase = first_of(2);
/// The places come last: once found they are held, and the filter runs on the states before them.
[[nodiscard]] constexpr int places(int sensors) {
  return first_of(sensors) + (sensors - 1);
}
[[nodiscard]] constexpr int states(int sensors) {
  return places(sensors) + 2 * sensors;
}
/// What stands from first_of(0) on: the sensors' constants, the phase, the places.
[[nodiscard]] constexpr int standing(int sensors) {
  return states(sensors) - first_of(0);
}
}  // namespace wheel

/// What the filter is told of the noise; found from the recording by tune_wheel().
struct WheelNoise {
  /// Two-sided densities of what drives the motion: white jerk, rad²/s⁵, for speeds that change
  /// roughly, and white snap, rad²/s⁷, for those that change smoothly.
  double jerk_psd = 1.0, snap_psd = 0.0;
  double bias_walk_psd = 0.0;  ///< of each bias, (m/s²)²/s
};

/// The readings of one sensor in the plane of the wheel, SI.
struct PlanarReadings {
  std::vector<double> u_mps2, v_mps2;  ///< NaN where there is no reading
  std::vector<double> variance_m2ps4;  ///< of each reading, both axes alike

  [[nodiscard]] bool has(std::size_t row) const {
    return !std::isnan(u_mps2[row]) && !std::isnan(v_mps2[row]);
  }
};

/// What an earlier pass found. The readings are made linear about its constants; about its motion
/// only where the filter's own prediction is half a radian away, which is a filter that slips. The
/// prediction owes nothing to the reading it meets; a smoothed motion does, and columns of the
/// Jacobian that share their noise with the readings bias what is fitted to them.
struct WheelPath {
  std::vector<Mat<wheel::moving>> moving;
  Eigen::VectorXd standing;  ///< in the state's order from wheel::first_of(0) on
};

/// One instant of the merged time line and the row of each sensor that was read then.
struct WheelInstant {
  static constexpr std::int64_t no_row = -1;
  double dt_s = 0.0;  ///< since the instant before
  std::array<std::int64_t, 2> row{no_row, no_row};
};

template <int Sensors>
struct WheelModel {
  static constexpr int sensors_used = Sensors;
  static constexpr int states = wheel::states(Sensors);
  static constexpr int moving = wheel::moving;
  static constexpr int channels = 2 * Sensors;
  using State = Mat<states>;

  double gravity_mps2 = 0.0;      ///< its component in the plane of the wheel
  double rolling_radius_m = 0.0;  ///< ρ; 0 for an axle that stands
  double phase_rad = 0.0;         ///< of sensor 2; its state is the departure from this
  WheelNoise noise;
  const std::vector<WheelInstant>* instants = nullptr;
  std::array<const PlanarReadings*, 2> readings{};
  const WheelPath* about = nullptr;  ///< nullptr: the plain extended filter

  bool places_held = false;  ///< they have no variance and learn nothing

  [[nodiscard]] std::size_t size() const { return instants->size(); }
  [[nodiscard]] int active() const { return places_held ? wheel::places(Sensors) : states; }

  [[nodiscard]] Transition<states, moving> transition(const State& x, std::size_t k) const {
    const double t = (*instants)[k].dt_s, t2 = t * t, t3 = t2 * t, t4 = t2 * t2, t5 = t4 * t;
    const double t6 = t3 * t3, t7 = t4 * t3;
    Transition<states, moving> step;
    // clang-format off
    step.F << 1, t, t2 / 2, t3 / 6,
              0, 1, t,      t2 / 2,
              0, 0, 1,      t,
              0, 0, 0,      1;
    step.Q << t7 / 252, t6 / 72, t5 / 30, t4 / 24,
              t6 / 72,  t5 / 20, t4 / 8,  t3 / 6,
              t5 / 30,  t4 / 8,  t3 / 3,  t2 / 2,
              t4 / 24,  t3 / 6,  t2 / 2,  t;
    Mat<3, 3> rough;
    rough << t5 / 20, t4 / 8, t3 / 6,
             t4 / 8,  t3 / 3, t2 / 2,
             t3 / 6,  t2 / 2, t;
    // clang-format on
    step.Q *= noise.snap_psd;
    step.Q.template topLeftCorner<3, 3>() += noise.jerk_psd * rough;
    step.mean = step.F * x.template head<moving>();
    step.walk.setZero();
    for (int s = 0; s < Sensors; ++s)
      step.walk.template segment<2>(wheel::first_of(s)).setConstant(noise.bias_walk_psd * t);
    return step;
  }

  /// Whether instant k has the readings of a sensor.
  [[nodiscard]] bool has_readings(std::size_t sensor, std::size_t k) const {
    const std::int64_t row = (*instants)[k].row[sensor];
    return row != WheelInstant::no_row && readings[sensor]->has(static_cast<std::size_t>(row));
  }

  void measure(const State& x, std::size_t k, Readings<states, channels>& out) const {
    out.count = 0;
    const State at_state = about == nullptr ? x : state_about(x, k);
    for (int s = 0; s < Sensors; ++s) {
      const auto index = static_cast<std::size_t>(s);
      if (!has_readings(index, k)) continue;
      const PlanarReadings& sensor = *readings[index];
      const auto at = static_cast<std::size_t>((*instants)[k].row[index]);
      read_sensor(at_state, s, out);
      auto& u = out.rows[static_cast<std::size_t>(out.count - 2)];
      auto& v = out.rows[static_cast<std::size_t>(out.count - 1)];
      u.value = sensor.u_mps2[at];
      v.value = sensor.v_mps2[at];
      u.variance = v.variance = sensor.variance_m2ps4[at];
      if (about != nullptr) {
        u.predicted += u.h.dot(x - at_state);
        v.predicted += v.h.dot(x - at_state);
      }
    }
  }

  /// Gives up what is believed of the motion, not of the sensors: called when the gate has shut
  /// everything out for a while.
  void reopen(Gaussian<states>& x) const {
    const Mat<moving> open(1.0, 100.0, 100.0, 100.0);  // (1 rad)², (10 rad/s)², …
    for (int i = 0; i < moving; ++i) {
      x.cov.row(i).setZero();
      x.cov.col(i).setZero();
      x.cov(i, i) = open(i);
    }
  }

 private:
  [[nodiscard]] State state_about(const State& x, std::size_t k) const {
    State at = x;
    if (std::abs(x(wheel::angle) - about->moving[k](wheel::angle)) > 0.5)
      at.template head<moving>() = about->moving[k];
    constexpr int first = wheel::first_of(0), count = wheel::places(Sensors) - first;
    at.template segment<count>(first) = about->standing.head<count>();
    return at;
  }

  void read_sensor(const State& x, int s, Readings<states, channels>& out) const {
    const int at = wheel::first_of(s);
    const double phi = x(wheel::angle) + (s > 0 ? phase_rad + x(wheel::phase) : 0.0);
    const double sin_phi = std::sin(phi), cos_phi = std::cos(phi);
    const double w = x(wheel::speed), al = x(wheel::accel);
    const int place = wheel::places(Sensors) + 2 * s;
    const double ru = x(place), rv = x(place + 1);
    const double g = gravity_mps2, hub = -rolling_radius_m * al;
    // Forces and their derivatives in the sensor's true axes.
    const double turn_u = g * cos_phi - hub * sin_phi;   // ∂f_u/∂φ
    const double turn_v = -g * sin_phi - hub * cos_phi;  // ∂f_v/∂φ
    const double fu = -turn_v - w * w * ru - al * rv;
    const double fv = turn_u - w * w * rv + al * ru;
    Mat<states> du = Mat<states>::Zero(), dv = Mat<states>::Zero();
    du(wheel::angle) = turn_u;
    dv(wheel::angle) = turn_v;
    du(wheel::speed) = -2.0 * w * ru;
    dv(wheel::speed) = -2.0 * w * rv;
    du(wheel::accel) = -rv - rolling_radius_m * cos_phi;
    dv(wheel::accel) = ru + rolling_radius_m * sin_phi;
    if (s > 0) {
      du(wheel::phase) = turn_u;
      dv(wheel::phase) = turn_v;
    }
    du(place) = dv(place + 1) = -w * w;
    du(place + 1) = -al;
    dv(place) = al;
    // Through scale, skew and bias to what is read.
    const double su = 1.0 + x(at + wheel::scale), sv = 1.0 + x(at + wheel::scale + 1);
    const double skew = x(at + wheel::skew);
    auto& u = out.rows[static_cast<std::size_t>(out.count++)];
    auto& v = out.rows[static_cast<std::size_t>(out.count++)];
    u.h = su * (du + skew * dv);
    v.h = sv * (dv + skew * du);
    u.h(at + wheel::scale) = fu + skew * fv;
    v.h(at + wheel::scale + 1) = fv + skew * fu;
    u.h(at + wheel::skew) = su * fv;
    v.h(at + wheel::skew) = sv * fu;
    u.h(at + wheel::bias) = v.h(at + wheel::bias + 1) = 1.0;
    u.predicted = su * (fu + skew * fv) + x(at + wheel::bias);
    v.predicted = sv * (fv + skew * fu) + x(at + wheel::bias + 1);
  }
};

}  // namespace proofmass::estimate
