#pragma once

#include <vector>

#include "proofmass/characterise/noise/term_spectra.hpp"
#include "proofmass/characterise/noise/whittle.hpp"
#include "proofmass/characterise/noise_fit.hpp"

namespace proofmass::characterise {

/// The evidence as groups of neighbouring densities, with the origin of each.
struct GroupedEvidence {
  std::vector<SpectralGroup> groups;  ///< those affected by a ramp first
  std::size_t slow = 0;  ///< so many are of the cosine transform, the rest of the averaged spectrum
  Sampling slow_sampling, fast_sampling;
  double bin_hz = 0.0;  ///< of the averaged spectrum

  /// Density of a shape in group g; for the averaged spectrum including its window.
  template <class Shape>
  [[nodiscard]] double seen(std::size_t g, const Shape& shape) const {
    const double f = groups[g].frequency_hz;
    if (g < slow) return shape(f, slow_sampling);
    return (4.0 * shape(f, fast_sampling) + shape(f - bin_hz, fast_sampling) +
            shape(f + bin_hz, fast_sampling)) /
           6.0;
  }
};

[[nodiscard]] GroupedEvidence group_evidence(const NoiseEvidence& evidence);

}  // namespace proofmass::characterise
