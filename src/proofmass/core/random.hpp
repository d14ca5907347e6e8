#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <string_view>

namespace proofmass {

/// Random numbers that are the same on every platform for the same seed: the generator is
/// standardised, the distributions are our own. Each purpose draws from its own stream, so that
/// enabling one effect does not change the numbers of the others.
class Random {
 public:
  Random(std::uint64_t seed, std::string_view purpose, std::size_t index = 0);

  /// Uniform in [0, 1).
  [[nodiscard]] double unit();
  /// Uniform in [−1, 1).
  [[nodiscard]] double uniform();
  /// Uniform in [0, 2π).
  [[nodiscard]] double phase();
  /// Normal, mean 0, standard deviation 1.
  /// Source: G. E. P. Box, M. E. Muller, Ann. Math. Statist. 29 (1958) 610.
  [[nodiscard]] double normal();

 private:
  std::mt19937_64 engine_;
  double spare_ = 0.0;
  bool has_spare_ = false;
};

}  // namespace proofmass
