#pragma once

#include <functional>
#include <span>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/core/view.hpp"

namespace proofmass::fit {

/// f(p) and ∂f/∂p. A step to a value that is not finite is rejected.
using SmoothFunction = std::function<double(View<double> parameters, std::span<double> gradient)>;

struct SmoothOptions {
  int max_iterations = 200;
  double gradient_tolerance = 1e-10;  ///< stops when the largest |∂f/∂p| is below this
  double longest_step = 4.0;          ///< largest step of a parameter, before the line search
};

struct SmoothMinimum {
  std::vector<double> parameters;
  double value = 0.0;
  double gradient = 0.0;  ///< largest |∂f/∂p|
  int iterations = 0;
  bool converged = false;  ///< the gradient is small enough, or f decreases only by rounding
};

/// The p that minimises a smooth function without bounds, by descent from the start: the
/// quasi-Newton method of Broyden, Fletcher, Goldfarb and Shanno with a line search that satisfies
/// the weak Wolfe conditions. Parameters should be of order 1, as logarithms are.
/// Source: J. Nocedal, S. J. Wright, Numerical Optimization (2006), section 6.1.
/// Errors: invalid_argument (no parameter), not_finite (f or its gradient at the start).
/// Cost: usually one or two calls per iteration.
[[nodiscard]] Result<SmoothMinimum> minimise_smooth(const SmoothFunction& function,
                                                    const std::vector<double>& start,
                                                    const SmoothOptions& options = {});

}  // namespace proofmass::fit
