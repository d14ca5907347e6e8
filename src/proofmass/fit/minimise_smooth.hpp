#pragma once

#include <functional>
#include <span>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/core/view.hpp"

namespace proofmass::fit {

/// f(p) and ∂f/∂p. What is not finite turns a step back.
using SmoothFunction = std::function<double(View<double> parameters, std::span<double> gradient)>;

struct SmoothOptions {
  int max_iterations = 200;
  double gradient_tolerance = 1e-10;  ///< of the largest |∂f/∂p|, where the search ends
  double longest_step = 4.0;          ///< of a parameter, before the search along the step
};

struct SmoothMinimum {
  std::vector<double> parameters;
  double value = 0.0;
  double gradient = 0.0;  ///< largest |∂f/∂p|
  int iterations = 0;
  bool converged = false;  ///< the gradient is that small, or f falls no more but by its rounding
};

/// The p that minimises a smooth function without bounds, downhill from the start: the quasi-Newton
/// method of Broyden, Fletcher, Goldfarb and Shanno with a line search that meets Wolfe's
/// weak conditions. Parameters should be of order 1, as logarithms are.
/// Source: J. Nocedal, S. J. Wright, Numerical Optimization (2006), section 6.1.
/// Errors: invalid_argument (no parameter), not_finite (f or its gradient at the start).
/// Cost: one or two calls an iteration, mostly.
[[nodiscard]] Result<SmoothMinimum> minimise_smooth(const SmoothFunction& function,
                                                    const std::vector<double>& start,
                                                    const SmoothOptions& options = {});

}  // namespace proofmass::fit
