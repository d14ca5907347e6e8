#pragma once

#include "proofmass/characterise/run_set.hpp"
#include "proofmass/characterise/runs/noise.hpp"

namespace proofmass::characterise {

/// Excess scatter of the values of three runs or more beyond their common variance within the runs,
/// whose weights sum to one.
[[nodiscard]] RunScatter run_scatter(View<double> values, View<VarianceEstimate> within);

/// Σ weight · value.
[[nodiscard]] double mean_variance(View<VarianceEstimate> within);

struct RunTrend {
  Uncertain per_run;
  double p = 1.0;  ///< two-sided
};

/// Trend of three values or more against their number, by least squares, std from their scatter
/// about it.
[[nodiscard]] RunTrend run_trend(View<double> values);

}  // namespace proofmass::characterise
