#pragma once

#include <array>
#include <cstddef>

#include "proofmass/core/quantity.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/sensor/sensor_model.hpp"

// The warm-up of a bias as a known input of an estimator.
namespace proofmass::sensor {

/// The bias of one axis, t since power-on:
///
///     b(t) = a2 + a1 (1 − e^(−t/T)),     ḃ = (a1 + a2 − b)/T,  b(0) = a2.
///
/// Source: M. A. Lele (2010), section 4.3.
struct WarmUp {
  double a1_mps2 = 0.0;
  double a2_mps2 = 0.0;
  double time_constant_s = 1.0;                       ///< T, positive
  std::array<std::array<double, 3>, 3> covariance{};  ///< covariance of a1, a2, T, in SI

  /// a1 + a2: the settled bias, and the known input of its differential equation.
  [[nodiscard]] double settled_mps2() const { return a1_mps2 + a2_mps2; }
};

/// The warm-up of axis 0, 1 or 2. A sensor file has standard deviations but no correlations, so the
/// covariance is diagonal, and 0 for a figure without std. A fit to a recording shorter than
/// several T leaves a1 and T correlated, and the std of the bias is then approximate.
/// Errors: invalid_argument (a1, a2 or T is missing, T is not positive; the message names the
/// figure).
[[nodiscard]] Result<WarmUp> warm_up_of(const DriftModel& drift, std::size_t axis);

/// b(t) and its standard deviation due to a1, a2 and T, to first order; t ≥ 0.
[[nodiscard]] Uncertain bias_at(const WarmUp& warm_up, double since_switch_on_s);

/// An interval of time since power-on, 0 ≤ from ≤ to.
struct OnTime {
  double from_s = 0.0, to_s = 0.0;
};

/// Mean of b over the interval; b itself if the interval has no length.
[[nodiscard]] Uncertain mean_bias(const WarmUp& warm_up, const OnTime& stretch);

struct SettlingOptions {
  double dt_s;             ///< ≥ 0
  double time_constant_s;  ///< > 0
};

/// One time step of any exponentially settling quantity, exact for any dt.
struct SettlingStep {
  double phi;      ///< e^(−dt/T)
  double settled;  ///< 1 − φ, to full precision for small dt
};
[[nodiscard]] SettlingStep settling_step(const SettlingOptions& options);

/// b(t + dt) = φ b(t) + input, with input = (1 − φ)(a1 + a2).
struct WarmUpStep {
  double phi;
  double input_mps2;
};
[[nodiscard]] WarmUpStep warm_up_step(const WarmUp& warm_up, double dt_s);

/// Deviation of the bias from its settled value: b(t) − (a1 + a2) = −a1 e^(−t/T), again a warm-up,
/// with −a1 for its a2. Estimators remove this part only: the remainder a1 + a2 is the bias of the
/// warmed-up sensor, which a calibration determines, and a2 fitted to a static recording includes
/// any gravity on the axis.
[[nodiscard]] WarmUp departure(const WarmUp& warm_up);

struct WarmUpOptions {
  double since_switch_on_s = 0.0;  ///< time from power-on to the first sample, ≥ 0
};

/// Removes the departure of each axis from the sensor's channels, f ← f + a1 e^(−t/T), so that they
/// are those of a warmed-up sensor; they are converted to m/s². Drift is in the unit and axes of
/// calibrated channels: call apply() first. An axis without figures is unchanged, with a note.
///
/// Errors: invalid_argument (none of these axes has figures, or one has only some; a channel is not
/// an acceleration; the recording has no time). The recording is then unchanged.
[[nodiscard]] Status remove_warm_up(const DriftModel& drift,
                                    const Triad& triad,
                                    const WarmUpOptions& options,
                                    Recording& recording);

/// True if any figure of a warm-up is known.
[[nodiscard]] bool has_warm_up(const DriftModel& drift);

}  // namespace proofmass::sensor
