#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "proofmass/estimate/filter/smoother.hpp"
#include "proofmass/estimate/tilt.hpp"

// The moving base as filter/smoother.hpp's StateSpaceModel.
namespace proofmass::estimate {

/// Filter input for a stretch of a recording: what does not depend on the noise parameters.
struct TiltEpochs {
  std::vector<double> step_s;         ///< to this epoch from the previous one; 0 at the first
  std::vector<Mat<3>> force_mps2;     ///< NaN where missing
  std::vector<Mat<3>> rate_radps;     ///< mean over the step to it; NaN: unknown; empty: no gyro
  std::vector<Mat<3>> rate_at_radps;  ///< at the epoch itself, for rests
  std::vector<unsigned char> resting;
  std::vector<Mat<3, 3>> accel_cov_m2ps4;  ///< of the base's acceleration: base_accel()
};

/// Parameters that do not come from the likelihood.
struct TiltKnown {
  double gravity_mps2 = standard_gravity_mps2;  ///< G
  double gravity_std_mps2 = 0.0;
  double norm_std_mps2 = 0.02;                          ///< of the norm of a measurement at rest
  Mat<3> rest_std_mps2 = Mat<3>::Constant(1e-3);        ///< of a measurement at rest
  Mat<3> rest_rate_std_radps = Mat<3>::Constant(1e-3);  ///< of the gyroscope's at rest
  double rate_bias_std_radps = 0.1, rate_bias_walk_radps_rts = 2e-5;
  std::optional<double> rate_noise_radps_rthz{};  ///< if a rest shows it
  double rate_scale_std = 0.01;                   ///< relative error of a rotation
  double usual_rate_radps = 1.0;  ///< assumed rate of rotation without a measurement
};

/// States: g in m/s² (0–2); a, acceleration of the base (3–5); then with gyroscope its bias b in
/// rad/s, without it ġ in m/s³ (6–8). Measurements: f on up to three axes, then at rests the
/// gyroscope's bias. Only the noise model keeps |g| = G: a norm constraint as a measurement at
/// every epoch, linearised about a different direction each time, would add false information on
/// the direction.
///
///     g' = R g,   R = exp(−[(ω − b) Δ]×),   ∂g'/∂b = −Δ [g']×,   Q_g = (N² Δ + s² |ω|² Δ T) (|g|²
///     1 − g gᵀ)
///
/// with s the gyroscope's relative error over rotations of T = 0.5 s (tilt/gyroscope.hpp), and
/// without gyroscope R of the great circle, ω = ġ × g / |g|²,
///
///     g' = R (g + …),  ġ' = R ġ,   ∂g'/∂ġ = Δ R,   Q of white angular acceleration across g.
class TiltModel {
 public:
  static constexpr int states = 9, moving = 9, channels = 6;

  TiltModel(const TiltEpochs& epochs, const TiltKnown& known, const TiltMotion& motion);

  [[nodiscard]] std::size_t size() const { return epochs_.step_s.size(); }
  [[nodiscard]] Transition<9, 9> transition(const Mat<9>& x, std::size_t k) const;
  void measure(const Mat<9>& x, std::size_t k, Readings<9, 6>& out) const;
  void reopen(Gaussian<9>& x, std::size_t) const;

  /// Prior before the first measurement, linearised about the direction of the first, or about
  /// another.
  [[nodiscard]] FilterState<9> start() const;
  [[nodiscard]] FilterState<9> start_about(const Mat<3>& g) const;
  /// Measurements of the accelerometer at an epoch; they come first.
  [[nodiscard]] int accel_readings(std::size_t k) const;

  /// From now on, states to linearise about are smoothed ones. Without gyroscope the exact Jacobian
  /// of the great circle is used for these: its terms in ġ, taken at a filter's noisy ġ, would add
  /// false information.
  void linearise_about_smoothed() { about_smoothed_ = true; }

 private:
  /// Both return the rotation R.
  Mat<3, 3> turn_by_gyroscope(const Mat<9>& x, std::size_t k, Transition<9, 9>& step) const;
  Mat<3, 3> turn_freely(const Mat<9>& x, std::size_t k, Transition<9, 9>& step) const;

  const TiltEpochs& epochs_;
  TiltKnown known_;
  TiltMotion motion_;
  bool about_smoothed_ = false;
};

}  // namespace proofmass::estimate
