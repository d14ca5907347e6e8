#pragma once

#include <numbers>
#include <optional>

// Conversions between the noise figures of datasheets, Allan curves and filters. Letters are those
// of NoiseModel: N, B, K, Q, R; N is a two-sided density throughout.
namespace proofmass::sensor {

/// A datasheet's density is one-sided, with all power on positive frequencies: N = ND / √2.
[[nodiscard]] double two_sided_density(double one_sided_rthz);

/// ND = √2 N.
[[nodiscard]] double one_sided_density(double two_sided_rthz);

/// White noise of density N after a one-pole filter with the given −3 dB frequency.
struct FilteredWhite {
  double white_mps2_rthz;
  double bandwidth_hz;
};

/// rms in m/s^2 after the filter, before or after sampling at any rate: N √(2 · π/2 · bandwidth).
/// Source: as filtered_noise_rms, with ND = √2 N.
[[nodiscard]] double filtered_rms_mps2(const FilteredWhite& noise);

/// Two-sided density at low frequencies, in a recording at this rate, of white noise after a
/// one-pole filter. What the filter passes above half the rate is aliased into the band: N √(x coth
/// x), x = π bandwidth / rate.
/// Source: the sampled exponentially correlated process, M. B. Priestley, Spectral Analysis and
/// Time Series (1981), section 7.1.1.
[[nodiscard]] double folded_density_rthz(const FilteredWhite& noise, double rate_hz);

/// White noise as recorded. N is the density measured at that rate, including what the filter
/// passes above half the rate and sampling aliases; a datasheet's density excludes the aliased
/// part.
struct SampledWhite {
  double white_mps2_rthz;
  double rate_hz;
  std::optional<double> bandwidth_hz{};  ///< bandwidth of a one-pole filter before the converter
};

/// Variance in m^2/s^4 of one sample, the R of a filter: N² rate, or N² 2 (π/2) bandwidth if that
/// is smaller, in which case the samples are correlated. The exact value for one pole is N² rate
/// tanh(π bandwidth / rate), at most a quarter below.
/// Source: Kalibr's wiki, "IMU Noise Model" (rate); filtered_noise_rms (filter).
[[nodiscard]] double sample_variance_m2ps4(const SampledWhite& noise);

/// Density in m^2/s^5 of the white noise that drives a bias with random walk K: K². Source: J. A.
/// Farrell, F. O. Silva, F. Rahman, J. Wendel, Inertial measurement unit error modeling tutorial,
/// IEEE Control Systems Magazine 42(6) (2022): S_K = K².
[[nodiscard]] double bias_psd_m2ps5(double random_walk_mps2_rts);

struct RandomWalkStep {
  double random_walk_mps2_rts;
  double step_s;
};

/// Variance in m^2/s^4 that the bias gains in one step: K² dt.
[[nodiscard]] double step_variance_m2ps4(const RandomWalkStep& step);

struct FlickerPlateau {
  double flicker_mps2;     ///< B
  double time_constant_s;  ///< T_B; choose it so that 1.89 T_B lies where the Allan curve is flat
};

/// First-order Markov process, ḃ = −b/T + w: a substitute for flicker noise, which no linear filter
/// of finite order produces.
struct FirstOrderMarkov {
  double time_constant_s;  ///< T
  double psd_m2ps5;        ///< two-sided density of w

  [[nodiscard]] double variance_m2ps4() const;  ///< in the steady state, psd T / 2
};

/// The Markov process whose maximum Allan variance is that of the flicker noise, (2 ln2/π) B²: T =
/// T_B, psd = 2 B² ln2 / (π 0.4365² T_B). The maximum is at τ = 1.89 T.
/// Source: Farrell et al. (2022), their S_B and T_B; the maximum is from IEEE Std 952-1997, annex
/// C.
[[nodiscard]] FirstOrderMarkov markov_of_flicker(const FlickerPlateau& flicker);

struct Converter {
  double lsb;      ///< in any unit u
  double rate_hz;  ///< conversion rate
};

/// Density N in u/√Hz of a converter's quantisation noise: LSB / √(12 rate), white up to half the
/// rate. Valid only if the signal's own noise is about half a step or more; below, the rounding
/// error is not noise.
/// Source: W. R. Bennett, Spectra of quantized signals, Bell System Technical Journal 27 (1948).
[[nodiscard]] double rounding_density_rthz(const Converter& converter);

/// A point on the part of an Allan deviation curve that is due to one term.
struct AllanReading {
  double tau_s;
  double deviation_mps2;
};

/// The coefficient for which the term's line passes through the point. N is therefore the value of
/// the line at 1 s, K at 3 s, Q at √3 s, R at √2 s; B is the flat part over 0.664, at any τ. The
/// minimum of a curve is flicker noise only if there is a flat part: white noise and a random walk
/// together have a minimum too.
/// Source: IEEE Std 952-1997, annex C.
[[nodiscard]] double white_of(const AllanReading& reading);         ///< N = σ √τ
[[nodiscard]] double random_walk_of(const AllanReading& reading);   ///< K = σ √(3/τ)
[[nodiscard]] double flicker_of(const AllanReading& reading);       ///< B = σ / √(2 ln2/π)
[[nodiscard]] double quantisation_of(const AllanReading& reading);  ///< Q = σ τ/√3
[[nodiscard]] double ramp_of(const AllanReading& reading);          ///< R = σ √2/τ

/// Flat part of the Allan variance over B²: 2 ln2/π, whose square root is 0.664.
inline constexpr double flicker_plateau = 2.0 * std::numbers::ln2 * std::numbers::inv_pi;

}  // namespace proofmass::sensor
