#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "proofmass/core/view.hpp"
#include "proofmass/estimate/filter/smoother.hpp"
#include "proofmass/estimate/models/bias_models.hpp"
#include "proofmass/estimate/motion_models.hpp"

// Motion along one axis, from rest to rest, with the accelerometers as measurements.
//
//     moving   p' = v,   v' = a − l,   a' = j       j white of density q, l of density L
//     at rest  p' = 0,   v = 0,   a = 0
//     always   z_i = a + c + b_i + n_i
//
// - b_i is the bias of sensor i, a random walk or settling exponentially.
// - c is the error common to all sensors in motion, such as the component of gravity along the
//   axis: a random walk in motion, with a jump at the beginning and the end of one; it does not
//   settle with a warm-up.
// - l is the part of a that is rocking instead of acceleration.
//
// Between two samples a is linear, since the sensor's own filter leaves little else:
//
//     a ← a + w,   v ← v + h a + h w/2,   p ← p + h v + h² a/2 + h² w/6,   w of variance q h.
//
// Continuous white jerk would add q h³/12 to the variance of v in each step, as much as the
// measurement noise in a smooth motion, and no additional sensor could reduce it. It is added over
// a step longer than `longest_step_s`.
namespace proofmass::estimate {

/// One accelerometer along the axis, minus its level at the first rest.
struct PvaSensor {
  View<double> accel_mps2;      ///< NaN where missing
  double variance_m2ps4 = 1.0;  ///< of one measurement, positive
  double walk_m2ps5 = 0.0;      ///< density of the noise that drives the bias
  /// Time constant of the bias; absent: random walk.
  std::optional<double> warm_up_time_s = std::nullopt;
};

/// Constraints at one sample and during the step to it; NaN without a measurement.
struct PvaSample {
  bool resting = false;  ///< during the step, and at the sample
  bool arrives = false;  ///< at a rest, from motion
  bool jumps = false;    ///< c jumps during the step
  /// Density of the jerk in addition to q: where measurements of all sensors are missing.
  double missing_jerk_m2ps5 = 0.0;
  double velocity_std_mps = std::numeric_limits<double>::quiet_NaN();  ///< of the measurement v = 0
  double position_m = std::numeric_limits<double>::quiet_NaN();
  double position_variance = 0.0, position_after_s = 0.0;  ///< the position then
};

struct PvaNoise {
  double jerk_psd_m2ps5 = 1.0;
  double lean_m2ps3 = 0.0;         ///< L
  double common_walk_m2ps5 = 0.0;  ///< of c, in motion
  double jump_m2ps4 = 0.0;         ///< variance of one jump of c
  double rest_speed_std_mps = 1e-3;
};

/// Up to S sensors; the others have no measurements.
template <int S>
class PvaAxis {
 public:
  static constexpr int common = 3;      ///< index of c
  static constexpr int first_bias = 4;  ///< index of b_1
  static constexpr int states = first_bias + S, moving = states, channels = S + 2;
  static constexpr int velocity_channel = S, position_channel = S + 1;
  using State = Mat<states>;

  PvaAxis(View<double> time_s, std::vector<PvaSensor> sensors, View<PvaSample> samples)
      : time_s_(time_s), sensors_(std::move(sensors)), samples_(samples) {}

  PvaNoise noise{};
  double longest_step_s = std::numeric_limits<double>::infinity();

  [[nodiscard]] std::size_t size() const { return time_s_.size(); }
  [[nodiscard]] std::size_t sensors() const { return sensors_.size(); }
  [[nodiscard]] double time_s(std::size_t k) const { return time_s_[k]; }
  [[nodiscard]] const PvaSample& sample(std::size_t k) const { return samples_[k]; }
  /// Whether the first sensor has a measurement at sample k.
  [[nodiscard]] bool reads(std::size_t k) const { return !std::isnan(sensors_[0].accel_mps2[k]); }

  [[nodiscard]] Transition<states, states> transition(const State& x, std::size_t k) const {
    const double h = time_s_[k] - time_s_[k - 1];
    Transition<states, states> step;
    step.F.setIdentity();
    step.Q.setZero();
    step.walk.setZero();
    if (samples_[k].resting) {
      step.F(pva::velocity_mps, pva::velocity_mps) = step.F(pva::accel_mps2, pva::accel_mps2) = 0.0;
      step.Q(pva::velocity_mps, pva::velocity_mps) =
          noise.rest_speed_std_mps * noise.rest_speed_std_mps;
    } else {
      move(h, noise.jerk_psd_m2ps5 + samples_[k].missing_jerk_m2ps5, step);
    }
    if (samples_[k].jumps) step.Q(common, common) += noise.jump_m2ps4;
    for (int i = 0; i < static_cast<int>(sensors_.size()); ++i) {
      const PvaSensor& sensor = sensors_[static_cast<std::size_t>(i)];
      const BiasStep bias = sensor.warm_up_time_s
                                ? bias_step({h, *sensor.warm_up_time_s, sensor.walk_m2ps5})
                                : random_walk_step({h, sensor.walk_m2ps5});
      const int at = first_bias + i;
      step.F(at, at) = bias.phi;
      step.Q(at, at) += bias.variance_m2ps4;
    }
    step.mean = step.F * x;
    return step;
  }

  void measure(const State& x, std::size_t k, Readings<states, channels>& out) const {
    out.count = 0;
    const auto add = [&](double value, double variance, const State& h) {
      out.rows[static_cast<std::size_t>(out.count++)] = {value, h.dot(x), variance, h};
    };
    for (std::size_t i = 0; i < sensors_.size(); ++i) {
      if (std::isnan(sensors_[i].accel_mps2[k])) continue;
      State h = State::Unit(pva::accel_mps2);
      h(common) = h(first_bias + static_cast<int>(i)) = 1.0;
      add(sensors_[i].accel_mps2[k], sensors_[i].variance_m2ps4, h);
    }
    const PvaSample& sample = samples_[k];
    if (sample.velocity_std_mps > 0.0)
      add(0.0, sample.velocity_std_mps * sample.velocity_std_mps, State::Unit(pva::velocity_mps));
    if (std::isnan(sample.position_m)) return;
    State h = State::Unit(pva::position_m);
    const double t = sample.position_after_s;
    h(pva::velocity_mps) = t;
    h(pva::accel_mps2) = 0.5 * t * t;
    add(sample.position_m, sample.position_variance, h);
  }

  /// Channel of the i-th measurement of sample k.
  [[nodiscard]] int channel_of(std::size_t k, int i) const {
    for (std::size_t s = 0; s < sensors_.size(); ++s)
      if (!std::isnan(sensors_[s].accel_mps2[k]) && i-- == 0) return static_cast<int>(s);
    return samples_[k].velocity_std_mps > 0.0 && i == 0 ? velocity_channel : position_channel;
  }

  void reopen(Gaussian<states>&, std::size_t) const {}

  /// Prior at the first sample: p = 0, all else nearly unknown; c is relative to this sample.
  [[nodiscard]] FilterState<states> start(double speed_std_mps) const {
    constexpr double accel_std = 10.0;
    FilterState<states> state;
    state.x.mean.setZero();
    state.x.cov.setZero();
    state.x.cov(1, 1) = speed_std_mps * speed_std_mps;
    state.x.cov(2, 2) = accel_std * accel_std;
    for (int i = first_bias; i < states; ++i) state.x.cov(i, i) = accel_std * accel_std;
    return state;
  }

 private:
  void move(double h, double jerk_psd_m2ps5, Transition<states, states>& step) const {
    const LinearModel<3, 1> motion = pva_model({h, jerk_psd_m2ps5, 1.0});
    const double L = noise.lean_m2ps3;
    step.F.template topLeftCorner<3, 3>() = motion.F;
    if (h > longest_step_s) {
      step.Q.template topLeftCorner<3, 3>() = motion.Q;
    } else {
      const Mat<3> straight(h * h / 6.0, h / 2.0, 1.0);
      step.Q.template topLeftCorner<3, 3>() = jerk_psd_m2ps5 * h * straight * straight.transpose();
    }
    step.Q(0, 0) += L * h * h * h / 3.0;
    step.Q(0, 1) += L * h * h / 2.0;
    step.Q(1, 0) += L * h * h / 2.0;
    step.Q(1, 1) += L * h;
    step.Q(common, common) += noise.common_walk_m2ps5 * h;
  }

  View<double> time_s_;
  std::vector<PvaSensor> sensors_;
  View<PvaSample> samples_;
};

}  // namespace proofmass::estimate
