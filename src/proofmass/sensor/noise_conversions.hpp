#pragma once

#include <numbers>
#include <optional>

// The one place for what datasheets, Allan curves and filters call the same noise. Letters are
// those of NoiseModel: N, B, K, Q, R; N is a two-sided density throughout.
namespace proofmass::sensor {

/// A datasheet's density is one-sided, all the power on positive frequencies: N = ND / √2.
[[nodiscard]] double two_sided_density(double one_sided_rthz);

/// ND = √2 N.
[[nodiscard]] double one_sided_density(double two_sided_rthz);

/// White noise of density N where a one-pole filter has its −3 dB frequency.
struct FilteredWhite {
  double white_mps2_rthz;
  double bandwidth_hz;
};

/// rms in m/s^2 behind the filter, before or after sampling at any rate: N √(2 · π/2 · bandwidth).
/// Source: as filtered_noise_rms, with ND = √2 N.
[[nodiscard]] double filtered_rms_mps2(const FilteredWhite& noise);

/// Two-sided density at low frequencies that a recording at this rate shows of white noise behind a
/// one-pole filter: what the filter lets through above half the rate is folded onto it,
/// N √(x coth x), x = π bandwidth / rate.
/// Source: the sampled exponentially correlated process, M. B. Priestley, Spectral Analysis and
/// Time Series (1981), section 7.1.1.
[[nodiscard]] double folded_density_rthz(const FilteredWhite& noise, double rate_hz);

/// White noise as a recording shows it. N is the density measured at that rate, so that whatever
/// the filter lets through above half the rate is folded into it; a datasheet knows nothing of
/// that.
struct SampledWhite {
  double white_mps2_rthz;
  double rate_hz;
  std::optional<double> bandwidth_hz{};  ///< of a one-pole filter before the converter
};

/// Variance in m^2/s^4 of one sample, which a filter takes for R: N² rate, or N² 2 (π/2) bandwidth
/// where that is smaller, the samples then being correlated. One pole makes it exactly
/// N² rate tanh(π bandwidth / rate), which is at most a quarter below.
/// Source: Kalibr's wiki, "IMU Noise Model" (rate); filtered_noise_rms (filter).
[[nodiscard]] double sample_variance_m2ps4(const SampledWhite& noise);

/// Density in m^2/s^5 of the white noise that drives a bias with random walk K: K².
/// Source: J. A. Farrell, F. O. Silva, F. Rahman, J. Wendel, Inertial measurement unit error
/// modeling tutorial, IEEE Control Systems Magazine 42(6) (2022): S_K = K².
[[nodiscard]] double bias_psd_m2ps5(double random_walk_mps2_rts);

struct RandomWalkStep {
  double random_walk_mps2_rts;
  double step_s;
};

/// Variance in m^2/s^4 that the bias gains in one step: K² dt.
[[nodiscard]] double step_variance_m2ps4(const RandomWalkStep& step);

struct FlickerPlateau {
  double flicker_mps2;     ///< B
  double time_constant_s;  ///< T_B, to choose so that 1.89 T_B lies where the Allan curve is flat
};

/// First-order Markov process, ḃ = −b/T + w, in the place of flicker noise, which no linear filter
/// of finite order makes.
struct FirstOrderMarkov {
  double time_constant_s;  ///< T
  double psd_m2ps5;        ///< two-sided density of w

  [[nodiscard]] double variance_m2ps4() const;  ///< in the steady state, psd T / 2
};

/// The Markov process whose Allan variance has flicker's (2 ln2/π) B² for its maximum:
/// T = T_B, psd = 2 B² ln2 / (π 0.4365² T_B). The maximum is at τ = 1.89 T.
/// Source: Farrell et al. (2022), their S_B and T_B; the maximum is from IEEE Std 952-1997, annex
/// C.
[[nodiscard]] FirstOrderMarkov markov_of_flicker(const FlickerPlateau& flicker);

struct Converter {
  double lsb;      ///< of any unit u
  double rate_hz;  ///< at which it converts
};

/// Density N in u/√Hz of a converter's rounding: LSB / √(12 rate), white up to half the rate. True
/// only where the signal's own noise is about half a step or more; below, rounding is no noise.
/// Source: W. R. Bennett, Spectra of quantized signals, Bell System Technical Journal 27 (1948).
[[nodiscard]] double rounding_density_rthz(const Converter& converter);

/// A point on that part of an Allan deviation curve that one term makes.
struct AllanReading {
  double tau_s;
  double deviation_mps2;
};

/// The coefficient that puts the term's line through the point; so N is read at 1 s, K at 3 s, Q at
/// √3 s, R at √2 s, and B is the flat part over 0.664, at any τ. The minimum of a curve is flicker
/// only if a flat part is there: white noise that meets a random walk has a minimum too.
/// Source: IEEE Std 952-1997, annex C.
[[nodiscard]] double white_of(const AllanReading& reading);         ///< N = σ √τ
[[nodiscard]] double random_walk_of(const AllanReading& reading);   ///< K = σ √(3/τ)
[[nodiscard]] double flicker_of(const AllanReading& reading);       ///< B = σ / √(2 ln2/π)
[[nodiscard]] double quantisation_of(const AllanReading& reading);  ///< Q = σ τ/√3
[[nodiscard]] double ramp_of(const AllanReading& reading);          ///< R = σ √2/τ

/// Flat part of the Allan variance over B²: 2 ln2/π, whose root is 0.664.
inline constexpr double flicker_plateau = 2.0 * std::numbers::ln2 * std::numbers::inv_pi;

}  // namespace proofmass::sensor
