#pragma once

#include "proofmass/estimate/tilt/accel.hpp"
#include "proofmass/estimate/tilt/model.hpp"

// The moving base: noise parameters from the data, then filter and smoother.
namespace proofmass::estimate {

/// Gate of every pass: measurements are down-weighted beyond three standard deviations.
inline constexpr Gate tilt_gate{.huber = 3.0};

/// White noise of a typical gyroscope, if no rest shows its own.
inline constexpr double usual_rate_noise_radps_rthz = 1e-3;

/// ln L of one epoch's first `readings` innovations, with Huber's loss beyond the gate.
[[nodiscard]] double tilt_log_likelihood(const StepOf<TiltModel>& step, int readings);

/// ln L of the accelerometer's innovations in motion, all epochs together.
[[nodiscard]] double tilt_log_likelihood(const TiltEpochs& epochs,
                                         const TiltKnown& known,
                                         const TiltMotion& motion);

/// The filter's parameters: those of base_accel, the gyroscope's noise from rests or a typical
/// value, and without gyroscope the maximum-likelihood angular acceleration.
[[nodiscard]] TiltMotion fit_tilt_motion(const TiltEpochs& epochs,
                                         const TiltKnown& known,
                                         const BaseAccel& accel,
                                         bool gyroscope);

/// The gyroscope's bias in the middle of the recording, given all of it.
[[nodiscard]] RateBias rate_bias_of(const TiltEpochs& epochs,
                                    const TiltKnown& known,
                                    const TiltMotion& motion);

/// Runs filter and smoother and fills series, consistency, final angles and bias.
void run_tilt(const TiltEpochs& epochs,
              const TiltKnown& known,
              const TiltOptions& options,
              TiltSolution& solution);

}  // namespace proofmass::estimate
