#pragma once

#include <span>

#include "proofmass/core/quantity.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/core/view.hpp"

namespace proofmass::signal {

/// Takes out of a series what follows a slow cause, such as a temperature, and returns how much of
/// the series' unit one of the cause's makes:
///
///     y[k] ← y[k] − c (u[k] − ū),     c = Σ (U − Ū)(Y − Ȳ) / Σ (U − Ū)²
///
/// over the means Y, U of up to 256 blocks; u runs straight from block to block, so that the
/// cause's own noise does not reach the series. The standard deviation of c is that of least
/// squares, times √((1 + r)/(1 − r)) for residuals with lag-1 autocorrelation r.
/// Source: N. R. Draper, H. Smith, Applied Regression Analysis (1998), section 1.4; of the factor
/// G. E. P. Box, G. M. Jenkins, Time Series Analysis (1976), section 2.1.
///
/// NaN is missing in both, which are equally long; a block counts where half of it is there.
/// Errors: too_few_samples (fewer than 8 blocks of 16), not_observable (the cause does not vary);
/// the series is then as it was. Cost: O(N).
[[nodiscard]] Result<Uncertain> regress_out(std::span<double> series, View<double> cause);

}  // namespace proofmass::signal
