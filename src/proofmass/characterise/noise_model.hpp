#pragma once

#include <cstddef>
#include <optional>

#include "proofmass/core/quantity.hpp"

// The parts that noise at rest is made of, their spectra and their Allan variances, and what a
// recording says of each.
namespace proofmass::characterise {

/// The terms that add up, each with a coefficient c whose square scales spectrum and variance.
/// Source: IEEE Std 952-1997, annex C; the two-sided densities S(f) are its S_Ω(f).
enum class Term {
  quantisation,  ///< Q in u·s:    S = 4 Q² sin²(π f τ0) / τ0,        σ²(τ) = 3 Q²/τ²
  white,         ///< N in u/√Hz:  S = N²,                            σ²(τ) = N²/τ
  flicker,       ///< B in u:      S = B² / (2π f),                   σ²(τ) = (2 ln2/π) B²
  random_walk,   ///< K in u/√s:   S = K² / (2π f)²,                  σ²(τ) = K² τ/3
  markov,        ///< q in u/√s:   S = (q T)² / (1 + (2π f T)²), tends to a random walk below T
};
inline constexpr std::size_t term_count = 5;

enum class Verdict {
  identified,      ///< the recording cannot be explained without it
  not_observable,  ///< it can: the value is 0, and upper_95 says how large it may be
};

/// One coefficient: what the recording says of it.
struct Coefficient {
  double value = 0.0;  ///< 0 where not observable
  /// That of the 95 % interval: half of it over 1.96, of flicker noise, random walk and Markov
  /// noise its longer side over 1.96. Where not observable upper_95 / 1.645.
  double std = 0.0;
  /// Central 95 % interval, by likelihood ratio. It reaches 0 for an identified coefficient too,
  /// where another term might stand in for it: flicker for a random walk seen in too short a
  /// record.
  double lower_95 = 0.0, upper_two_sided_95 = 0.0;
  double upper_95 = 0.0;  ///< with 95 % confidence not above this
  Verdict verdict = Verdict::not_observable;
  /// Length of recording that would identify it with 95 % probability: at its value, or where it is
  /// not observable at upper_95. None beyond ten thousand times the recording.
  std::optional<double> record_needed_s;
};

/// First-order Markov noise (exponentially correlated), only where the recording needs it.
struct MarkovNoise {
  Coefficient strength;                         ///< q in u/√s
  Uncertain time_constant_s;                    ///< T
  [[nodiscard]] double std_of_process() const;  ///< q √(T/2) in u
};

/// A slow deterministic change, as temperature makes it: a sine of a few periods in the recording
/// or a piece of one. A random walk looks alike in so far as it rests on the slowest coefficients.
struct SlowChange {
  double period_s = 0.0;
  double peak_to_peak = 0.0;  ///< within the recording, with the ramp
  /// Whether it explains the recording better than noise does and was taken out of it; else it
  /// explains it as well as those terms whose interval reaches 0 for it.
  bool taken_out = false;
};

/// What was found, in the unit u of the series.
struct NoiseModelFit {
  double rate_hz = 0.0;
  double duration_s = 0.0;
  Coefficient quantisation, white, flicker, random_walk, ramp;  ///< ramp: |R| in u/s
  double slope_per_s = 0.0;  ///< R with its sign, as fitted, also where not observable
  std::optional<MarkovNoise> markov;
  std::optional<SlowChange> slow_change;
  std::optional<Uncertain> bandwidth_hz;  ///< −3 dB of a one-pole filter on the white term, where
                                          ///< the spectrum rolls off below half the rate
  /// Root mean square by which the spectrum departs from the model beyond its own scatter, as a
  /// share of the density; 0 where the two agree. It widens all standard deviations.
  double misfit = 0.0;
  double misfit_p = 1.0;      ///< probability of so much scatter if the model is the noise
  std::size_t ordinates = 0;  ///< groups of spectral values behind the fit, lines left out

  /// σ²(τ) of one term; 0 if not identified.
  [[nodiscard]] double allan_variance(Term term, double tau_s) const;
  /// Of the deterministic ramp, R²τ²/2; 0 if not identified.
  [[nodiscard]] double ramp_allan_variance(double tau_s) const;
  /// Of all of it.
  [[nodiscard]] double allan_variance(double tau_s) const;
  /// Two-sided density of a term with coefficient 1: the white one behind its filter, the Markov
  /// one (which there must be) with its time constant.
  [[nodiscard]] double shape(Term term, double frequency_hz) const;
  /// Two-sided density S(f) of all terms but the ramp.
  [[nodiscard]] double density(double frequency_hz) const;
};

/// σ²(τ) that a sine of amplitude A at frequency f adds: A² (sin²(π f τ) / (π f τ))².
/// Source: IEEE Std 952-1997, annex C, "sinusoidal noise".
[[nodiscard]] double sine_allan_variance(double amplitude, double frequency_hz, double tau_s);

}  // namespace proofmass::characterise
