#pragma once

#include <limits>
#include <utility>
#include <vector>

#include "proofmass/estimate/wheel/fit.hpp"

// An accelerometer on a wheel compared with an encoder on its axle: their common unknowns, before
// any filter.
namespace proofmass::estimate {

/// Angle, speed, acceleration, the speed without noise, and jerk. The last two and the acceleration
/// are changes of angle, speed and acceleration over a quarter of a turn, at most a second: as
/// regressors, noise in them would bias their coefficients, and at one speed show a delay that
/// cannot be known there.
using EncoderMotion = Mat<5>;

/// The encoder's motion, an age before the epochs; outside its fixes, at rest.
[[nodiscard]] std::vector<EncoderMotion> motion_of(const signal::AngleFixes& fixes,
                                                   std::vector<double> time_s,
                                                   double age_s);

/// Largest less smallest angle.
[[nodiscard]] double range_of(const std::vector<EncoderMotion>& motion);

/// Whether the speed changes little within a twelfth of a turn, half of what signal::motion_at()
/// fits at once.
[[nodiscard]] bool is_steady(const EncoderMotion& at);

/// Whether nine tenths of the steady rotation are within 5 % of each other in speed.
[[nodiscard]] bool has_one_speed(const std::vector<EncoderMotion>& motion);

/// Least squares of a sensor's two axes on the encoder's motion: each is a sin ψ' + b cos ψ' + c ω²
/// + d α + e, for ψ' = ψ − ρ α / g − Σ c_n cos nψ + s_n sin nψ, n up to 4, all a delay τ before the
/// measurement. By Gauss–Newton, one step a round. Standard deviations are those of the jackknife
/// over turns: delay and radius often show in a few turns only, those of a start or a stop. Source:
/// B. Efron, C. Stein, Ann. Statist. 9 (1981) 586.
class GravityFit {
 public:
  static constexpr int orders = 4, linear = 5;
  /// Indices of the parameters, after those of both axes.
  static constexpr int delay = 2 * linear, radius = delay + 1, errors = radius + 1;
  static constexpr int count = errors + 2 * orders;
  using Row = Mat<count>;

  /// At one speed only noise of the encoder would seem to show lever arm, delay and radius; they
  /// stay at zero and at the prior, and the lever arm's force is part of e.
  GravityFit(const Uncertain& delay_s,
             const EncoderErrors& errors_rad,
             bool one_speed,
             double gravity_mps2);

  /// The fixes without the encoder's errors, of which even one of 1 % once a turn would change ω² r
  /// in step with gravity.
  [[nodiscard]] signal::AngleFixes corrected(signal::AngleFixes fixes) const;

  /// `motion`: by the corrected fixes, at the measurements' times less the delay. Cost:
  /// O(measurements), and a matrix inverse for each turn, of 200 at most.
  void step(const WheelReadings& readings, const std::vector<EncoderMotion>& motion);

  /// The largest change of a parameter in the last step, in standard deviations.
  [[nodiscard]] double last_move() const { return last_move_; }

  /// Measurement less its model, along u and v, and the model's derivatives.
  struct Residual {
    Mat<2> off, by_rotation;  ///< by ψ
    Mat<count, 2> by_parameters;
  };
  [[nodiscard]] Residual residual_of(const Mat<2>& reading, const EncoderMotion& motion) const;

  /// f(epoch, measurement) for each measurement of the sensor in steady rotation.
  template <class Function>
  static void for_each_reading(const WheelReadings& readings,
                               const std::vector<EncoderMotion>& motion,
                               const Function& f) {
    for (std::size_t k = 0; k < readings.epochs.size(); ++k) {
      const std::int64_t row = readings.epochs[k].row[0];
      if (row == WheelEpoch::no_row || !is_steady(motion[k])) continue;
      const auto at = static_cast<std::size_t>(row);
      if (readings.sensors[0].has(at))
        f(k, Mat<2>(readings.sensors[0].u_mps2[at], readings.sensors[0].v_mps2[at]));
    }
  }

  [[nodiscard]] Uncertain figure(int at) const { return {at_(at), std_(at)}; }
  [[nodiscard]] double variance_m2ps4() const { return variance_; }
  [[nodiscard]] double lost() const { return lost_; }  ///< see LostShare

 private:
  double gravity_mps2_, variance_ = 1.0, lost_ = 1.0;
  Row prior_ = Row::Zero(), prior_std_, at_, std_ = Row::Zero();
  double last_move_ = std::numeric_limits<double>::infinity();
};

}  // namespace proofmass::estimate
