#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "proofmass/core/quantity.hpp"
#include "proofmass/estimate/gain_study.hpp"

// Section 5.2: readings of a simulated acceleration, and what the PVA filter makes of them.
namespace proofmass::thesis {

/// The two axes of the simulation: a = sin t and a = cos t, in m/s².
enum class SimulatedAxis { x, y };

/// One set of readings of one axis at 0, Δ, 2Δ, …: the truth with white noise of variance R.
struct SimulatedReadings {
  std::vector<double> time_s, truth_mps2, reading_mps2, filtered_mps2, smoothed_mps2;
};

/// The filter's Q, R, step, duration and P₀ are those of the study; it begins at zero. Another set
/// is another draw of the noise.
[[nodiscard]] SimulatedReadings simulate_readings(const estimate::GainStudyOptions& options,
                                                  SimulatedAxis axis,
                                                  std::uint64_t seed,
                                                  std::size_t set = 0);

/// rms of the errors over the whole time; std is the scatter from one set of readings to another.
struct ReadingErrors {
  Uncertain reading, filtered, smoothed;
};

/// Mean and scatter over so many sets (two or more).
[[nodiscard]] ReadingErrors reading_errors(const estimate::GainStudyOptions& options,
                                           SimulatedAxis axis,
                                           std::uint64_t seed,
                                           std::size_t sets);

/// What the settled filter makes of sin ωt: H(z) = k/(1 − (1 − k) z⁻¹), z = e^(jωΔ).
struct FilterResponse {
  double amplitude = 0.0;  ///< of the output
  double delay_s = 0.0;
  double time_constant_s = 0.0;  ///< in which an error falls to 1/e: Δ/(−ln(1 − k))
};

/// Expects a study whose gain is between 0 and 1.
[[nodiscard]] FilterResponse filter_response(const estimate::GainStudy& study, double omega_radps);

}  // namespace proofmass::thesis
