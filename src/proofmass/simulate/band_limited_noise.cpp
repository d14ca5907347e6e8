#include "proofmass/simulate/band_limited_noise.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>

namespace proofmass::simulate {

BandLimitedNoise::BandLimitedNoise(double rms, double bandwidth_hz, Random random) {
  if (rms == 0.0) return;
  // One frequency in each of this many equal bands: a flat spectrum that does not repeat.
  constexpr std::size_t count = 64;
  amplitude_ = rms * std::sqrt(2.0 / count);
  const double band_radps = 2.0 * std::numbers::pi * bandwidth_hz / count;
  for (std::size_t i = 0; i < count; ++i) {
    const double within = 0.5 * (random.uniform() + 1.0);
    components_.push_back({(static_cast<double>(i) + within) * band_radps, random.phase()});
  }
}

double BandLimitedNoise::at(double t_s) const {
  double sum = 0.0;
  for (const Component& c : components_) sum += std::sin(c.frequency_radps * t_s + c.phase_rad);
  return amplitude_ * sum;
}

}  // namespace proofmass::simulate
