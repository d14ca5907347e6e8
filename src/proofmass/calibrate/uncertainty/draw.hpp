#pragma once

#include <cstdint>

#include "proofmass/calibrate/uncertainty_budget.hpp"
#include "proofmass/core/random.hpp"

namespace proofmass::calibrate {

/// Inputs of a Monte Carlo calculation.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : random_(seed, "draws") {}

  /// One value of mean 0 and standard deviation 1; for student_t, of t itself with `dof` (0:
  /// normal). Source: G. E. P. Box, M. E. Muller, Ann. Math. Statist. 29 (1958) 610; R. W. Bailey,
  /// Math. Comp. 62 (1994) 779, for t.
  [[nodiscard]] double operator()(Distribution distribution, double dof = 0.0);
  [[nodiscard]] double normal() { return (*this)(Distribution::normal); }

 private:
  Random random_;
};

}  // namespace proofmass::calibrate
