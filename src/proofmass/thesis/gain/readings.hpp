#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "proofmass/core/quantity.hpp"
#include "proofmass/estimate/gain_study.hpp"

// Section 5.2: measurements of a simulated acceleration, and the PVA filter's estimates from them.
namespace proofmass::thesis {

/// The two axes of the simulation: a = sin t and a = cos t, in m/s².
enum class SimulatedAxis { x, y };

/// One set of measurements of one axis at 0, Δ, 2Δ, …: the truth with white noise of variance R.
struct SimulatedReadings {
  std::vector<double> time_s, truth_mps2, reading_mps2, filtered_mps2, smoothed_mps2;
};

/// The filter's Q, R, step, duration and P₀ are those of the study; it starts at zero. Another set
/// is another draw of the noise.
[[nodiscard]] SimulatedReadings simulate_readings(const estimate::GainStudyOptions& options,
                                                  SimulatedAxis axis,
                                                  std::uint64_t seed,
                                                  std::size_t set = 0);

/// rms errors over the whole time; std is the scatter between sets of measurements.
struct ReadingErrors {
  Uncertain reading, filtered, smoothed;
};

/// Mean and scatter over this number of sets (two or more).
[[nodiscard]] ReadingErrors reading_errors(const estimate::GainStudyOptions& options,
                                           SimulatedAxis axis,
                                           std::uint64_t seed,
                                           std::size_t sets);

/// Response of the settled filter to sin ωt: H(z) = k/(1 − (1 − k) z⁻¹), z = e^(jωΔ).
struct FilterResponse {
  double amplitude = 0.0;  ///< of the output
  double delay_s = 0.0;
  double time_constant_s = 0.0;  ///< in which an error falls to 1/e: Δ/(−ln(1 − k))
};

/// Expects a study whose gain is between 0 and 1.
[[nodiscard]] FilterResponse filter_response(const estimate::GainStudy& study, double omega_radps);

}  // namespace proofmass::thesis
