#pragma once

#include <array>
#include <cstddef>

#include "proofmass/core/quantity.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/sensor/sensor_model.hpp"

// The warm-up of a bias as what it is to an estimator: a known input.
namespace proofmass::sensor {

/// The bias of one axis, t since switching on:
///
///     b(t) = a2 + a1 (1 − e^(−t/T)),     ḃ = (a1 + a2 − b)/T,  b(0) = a2.
///
/// Source: M. A. Lele (2010), section 4.3.
struct WarmUp {
  double a1_mps2 = 0.0;
  double a2_mps2 = 0.0;
  double time_constant_s = 1.0;                       ///< T, positive
  std::array<std::array<double, 3>, 3> covariance{};  ///< of a1, a2, T, in SI

  /// a1 + a2: what the bias settles at, and the known input of its differential equation.
  [[nodiscard]] double settled_mps2() const { return a1_mps2 + a2_mps2; }
};

/// The warm-up of axis 0, 1 or 2. A sensor file holds standard deviations and no correlations, so
/// the covariance is diagonal, and 0 where a figure has no std. A fit that has not seen several T
/// leaves a1 and T correlated, and the std of the bias is then a rough one.
/// Errors: invalid_argument (a1, a2 or T is missing, T is not positive; the message names the
/// figure).
[[nodiscard]] Result<WarmUp> warm_up_of(const DriftModel& drift, std::size_t axis);

/// b(t) and the standard deviation that a1, a2 and T leave in it, to first order; t ≥ 0.
[[nodiscard]] Uncertain bias_at(const WarmUp& warm_up, double since_switch_on_s);

/// A stretch of time since switching on, 0 ≤ from ≤ to.
struct OnTime {
  double from_s = 0.0, to_s = 0.0;
};

/// Mean of b over the stretch, as an average over it reads; b itself where it has no length.
[[nodiscard]] Uncertain mean_bias(const WarmUp& warm_up, const OnTime& stretch);

struct SettlingOptions {
  double dt_s;             ///< ≥ 0
  double time_constant_s;  ///< > 0
};

/// What a step of time does to anything that settles exponentially, exactly for any dt.
struct SettlingStep {
  double phi;      ///< e^(−dt/T)
  double settled;  ///< 1 − φ, to full precision where dt is short
};
[[nodiscard]] SettlingStep settling_step(const SettlingOptions& options);

/// b(t + dt) = φ b(t) + input, with input = (1 − φ)(a1 + a2).
struct WarmUpStep {
  double phi;
  double input_mps2;
};
[[nodiscard]] WarmUpStep warm_up_step(const WarmUp& warm_up, double dt_s);

/// How far the bias is from where it settles: b(t) − (a1 + a2) = −a1 e^(−t/T), again a warm-up,
/// with −a1 for its a2. This is the part that estimators take out, because the rest, a1 + a2, is
/// the bias of the warmed-up sensor, which is what a calibration finds, and a2 as fitted to a
/// recording at rest holds whatever gravity the axis saw.
[[nodiscard]] WarmUp departure(const WarmUp& warm_up);

struct WarmUpOptions {
  double since_switch_on_s = 0.0;  ///< how long the sensor had been on at the first sample, ≥ 0
};

/// Takes the departure of each axis out of the sensor's channels, f ← f + a1 e^(−t/T), so that they
/// read as those of a warmed-up sensor; they are brought to m/s². Drift is in the unit and axes of
/// calibrated channels: apply() comes before. An axis without figures is left alone, and a note
/// says so.
///
/// Errors: invalid_argument (no axis of these has figures, or one has some of them only; a channel
/// is no acceleration; the recording has no time). The recording is then as it was.
[[nodiscard]] Status remove_warm_up(const DriftModel& drift,
                                    const Triad& triad,
                                    const WarmUpOptions& options,
                                    Recording& recording);

/// Whether any figure of a warm-up is known.
[[nodiscard]] bool has_warm_up(const DriftModel& drift);

}  // namespace proofmass::sensor
