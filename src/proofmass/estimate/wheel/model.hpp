#pragma once

#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "proofmass/estimate/filter/smoother.hpp"
#include "proofmass/estimate/wheel/readings.hpp"
#include "proofmass/estimate/wheel/states.hpp"

// State-space model of accelerometers on a wheel that turns about a level axle.
//
// Each sensor has two axes u, v in the plane of the wheel, v a quarter turn ahead of u. With φ the
// angle of u from the horizontal, r = (r_u, r_v) the sensor's lever arm in its own axes, ω and α
// speed and acceleration of the wheel, and a_h = −ρ α the axle's acceleration for a wheel that
// rolls on a radius ρ (0 on a bench),
//
//   f_u = g sin φ + a_h cos φ − ω² r_u − α r_v
//   f_v = g cos φ − a_h sin φ − ω² r_v + α r_u
//   z_u = (1 + s_u)(f_u + κ f_v) + b_u,   z_v = (1 + s_v)(f_v + κ f_u) + b_v,
//
// with biases b, scale errors s and a skew κ of the two axes. Sensor 1 has φ = θ, the wheel's
// angle; sensor 2 has φ = θ + μ.
//
// Not observable, hence no states: a common rotation of both axes of sensor 1 against the wheel's
// marks and, by accelerometers alone, ρ, since a_h shifts the apparent gravity by −ρ α / g, as a
// shift of φ does. Source:
// kinematics of a rigid body in a plane; for two opposite sensors with parallel axes, M. A. Lele
// (2010), section 4.4, with α = a_t / R.
//
// The drive torque has a ripple that depends on the angle (unbalance, bearing, gear). The state's
// angle Θ and speed Ω exclude the ripple; the wheel's own are
//
//   θ = Θ + Σ (c_n sin nΘ − s_n cos nΘ) / n,   ω = dθ/dt = Ω (1 + Σ c_n cos nΘ + s_n sin nΘ).
//
// A ripple once per turn resembles a scale error or a skew, by ω² r: without the ripple as a
// nuisance parameter, scale, skew and lever arm would appear to be observable at one speed.
//
// A sensor's filter delays the motion by τ. Rotating quantities (gravity and hub acceleration) are
// delayed by atan(ω τ) instead of ω τ and attenuated by the cosine of that (one pole). Averages of
// measurements whose times have the variance σ² attenuate rotating quantities by exp(−ω² σ²/2).
//
// The sensor's gyroscope, if any, measures (1 + s_g)(ω + Ω sin ε) + b_g about the axle, with the
// same delay. Ω is the rate at which the vehicle turns about the vertical and ε the axle's
// inclination, for example the camber of a wheelchair: turning on the spot by half a turn at 18°
// adds 1 rad to the integral. In the wheel's plane the gyroscope measures Ω cos ε along gravity's
// direction, so that Ω sin ε = tan ε (ω_u sin φ + ω_v cos φ). With a gyroscope the motion is known
// independently of gravity, and ρ is observable: it is a state then.
//
// An encoder on the axle shows ψ with d ψ = θ + o + d Σ c_n cos nψ + s_n sin nψ, n = 1 (its disc
// is off centre) and 2 (it is warped), d = ±1 its direction and o its offset; without delay.
namespace proofmass::estimate {

/// Noise parameters of the filter; estimated from the recording by tune_wheel().
struct WheelNoise {
  /// Two-sided densities of the motion noise: white jerk, rad²/s⁵, for irregular speeds, and white
  /// snap, rad²/s⁷, for smooth ones.
  double jerk_psd = 1.0, snap_psd = 0.0;
  double bias_walk_psd = 0.0;  ///< random walk of each bias, (m/s²)²/s
};

/// Orders 1 and 2 are always included, as they resemble scale, skew and bias.
using RippleOrders = std::array<int, wheel::ripple_orders>;
inline constexpr RippleOrders first_orders{1, 2, 3, 4};
inline constexpr int highest_order = 12;

/// Random walk of each part of the ripple, 1/s: a tenth of a per cent within ten seconds.
inline constexpr double ripple_walk_psd = 1e-7;
/// Random walk of a gyroscope's bias, (rad/s)²/s, and scale, 1/s: 0.06 deg/s and 0.1 % within ten
/// seconds, for its sensitivity to gravity and vibration. With more, bias and scale absorb a motion
/// that begins faster than the noise model allows: 0.24 rad/s and 1.5 % in a motor's ramp. A
/// gyroscope resolves the count and bridges disturbed intervals; against gravity it has no more
/// weight than this.
inline constexpr double gyro_bias_walk_psd = 1e-7, gyro_scale_walk_psd = 1e-7;
/// Random walk of the tangent of the axle's inclination, 1/s: half a degree within ten seconds.
inline constexpr double axle_slope_walk_psd = 1e-5;

/// A warm-up of a bias, as a fraction of its value at the end of the recording, and the prior
/// standard deviation of that value. A time constant as long as the recording resembles a ramp of
/// the speed most.
inline constexpr double warm_up_std_mps2 = 0.05;
[[nodiscard]] inline double warmed_up(double share_of_recording) {
  return std::expm1(-share_of_recording) / std::expm1(-1.0);
}

/// Result of an earlier pass, about which the measurements are linearised:
///
/// - about its constants always, but gravity about the predicted angle of the wheel: a ripple that
///   has drifted from the path's by δ would otherwise leave g δ²/2, which resembles scale errors
///   and skew;
/// - about its motion only during the first turn and where the filter's own prediction differs by
///   half a radian, which is a cycle slip.
///
/// The prediction is independent of the current measurement. A smoothed motion is not, and Jacobian
/// columns whose noise correlates with the measurements bias the fit.
struct WheelPath {
  std::vector<Mat<wheel::moving>> moving;
  Eigen::VectorXd standing;  ///< in the state's order, from wheel::first_of(0) on
};

/// The first epoch at which a path is a turn away from where it is at epoch `first`.
[[nodiscard]] std::size_t turned_after(const WheelPath& path, std::size_t first);

/// Coefficients of the lever arms at each epoch: the squared speed and the acceleration of a path,
/// each averaged over a turn. The lever arms' columns in the Jacobian are ω² and α, known only
/// through the measurements themselves. A filter that takes these noisy columns as exact overstates
/// the information, and ripple within a turn would determine a lever arm through the motion model.
/// The averages leave only the change of the mean force with speed.
using WheelLevers = std::vector<Mat<2>>;

/// A wheel whose measurements are constant for this long is static: its speed is 0 with this
/// standard deviation. On a rolling wheel, an angle that departs from rest with growing speed
/// leaves the direction of the measurements unchanged, because the hub's acceleration compensates
/// gravity's rotation.
inline constexpr double standing_stretch_s = 0.5, standing_speed_radps = 0.05;

/// Transition of a motion over t_s seconds of constant jerk.
[[nodiscard]] inline Mat<wheel::moving, wheel::moving> constant_jerk(double t_s) {
  const double t2 = t_s * t_s, t3 = t2 * t_s;
  Mat<wheel::moving, wheel::moving> F;
  // clang-format off
  F << 1, t_s, t2 / 2, t3 / 6,
       0, 1,   t_s,    t2 / 2,
       0, 0,   1,      t_s,
       0, 0,   0,      1;
  // clang-format on
  return F;
}

/// Mean acceleration of a path over 0.4 s about each epoch, from its speeds.
[[nodiscard]] std::vector<double> mean_accel_radps2(const std::vector<double>& time_s,
                                                    const std::vector<Mat<wheel::moving>>& moving);

/// A path at other, rising times: from its nearest epoch, with constant jerk.
[[nodiscard]] std::vector<Mat<wheel::moving>> moving_at(
    const std::vector<double>& time_s,
    const std::vector<double>& path_time_s,
    const std::vector<Mat<wheel::moving>>& path);

template <int Sensors>
struct WheelModel {
  static constexpr int sensors_used = Sensors;
  static constexpr int states = wheel::states(Sensors);
  static constexpr int moving = wheel::moving;
  static constexpr int channels = 3 * Sensors + 2;
  using State = Mat<states>;

  double gravity_mps2 = 0.0;      ///< its component in the plane of the wheel
  double rolling_radius_m = 0.0;  ///< ρ; 0 for a fixed axle
  double phase_rad = 0.0;         ///< of sensor 2; its state is the difference from this
  double delay_s = 0.0;           ///< τ, of both sensors' filters
  WheelNoise noise;
  const std::vector<WheelEpoch>* epochs = nullptr;
  std::array<const PlanarReadings*, 2> readings{};
  const EncoderReadings* encoder = nullptr;
  const WheelPath* about = nullptr;  ///< nullptr: the plain extended filter

  /// Number of leading epochs at which the measurements are linearised about the path. Until
  /// gravity has rotated once, angle, biases and scales are not separable, and a Jacobian at a
  /// prediction that is off by a tenth of a radian would make the filter overconfident
  /// irreversibly.
  std::size_t first_turn = 0;

  const WheelLevers* levers = nullptr;  ///< for lever arms that are estimated, with `about`

  /// The acceleration of a path averaged over each epoch's surroundings, rad/s²: the coefficient of
  /// a rolling radius that is estimated. With that of the state, whose noise correlates with the
  /// measurements, the radius of a car's wheel was 0.16 ± 0.02 m and 0.43 ± 0.05 m instead of 0.29.
  std::shared_ptr<const std::vector<double>> mean_accel;

  bool places_held = false;            ///< they have no variance and are not updated
  bool with_ripple = false;            ///< otherwise the ripple is 0
  RippleOrders orders = first_orders;  ///< of the ripple, cycles a turn
  bool with_gyro = false;
  bool sensors_stand = false;  ///< constant biases and gyroscope parameters
  /// Warm-up at the end, along u and v of each sensor, not part of its bias. It is 0 but
  /// where its effect on the other parameters is computed.
  Mat<2 * Sensors> warm_up_mps2 = Mat<2 * Sensors>::Zero();
  const std::vector<double>* time_s = nullptr;  ///< of each epoch

  [[nodiscard]] std::size_t size() const { return epochs->size(); }
  [[nodiscard]] int active() const {
    if (!places_held) return states;
    if (encoder != nullptr) return wheel::places(Sensors);
    if (with_gyro) return wheel::encoder(Sensors);
    return with_ripple ? wheel::gyro(Sensors) : wheel::ripple(Sensors);
  }

  /// The wheel's own motion, with the derivatives of angle, speed and acceleration by the state.
  struct Motion {
    double angle, speed, accel;
    State by_angle, by_speed, by_accel;
  };
  [[nodiscard]] Motion motion(const State& x) const {
    const double Theta = x(wheel::angle), Omega = x(wheel::speed), A = x(wheel::accel);
    Motion now{Theta, Omega, A, State::Zero(), State::Zero(), State::Zero()};
    now.by_angle(wheel::angle) = now.by_speed(wheel::speed) = now.by_accel(wheel::accel) = 1.0;
    if (!with_ripple) return now;
    double share = 0.0, slope = 0.0, curve = 0.0;  // Σ, and its first two derivatives by Θ
    for (std::size_t i = 0; i < orders.size(); ++i) {
      const double n = orders[i];
      const double cos_n = std::cos(n * Theta), sin_n = std::sin(n * Theta);
      const int at = wheel::ripple(Sensors) + 2 * static_cast<int>(i);
      const double c = x(at), s = x(at + 1);
      now.angle += (c * sin_n - s * cos_n) / n;
      share += c * cos_n + s * sin_n;
      slope += n * (s * cos_n - c * sin_n);
      curve -= n * n * (c * cos_n + s * sin_n);
      now.by_angle(at) = sin_n / n;
      now.by_angle(at + 1) = -cos_n / n;
      now.by_speed(at) = Omega * cos_n;
      now.by_speed(at + 1) = Omega * sin_n;
      now.by_accel(at) = A * cos_n - Omega * Omega * n * sin_n;
      now.by_accel(at + 1) = A * sin_n + Omega * Omega * n * cos_n;
    }
    now.speed = Omega * (1.0 + share);
    now.accel = A * (1.0 + share) + Omega * Omega * slope;
    now.by_angle(wheel::angle) = now.by_speed(wheel::speed) = now.by_accel(wheel::accel) =
        1.0 + share;
    now.by_speed(wheel::angle) = Omega * slope;
    now.by_accel(wheel::angle) = A * slope + Omega * Omega * curve;
    now.by_accel(wheel::speed) = 2.0 * Omega * slope;
    return now;
  }

  /// The motion τ earlier, as the sensors measure it. Otherwise speed and lever arms would be out
  /// of phase with gravity, whose phase shows the ripple; once per turn that resembles a skew.
  [[nodiscard]] Motion motion_shown(const State& x) const {
    State earlier = x;
    for (const int i : {wheel::angle, wheel::speed, wheel::accel}) earlier(i) -= delay_s * x(i + 1);
    Motion shown = motion(earlier);
    for (State* slope : {&shown.by_angle, &shown.by_speed, &shown.by_accel})
      for (const int i : {wheel::jerk, wheel::accel, wheel::speed})
        (*slope)(i) -= delay_s * (*slope)(i - 1);
    return shown;
  }

  [[nodiscard]] Transition<states, moving> transition(const State& x, std::size_t k) const {
    const double t = (*epochs)[k].dt_s, t2 = t * t, t3 = t2 * t, t4 = t2 * t2, t5 = t4 * t;
    const double t6 = t3 * t3, t7 = t4 * t3;
    Transition<states, moving> step;
    step.F = constant_jerk(t);
    // clang-format off
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
    step.Q.template topLeftCorner<3, 3>() += (noise.jerk_psd + (*epochs)[k].jerk_psd) * rough;
    step.mean = step.F * x.template head<moving>();
    step.walk.setZero();
    if (with_ripple)
      step.walk.template segment<2 * wheel::ripple_orders>(wheel::ripple(Sensors))
          .setConstant(ripple_walk_psd * t);
    if (sensors_stand) return step;
    for (int s = 0; s < Sensors; ++s)
      step.walk.template segment<2>(wheel::first_of(s)).setConstant(noise.bias_walk_psd * t);
    if (with_gyro)
      for (int s = 0; s < Sensors; ++s)
        step.walk.template segment<wheel::gyro_states>(wheel::gyro(Sensors) +
                                                       wheel::gyro_states * s)
            << gyro_bias_walk_psd * t,
            gyro_scale_walk_psd * t, axle_slope_walk_psd * t;
    if (encoder != nullptr) step.walk(wheel::encoder(Sensors)) = encoder->walk_psd * t;
    return step;
  }

  /// Whether epoch k has measurements of a sensor.
  [[nodiscard]] bool has_readings(std::size_t sensor, std::size_t k) const {
    const std::int64_t row = (*epochs)[k].row[sensor];
    return row != WheelEpoch::no_row && readings[sensor]->has(static_cast<std::size_t>(row));
  }

  /// Whether epoch k has the gyroscope measurement of a sensor.
  [[nodiscard]] bool has_speed(std::size_t sensor, std::size_t k) const {
    if (!with_gyro || readings[sensor]->speed_radps.empty()) return false;
    return !std::isnan(
        readings[sensor]->speed_radps[static_cast<std::size_t>((*epochs)[k].row[sensor])]);
  }

  /// Whether epoch k has an angle of the encoder.
  [[nodiscard]] bool has_encoder(std::size_t k) const {
    return encoder != nullptr && encoder->has(k);
  }

  void measure(const State& x, std::size_t k, Readings<states, channels>& out) const {
    out.count = out.constraints = 0;
    const State at_state = about == nullptr ? x : state_about(x, k);
    const Motion now = motion_shown(at_state);
    double ripple_rad = 0.0;  // by which the state's exceeds the path's
    if (about != nullptr && with_ripple && about_prediction(x, k)) {
      constexpr int first = wheel::ripple(Sensors), count = 2 * wheel::ripple_orders;
      ripple_rad = now.by_angle.template segment<count>(first).dot(
          (x - at_state).template segment<count>(first));
    }
    for (int s = 0; s < Sensors; ++s)
      if (has_readings(static_cast<std::size_t>(s), k))
        measure_sensor(at_state, {now, ripple_rad}, s, k, out);
    if (has_encoder(k)) read_encoder(at_state, k, out);
    if (about != nullptr)
      for (int i = 0; i < out.count; ++i) {
        auto& row = out.rows[static_cast<std::size_t>(i)];
        row.predicted += row.h.dot(x - at_state);
      }
    if ((*epochs)[k].stands && (*epochs)[k].dt_s > 0.0) read_standing(x, k, out);
  }

  /// Covariance reset of the motion, not of the sensors' constants: called after the gate has
  /// rejected everything for a while. Restarts from the path if there is one.
  void reopen(Gaussian<states>& x, std::size_t k) const {
    if (about != nullptr) x.mean.template head<moving>() = about->moving[k];
    const Mat<moving> open(1.0, 100.0, 100.0, 100.0);  // (1 rad)², (10 rad/s)², …
    for (int i = 0; i < moving; ++i) {
      x.cov.row(i).setZero();
      x.cov.col(i).setZero();
      x.cov(i, i) = open(i);
    }
  }

 private:
  /// Whether the measurements are linearised about a predicted motion, not the path's. About
  /// predictions that swing, as on a road or in pushes of a hand, g δ²/2 would become biases and
  /// scales: 0.4 m/s² at δ = 0.3 rad. A gyroscope or an encoder keeps predictions from swinging,
  /// and its errors at first make the path's worse.
  [[nodiscard]] bool about_prediction(const State& x, std::size_t k) const {
    const double far_rad = with_gyro || encoder != nullptr ? 0.5 : 0.1;
    const bool far = std::abs(x(wheel::angle) - about->moving[k](wheel::angle)) > far_rad;
    // Lever arms that are estimated would at first outweigh gravity, and rotate the angle.
    return k >= first_turn && !far && levers == nullptr;
  }

  [[nodiscard]] State state_about(const State& x, std::size_t k) const {
    State at = x;
    if (!about_prediction(x, k)) at.template head<moving>() = about->moving[k];
    at.template tail<wheel::standing(Sensors)>() = about->standing;
    if (places_held) at.template tail<2 * Sensors>() = x.template tail<2 * Sensors>();
    return at;
  }

  /// One zero-speed measurement in each standing_stretch_s, distributed over time.
  void read_standing(const State& x, std::size_t k, Readings<states, channels>& out) const {
    out.constraints = 1;
    auto& row = out.rows[static_cast<std::size_t>(out.count++)];
    row.h.setZero();
    row.h(wheel::speed) = 1.0;
    row.predicted = x(wheel::speed);
    row.value = 0.0;
    row.variance =
        square(standing_speed_radps) * std::max(1.0, standing_stretch_s / (*epochs)[k].dt_s);
  }

  void read_gyro(const State& x,
                 const Motion& now,
                 int s,
                 std::size_t at_row,
                 Readings<states, channels>& out) const {
    const int at = wheel::gyro(Sensors) + wheel::gyro_states * s;
    const PlanarReadings& sensor = *readings[static_cast<std::size_t>(s)];
    const double phi = now.angle + (s > 0 ? phase_rad + x(wheel::phase) : 0.0);
    const double sin_phi = std::sin(phi), cos_phi = std::cos(phi);
    const double rate_u = sensor.rate_u_radps[at_row], rate_v = sensor.rate_v_radps[at_row];
    const double vehicle = rate_u * sin_phi + rate_v * cos_phi;
    const double gain = 1.0 + x(at + wheel::gyro_scale), slope = x(at + wheel::gyro_tilt);
    const double by_phi = slope * (rate_u * cos_phi - rate_v * sin_phi);
    const double rate = now.speed + slope * vehicle;
    auto& row = out.rows[static_cast<std::size_t>(out.count++)];
    row.h = gain * (now.by_speed + by_phi * now.by_angle);
    if (s > 0) row.h(wheel::phase) += gain * by_phi;
    row.h(at + wheel::gyro_bias) = 1.0;
    row.h(at + wheel::gyro_scale) = rate;
    row.h(at + wheel::gyro_tilt) = gain * vehicle;
    row.predicted = gain * rate + x(at + wheel::gyro_bias);
  }

  /// The errors are those at the measured angle, which makes them linear in the state.
  void read_encoder(const State& x, std::size_t k, Readings<states, channels>& out) const {
    constexpr int at = wheel::encoder(Sensors);
    const double psi = encoder->angle_rad[k], age_s = encoder->age_s[k];
    const Motion now = motion(x);
    auto& row = out.rows[static_cast<std::size_t>(out.count++)];
    row.h = now.by_angle - age_s * now.by_speed + 0.5 * age_s * age_s * now.by_accel;
    row.predicted = now.angle - age_s * now.speed + 0.5 * age_s * age_s * now.accel + x(at);
    row.h(at) = 1.0;
    for (int n = 1; n <= wheel::encoder_orders; ++n) {
      const double c = encoder->direction * std::cos(n * psi);
      const double s = encoder->direction * std::sin(n * psi);
      row.h(at + 2 * n - 1) = c;
      row.h(at + 2 * n) = s;
      row.predicted += c * x(at + 2 * n - 1) + s * x(at + 2 * n);
    }
    row.value = encoder->direction * psi - encoder->zero_rad;
    row.variance = encoder->variance_rad2[k] + encoder->more.variance_rad2(now.speed);
  }

  /// Gravity is at the angle of `now` plus ripple_rad, less the linear term of this that the
  /// difference of the ripple states adds.
  struct Rippled {
    const Motion& now;
    double ripple_rad;
  };

  /// The accelerometer and the gyroscope of a sensor that has measurements at epoch k.
  void measure_sensor(const State& x,
                      const Rippled& shown,
                      int s,
                      std::size_t k,
                      Readings<states, channels>& out) const {
    const auto index = static_cast<std::size_t>(s);
    const PlanarReadings& sensor = *readings[index];
    const auto at = static_cast<std::size_t>((*epochs)[k].row[index]);
    const auto first = static_cast<std::size_t>(out.count);
    read_sensor(x, shown, s, k, out);
    auto& u = out.rows[first];
    auto& v = out.rows[first + 1];
    u.value = sensor.u_mps2[at];
    v.value = sensor.v_mps2[at];
    u.variance = v.variance = sensor.variance_m2ps4[at];
    if (!warm_up_mps2.isZero()) {
      const double share =
          warmed_up(((*time_s)[k] - time_s->front()) / (time_s->back() - time_s->front()));
      u.value -= share * warm_up_mps2(2 * s);
      v.value -= share * warm_up_mps2(2 * s + 1);
    }
    if (!has_speed(index, k)) return;
    read_gyro(x, shown.now, s, at, out);
    auto& speed = out.rows[first + 2];
    speed.value = sensor.speed_radps[at];
    speed.variance = sensor.speed_variance;
  }

  void read_sensor(const State& x,
                   const Rippled& shown_motion,
                   int s,
                   std::size_t k,
                   Readings<states, channels>& out) const {
    const auto& [now, ripple_rad] = shown_motion;
    const Mat<2> lever =
        levers == nullptr ? Mat<2>(now.speed * now.speed, now.accel) : (*levers)[k];
    const double hub_accel = mean_accel == nullptr ? now.accel : (*mean_accel)[k];
    const double spread_s2 = (*epochs)[k].spread_s2;
    const int at = wheel::first_of(s);
    const double w = now.speed, al = now.accel, late = w * delay_s;
    const double weaker2 = 1.0 / (1.0 + late * late), weaker = std::sqrt(weaker2);
    const double phi = now.angle + ripple_rad + (s > 0 ? phase_rad + x(wheel::phase) : 0.0) + late -
                       std::atan(late);
    const double sin_phi = std::sin(phi), cos_phi = std::cos(phi);
    const int place = wheel::places(Sensors) + 2 * s;
    const double ru = x(place), rv = x(place + 1);
    const double shown = weaker * std::exp(-0.5 * w * w * spread_s2);
    const double rho = rolling_radius_m + x(wheel::rolling(Sensors));
    const double g = shown * gravity_mps2, hub = -shown * rho * al;
    // Forces and their derivatives in the sensor's true axes.
    const double turn_u = g * cos_phi - hub * sin_phi;   // ∂f_u/∂φ
    const double turn_v = -g * sin_phi - hub * cos_phi;  // ∂f_v/∂φ
    const double fu = -turn_v - w * w * ru - al * rv;
    const double fv = turn_u - w * w * rv + al * ru;
    // By the speed: through the centripetal force, and through the rotating force, which is less
    // delayed and attenuated.
    const double sooner = delay_s * (1.0 - weaker2);
    const double fade = late * delay_s * weaker2 + w * spread_s2;
    const double by_w_u = -2.0 * w * ru + sooner * turn_u + fade * turn_v;
    const double by_w_v = -2.0 * w * rv + sooner * turn_v - fade * turn_u;
    const double by_al_u = -rv - shown * rho * cos_phi;
    const double by_al_v = ru + shown * rho * sin_phi;
    // Through scale and skew to the measurement.
    const double su = 1.0 + x(at + wheel::scale), sv = 1.0 + x(at + wheel::scale + 1);
    const double skew = x(at + wheel::skew);
    auto& u = out.rows[static_cast<std::size_t>(out.count++)];
    auto& v = out.rows[static_cast<std::size_t>(out.count++)];
    u.h.setZero();
    v.h.setZero();
    const auto take = [&](const auto& part, const auto& du, const auto& dv) {
      part(u.h) = su * (du + skew * dv);
      part(v.h) = sv * (dv + skew * du);
    };
    const auto by_motion = [&](const auto& part) {
      take(
          part,
          (turn_u * part(now.by_angle) + by_w_u * part(now.by_speed) + by_al_u * part(now.by_accel))
              .eval(),
          (turn_v * part(now.by_angle) + by_w_v * part(now.by_speed) + by_al_v * part(now.by_accel))
              .eval());
    };
    by_motion([](auto& h) { return h.template head<moving>(); });
    if (with_ripple)
      by_motion([](auto& h) {
        return h.template segment<2 * wheel::ripple_orders>(wheel::ripple(Sensors));
      });
    if (s > 0)
      take([](auto& h) { return h.template segment<1>(wheel::phase); }, Mat<1>(turn_u),
           Mat<1>(turn_v));
    take([](auto& h) { return h.template segment<1>(wheel::rolling(Sensors)); },
         Mat<1>(-shown * hub_accel * cos_phi), Mat<1>(shown * hub_accel * sin_phi));
    take([place](auto& h) { return h.template segment<2>(place); }, Mat<2>(-lever(0), -lever(1)),
         Mat<2>(lever(1), -lever(0)));
    u.h(at + wheel::scale) = fu + skew * fv;
    v.h(at + wheel::scale + 1) = fv + skew * fu;
    u.h(at + wheel::skew) = su * fv;
    v.h(at + wheel::skew) = sv * fu;
    u.h(at + wheel::bias) = v.h(at + wheel::bias + 1) = 1.0;
    const double eu = fu - turn_u * ripple_rad, ev = fv - turn_v * ripple_rad;
    u.predicted = su * (eu + skew * ev) + x(at + wheel::bias);
    v.predicted = sv * (ev + skew * eu) + x(at + wheel::bias + 1);
  }
};

// One epoch of the filter and of the smoother, compiled once, in wheel/model.cpp.
extern template void advance_in_place(const WheelModel<1>&,
                                      std::size_t,
                                      const Gate&,
                                      FilterStateAt<wheel::states(1)>,
                                      StepOf<WheelModel<1>>&);
extern template void advance_in_place(const WheelModel<2>&,
                                      std::size_t,
                                      const Gate&,
                                      FilterStateAt<wheel::states(2)>,
                                      StepOf<WheelModel<2>>&);
extern template void look_back(BackwardInformation<wheel::states(1)>&,
                               const StepOf<WheelModel<1>>&);
extern template void look_back(BackwardInformation<wheel::states(2)>&,
                               const StepOf<WheelModel<2>>&);

}  // namespace proofmass::estimate
