#pragma once

#include <Eigen/Core>
#include <array>

#include "proofmass/servo/loop/observer.hpp"

namespace proofmass::servo_comparison {

/// The other way to treat backlash: a bank of three Kalman filters, one for each contact of the
/// gear (backwards, none, forwards), whose estimates are mixed by their probabilities. A contact is
/// left when the motor reverses, and reached when the play is at its end; both probabilities are
/// those of the filters' states. States and noise as of servo::MotorObserver; in a contact the play
/// is known, in the gap the load is at rest. Source: H. A. P. Blom, Y. Bar-Shalom, The interacting
/// multiple model algorithm for systems with Markovian switching coefficients, IEEE Trans.
/// Automatic Control 33 (1988) 780.
class ContactBank {
 public:
  explicit ContactBank(const servo::MotorObserverOptions& options);

  void predict(double voltage_v);
  void update(const servo::MotorSample& sample);
  /// Mean and spread of the mixture.
  [[nodiscard]] Uncertain load_rad() const;

 private:
  static constexpr int states = 7;
  static constexpr std::size_t modes = 3;
  using State = Eigen::Matrix<double, states, 1>;
  using Covariance = Eigen::Matrix<double, states, states>;
  struct Mode {
    State x = State::Zero();
    Covariance P = Covariance::Zero();
    double probability = 1.0 / 3.0;
  };

  void advance(double voltage_v, std::size_t which);
  void mix();
  [[nodiscard]] double correct(const servo::MotorSample& sample, Mode& mode) const;
  [[nodiscard]] double end_of(std::size_t which) const;

  servo::MotorObserverOptions options_;
  double half_rad_;
  std::array<Mode, modes> modes_{};
};

}  // namespace proofmass::servo_comparison
