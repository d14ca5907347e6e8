#pragma once

#include <vector>

#include "proofmass/estimate/attitude/series.hpp"
#include "proofmass/estimate/filter/smoother.hpp"

// The error-state model used by estimate_attitude().
namespace proofmass::estimate {

/// Indices of each error in the state; three entries each.
namespace inertial {
inline constexpr int attitude = 0, velocity = 3, position = 6, rate_bias = 9, accel_bias = 12;
inline constexpr int states = 15;
}  // namespace inertial

using InertialError = Mat<inertial::states>;

/// The motion to which the errors are relative.
struct NominalState {
  Mat<3, 3> R = Mat<3, 3>::Identity();  ///< R_world_sensor
  Mat<3> v = Mat<3>::Zero(), p = Mat<3>::Zero();
  Mat<3> rate_bias = Mat<3>::Zero(), accel_bias = Mat<3>::Zero();

  /// exp(δθ×) R, v + δv, …
  void move_by(const InertialError& error);
  /// The argument of move_by() that leads from `from` to this state.
  [[nodiscard]] InertialError less(const NominalState& from) const;
};

/// Errors about a nominal motion, one epoch a sample, as a linear model of filter/smoother.hpp.
class AttitudeModel {
 public:
  static constexpr int states = inertial::states, moving = states, channels = 10;

  AttitudeModel(const PreparedSeries& series, const AttitudeOptions& options);

  /// Nominal motion, one entry a sample; the filter estimates errors about it.
  std::vector<NominalState> nominal;
  /// By index of the rest: 0 if it is not used.
  std::vector<unsigned char> rest_used;

  [[nodiscard]] std::size_t size() const { return series_->samples.size(); }
  [[nodiscard]] const PreparedSeries& series() const { return *series_; }
  [[nodiscard]] bool at_rest(std::size_t k) const;

  /// The start of the stretch at k: a level attitude of heading 0.
  [[nodiscard]] NominalState start(std::size_t k) const;
  /// The motion at sample k from that at k − 1, without noise.
  [[nodiscard]] NominalState moved(const NominalState& before, std::size_t k) const;
  /// Prior at the first sample, about the nominal motion.
  [[nodiscard]] Gaussian<states> prior() const;

  [[nodiscard]] Transition<states, states> transition(const InertialError& x, std::size_t k) const;
  void measure(const InertialError& x, std::size_t k, Readings<states, channels>& out) const;
  void reopen(Gaussian<states>&, std::size_t) const {}
  /// Number of measurements at sample k from the sensors, without the bounds of the velocity.
  [[nodiscard]] int sensor_readings(std::size_t k) const { return at_rest(k) ? 6 : 0; }

 private:
  [[nodiscard]] bool stays(std::size_t k) const;
  [[nodiscard]] Mat<states, states> start_cov(std::size_t k) const;
  void add_position(std::size_t k, Readings<states, channels>& out) const;
  void add_rest(std::size_t k, Readings<states, channels>& out) const;
  void add_motion(std::size_t k, Transition<states, states>& step) const;

  const PreparedSeries* series_;
  AttitudeOptions options_;
  std::vector<unsigned char> bounds_speed_;  ///< by sample
  std::vector<std::size_t> reading_of_;      ///< by sample: 1 + index of its position, 0 none
  double gravity_variance_ = 0.0;            ///< of one sample, of the part common to all rests
};

}  // namespace proofmass::estimate
