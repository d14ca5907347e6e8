#pragma once

#include <span>

#include "proofmass/core/quantity.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/core/view.hpp"

namespace proofmass::signal {

/// Removes from a series the part that follows a slow covariate, such as temperature, and returns
/// the sensitivity c in units of the series per unit of the covariate:
///
///     y[k] ← y[k] − c (u[k] − ū),     c = Σ (U − Ū)(Y − Ȳ) / Σ (U − Ū)²
///
/// over the means Y, U of up to 256 blocks. u is interpolated linearly between blocks, so that its
/// own noise does not enter the series. The standard deviation of c is that of least squares, times
/// √((1 + r)/(1 − r)) for residuals with lag-1 autocorrelation r.
/// Source: N. R. Draper, H. Smith, Applied Regression Analysis (1998), section 1.4; for the factor
/// G. E. P. Box, G. M. Jenkins, Time Series Analysis (1976), section 2.1.
///
/// Both must have equal length; NaN counts as missing. A block counts if at least half of it is
/// present.
/// Errors: too_few_samples (fewer than 8 blocks of 16), not_observable (the covariate does not
/// vary); the series is then unchanged. Cost: O(N).
[[nodiscard]] Result<Uncertain> regress_out(std::span<double> series, View<double> cause);

}  // namespace proofmass::signal
