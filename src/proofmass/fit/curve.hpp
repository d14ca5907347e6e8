#pragma once

#include <functional>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/core/view.hpp"
#include "proofmass/fit/nonlinear_least_squares.hpp"

namespace proofmass::fit {

/// y = f(x; p).
using CurveModel = std::function<double(double x, View<double> parameters)>;

struct CurveOptions {
  std::vector<double> sigma = {};  ///< standard deviation of each y; empty: equal weights
  std::vector<double> lower = {};  ///< lower bounds of the parameters, as in LeastSquaresProblem
  std::vector<double> upper = {};
  LeastSquaresOptions solver = {};  ///< unit_variance: sigma is known, not only up to a factor
};

/// The parameters that minimise ½ Σ ((y − f(x; p))/sigma)².
///
/// Errors: those of fit_least_squares; invalid_argument (x, y and sigma of different lengths, a
/// sigma that is not positive), not_finite (NaN or ∞ in x or y).
[[nodiscard]] Result<LeastSquaresFit> fit_curve(View<double> x,
                                                View<double> y,
                                                const CurveModel& model,
                                                View<double> start,
                                                const CurveOptions& options = {});

struct CurvePoint {
  double value;
  double std;          ///< standard deviation of the curve
  double reading_std;  ///< std of a new measurement with sigma 1: √(std² + residual_std²)
};

/// The fitted curve at each x with its confidence band, by the delta method:
///
///     std² = gᵀ C g,   g = ∂f/∂p,   C the covariance of p
///
/// Source: D. M. Bates, D. G. Watts, Nonlinear Regression Analysis (1988), section 2.3.2.
[[nodiscard]] std::vector<CurvePoint> curve_with_band(View<double> x,
                                                      const CurveModel& model,
                                                      const LeastSquaresFit& fit);

}  // namespace proofmass::fit
