#pragma once

#include "proofmass/characterise/run_noise.hpp"
#include "proofmass/characterise/run_set.hpp"

namespace proofmass::characterise {

/// What values of three runs or more scatter beyond the variance within that all of them have, of
/// which the weights make one.
[[nodiscard]] RunScatter run_scatter(View<double> values, View<VarianceEstimate> within);

/// Σ weight · value.
[[nodiscard]] double mean_variance(View<VarianceEstimate> within);

struct RunTrend {
  Uncertain per_run;
  double p = 1.0;  ///< two-sided
};

/// Of three values or more against their number, by least squares, std by their scatter about it.
[[nodiscard]] RunTrend run_trend(View<double> values);

}  // namespace proofmass::characterise
