#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <string_view>
#include <vector>

namespace proofmass::simulate {

/// Random numbers that are the same on every platform for the same seed: the generator is
/// standardised, the distributions are our own. Each purpose draws from a stream of its own, so
/// that switching one effect on leaves the numbers of the others as they were.
class Random {
 public:
  Random(std::uint64_t seed, std::string_view purpose, std::size_t index = 0);

  /// Evenly in [−1, 1).
  [[nodiscard]] double uniform();
  /// Evenly in [0, 2π).
  [[nodiscard]] double phase();
  /// Normal, mean 0, standard deviation 1.
  /// Source: G. E. P. Box, M. E. Muller, Ann. Math. Statist. 29 (1958) 610.
  [[nodiscard]] double normal();

 private:
  double unit();
  std::mt19937_64 engine_;
  double spare_ = 0.0;
  bool has_spare_ = false;
};

/// Gaussian noise with an even spectrum from 0 to a highest frequency, as a function of time that
/// can be asked anywhere: a sum of sines of equal amplitude with random frequencies and phases.
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
