#pragma once

#include <vector>

#include "proofmass/core/random.hpp"
#include "proofmass/simulate/band_limited_noise.hpp"

namespace proofmass::simulate {

/// Gaussian noise with a flat spectrum from 0 to a maximum frequency, as a function of time that
/// can be evaluated anywhere: a sum of sines of equal amplitude with random frequencies and phases.
/// Source: M. Shinozuka, G. Deodatis, Appl. Mech. Rev. 44 (1991) 191, with random frequencies.
class BandLimitedNoise {
 public:
  BandLimitedNoise() = default;
  BandLimitedNoise(double rms, double bandwidth_hz, Random random);
  [[nodiscard]] double at(double t_s) const;

  struct Component {
    double frequency_radps, phase_rad;
  };
  [[nodiscard]] const std::vector<Component>& components() const { return components_; }
  [[nodiscard]] double amplitude() const { return amplitude_; }

 private:
  double amplitude_ = 0.0;
  std::vector<Component> components_;
};

}  // namespace proofmass::simulate
