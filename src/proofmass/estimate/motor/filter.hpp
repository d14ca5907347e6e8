#pragma once

#include <Eigen/Core>
#include <vector>

#include "proofmass/estimate/motor/model.hpp"
#include "proofmass/estimate/motor/series.hpp"

namespace proofmass::estimate::motor {

/// Innovations and their variances: angle and current of each sample in turn; variance 0 where
/// there is none.
struct Innovations {
  std::vector<double> value, variance;
  /// Σ e²/S + ln S.
  [[nodiscard]] double cost() const;
};

/// Smoothed motor angle and speed with the standard deviation of the speed.
struct Smoothed {
  std::vector<double> angle_rad, speed_radps, speed_std_radps, current_a;
};

/// The Kalman filter of the drive at these parameters and regimes.
void filter(const Series& series, const Regimes& regimes, const Parameters& p, Innovations& out);

/// The same with a backward pass of Bryson and Frazier.
[[nodiscard]] Smoothed smooth(const Series& series, const Regimes& regimes, const Parameters& p);

/// Error of the measured angle that does not depend on the flank: once and twice per turn, and of a
/// sensor's distance from the axle.
[[nodiscard]] double angle_error(const Series& series,
                                 const Regimes& regimes,
                                 const Parameters& p,
                                 std::size_t k);

/// What acts between samples k and k + 1.
struct Inputs {
  double voltage_v, torque_nm;
};
[[nodiscard]] Inputs inputs(const Series& series,
                            const Regimes& regimes,
                            const Parameters& p,
                            std::size_t k);

/// Transitions of the three regimes.
struct Transitions {
  Transition moves;
  Transition rests;   ///< the load rests; the motor does, too, or crosses the gap
  Transition floats;  ///< the contact is not certain, hence the load's torque is open
};
[[nodiscard]] Transitions transitions(const Series& series,
                                      const Regimes& regimes,
                                      const Parameters& p);

/// Mean and covariance of the states.
struct State {
  Eigen::Vector4d x;
  Eigen::Matrix4d P;
};
[[nodiscard]] State first_state(const Series& series, const Regimes& regimes);
void advance(const Transition& step, const Inputs& in, State& state);

}  // namespace proofmass::estimate::motor
