#pragma once

#include <cstdint>
#include <random>

#include "proofmass/calibrate/uncertainty_budget.hpp"

// Random numbers that are the same on every machine for the same seed: the generator is
// standardised, the distributions are our own.
namespace proofmass::calibrate {

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : engine_(seed) {}

  /// One value of mean 0 and standard deviation 1; of student_t, of t itself with `dof` (0:
  /// normal). Source: G. E. P. Box, M. E. Muller, Ann. Math. Statist. 29 (1958) 610; R. W. Bailey,
  /// Math. Comp. 62 (1994) 779, for t.
  [[nodiscard]] double operator()(Distribution distribution, double dof = 0.0);
  [[nodiscard]] double normal() { return (*this)(Distribution::normal); }

 private:
  double unit();  ///< evenly in (0, 1]
  std::mt19937_64 engine_;
};

}  // namespace proofmass::calibrate
