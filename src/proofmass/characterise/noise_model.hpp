#pragma once

#include <cstddef>
#include <optional>

#include "proofmass/core/quantity.hpp"

// Components of the noise at rest, their spectra and their Allan variances, and their estimated
// coefficients.
namespace proofmass::characterise {

/// Additive terms, each with a coefficient c whose square scales spectrum and variance. Source:
/// IEEE Std 952-1997, annex C; the two-sided densities S(f) are its S_Ω(f).
enum class Term {
  quantisation,  ///< Q in u·s:    S = 4 Q² sin²(π f τ0) / τ0,        σ²(τ) = 3 Q²/τ²
  white,         ///< N in u/√Hz:  S = N²,                            σ²(τ) = N²/τ
  flicker,       ///< B in u:      S = B² / (2π f),                   σ²(τ) = (2 ln2/π) B²
  random_walk,   ///< K in u/√s:   S = K² / (2π f)²,                  σ²(τ) = K² τ/3
  markov,        ///< q in u/√s:   S = (q T)² / (1 + (2π f T)²), tends to a random walk below T
};
inline constexpr std::size_t term_count = 5;

enum class Verdict {
  identified,      ///< required to explain the recording
  not_observable,  ///< not required: the value is 0, and upper_95 is its upper limit
};

/// Estimate of one coefficient.
struct Coefficient {
  double value = 0.0;  ///< 0 if not observable
  /// Standard deviation equivalent to the 95 % interval: half its width over 1.96; for flicker
  /// noise, random walk and Markov noise its longer side over 1.96. upper_95 / 1.645 if not
  /// observable.
  double std = 0.0;
  /// Central 95 % interval, by likelihood ratio. It includes 0 even for an identified coefficient
  /// if another term could replace it: flicker for a random walk in too short a record.
  double lower_95 = 0.0, upper_two_sided_95 = 0.0;
  double upper_95 = 0.0;  ///< 95 % upper limit
  Verdict verdict = Verdict::not_observable;
  /// Record length that would identify it with 95 % probability: at its value, or at upper_95 if
  /// not observable. Absent beyond ten thousand times the recording.
  std::optional<double> record_needed_s;
};

/// First-order Markov noise (exponentially correlated), only if the recording requires it.
struct MarkovNoise {
  Coefficient strength;                         ///< q in u/√s
  Uncertain time_constant_s;                    ///< T
  [[nodiscard]] double std_of_process() const;  ///< q √(T/2) in u
};

/// A slow deterministic change, such as from temperature: a sine with a few periods in the
/// recording or a part of one. It resembles a random walk in the slowest coefficients.
struct SlowChange {
  double period_s = 0.0;
  double peak_to_peak = 0.0;  ///< within the recording, with the ramp
  /// Whether it explains the recording better than noise and was subtracted; otherwise it explains
  /// it as well as those terms whose interval includes 0 because of it.
  bool taken_out = false;
};

/// Result of the fit, in the unit u of the series.
struct NoiseModelFit {
  double rate_hz = 0.0;
  double duration_s = 0.0;
  Coefficient quantisation, white, flicker, random_walk, ramp;  ///< ramp: |R| in u/s
  double slope_per_s = 0.0;  ///< signed R as fitted, also if not observable
  std::optional<MarkovNoise> markov;
  std::optional<SlowChange> slow_change;
  /// −3 dB of a one-pole filter on the white term, if the spectrum rolls off below half the rate.
  std::optional<Uncertain> bandwidth_hz;
  /// Rms departure of the spectrum from the model beyond its own scatter, relative to the density;
  /// 0 if they agree. It widens all standard deviations.
  double misfit = 0.0;
  double misfit_p = 1.0;      ///< p-value of the scatter under the model
  std::size_t ordinates = 0;  ///< number of groups of spectral values in the fit, without lines

  /// σ²(τ) of one term; 0 if not identified.
  [[nodiscard]] double allan_variance(Term term, double tau_s) const;
  /// σ²(τ) of the deterministic ramp, R²τ²/2; 0 if not identified.
  [[nodiscard]] double ramp_allan_variance(double tau_s) const;
  /// σ²(τ) of the sum of all terms.
  [[nodiscard]] double allan_variance(double tau_s) const;
  /// Two-sided density of a term with coefficient 1: the white one after its filter, the Markov one
  /// (must be present) with its time constant.
  [[nodiscard]] double shape(Term term, double frequency_hz) const;
  /// Two-sided density S(f) of all terms but the ramp.
  [[nodiscard]] double density(double frequency_hz) const;
};

/// σ²(τ) that a sine of amplitude A at frequency f adds: A² (sin²(π f τ) / (π f τ))².
/// Source: IEEE Std 952-1997, annex C, "sinusoidal noise".
[[nodiscard]] double sine_allan_variance(double amplitude, double frequency_hz, double tau_s);

}  // namespace proofmass::characterise
