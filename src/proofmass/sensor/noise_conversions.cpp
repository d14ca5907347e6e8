#include "proofmass/sensor/noise_conversions.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "proofmass/core/contract.hpp"
#include "proofmass/core/statistics.hpp"
#include "proofmass/sensor/datasheet.hpp"

namespace proofmass::sensor {
namespace {

/// Maximum Allan deviation of a first-order Markov process over √(psd T), as published.
constexpr double markov_peak = 0.4365;

}  // namespace

double two_sided_density(double one_sided_rthz) {
  return one_sided_rthz / std::numbers::sqrt2;
}

double one_sided_density(double two_sided_rthz) {
  return two_sided_rthz * std::numbers::sqrt2;
}

double filtered_rms_mps2(const FilteredWhite& noise) {
  return filtered_noise_rms(one_sided_density(noise.white_mps2_rthz), noise.bandwidth_hz);
}

double folded_density_rthz(const FilteredWhite& noise, double rate_hz) {
  const double x = std::numbers::pi * noise.bandwidth_hz / rate_hz;
  return noise.white_mps2_rthz * std::sqrt(x / std::tanh(x));
}

double sample_variance_m2ps4(const SampledWhite& noise) {
  PM_EXPECTS(noise.rate_hz > 0.0);
  const double unfiltered = square(noise.white_mps2_rthz) * noise.rate_hz;
  if (!noise.bandwidth_hz) return unfiltered;
  return std::min(unfiltered,
                  square(filtered_rms_mps2({noise.white_mps2_rthz, *noise.bandwidth_hz})));
}

double bias_psd_m2ps5(double random_walk_mps2_rts) {
  return square(random_walk_mps2_rts);
}

double step_variance_m2ps4(const RandomWalkStep& step) {
  return bias_psd_m2ps5(step.random_walk_mps2_rts) * step.step_s;
}

double FirstOrderMarkov::variance_m2ps4() const {
  return 0.5 * psd_m2ps5 * time_constant_s;
}

FirstOrderMarkov markov_of_flicker(const FlickerPlateau& flicker) {
  PM_EXPECTS(flicker.time_constant_s > 0.0);
  const double plateau_m2ps4 = flicker_plateau * square(flicker.flicker_mps2);
  return {flicker.time_constant_s, plateau_m2ps4 / (square(markov_peak) * flicker.time_constant_s)};
}

double rounding_density_rthz(const Converter& converter) {
  PM_EXPECTS(converter.rate_hz > 0.0);
  return converter.lsb / std::sqrt(12.0 * converter.rate_hz);
}

double white_of(const AllanReading& reading) {
  return reading.deviation_mps2 * std::sqrt(reading.tau_s);
}

double random_walk_of(const AllanReading& reading) {
  PM_EXPECTS(reading.tau_s > 0.0);
  return reading.deviation_mps2 * std::sqrt(3.0 / reading.tau_s);
}

double flicker_of(const AllanReading& reading) {
  return reading.deviation_mps2 / std::sqrt(flicker_plateau);
}

double quantisation_of(const AllanReading& reading) {
  return reading.deviation_mps2 * reading.tau_s / std::numbers::sqrt3;
}

double ramp_of(const AllanReading& reading) {
  PM_EXPECTS(reading.tau_s > 0.0);
  return reading.deviation_mps2 * std::numbers::sqrt2 / reading.tau_s;
}

}  // namespace proofmass::sensor
