#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "proofmass/calibrate/monte_carlo.hpp"
#include "proofmass/calibrate/multi_position.hpp"
#include "proofmass/calibrate/type_b.hpp"

// Whether the uncertainty of a multi-position calibration is right.
namespace proofmass::calibrate {

struct MonteCarloOptions {
  std::vector<TypeB> lines = {};
  std::string reading_unit = "m/s^2";
  std::size_t draws = 200;
  std::uint64_t seed = 1;
};

/// Is the budget of the size that the draws show, as far as so many of them can tell?
enum class BudgetSize { right, too_small, too_large };

/// One parameter by its budget and by calibrating drawn readings.
struct ParameterCheck {
  std::string quantity, unit;
  double budget_std = 0.0, drawn_std = 0.0;
  double drawn_shift = 0.0;  ///< of the draws' mean against the value, in budget_std
  Interval drawn_95;         ///< symmetric
  double inside = 0.0;       ///< share of the draws that the budget's 95 % interval holds
  BudgetSize agreement = BudgetSize::right;
};

struct MonteCarloCheck {
  std::size_t draws = 0, failed = 0;  ///< failed: the fit did not come to an end
  std::vector<ParameterCheck> parameters;
  bool agrees = true;   ///< no budget is too small
  std::string verdict;  ///< one or two sentences
};

/// Draws the means by their covariance (by the fit's residuals where that is not known), gravity,
/// what the model takes for exact and the type B lines, calibrates anew each time, and compares
/// with the budget of each parameter: the standard deviation, and how many draws its 95 % interval
/// holds, each tested at 1 % over all parameters.
/// poses, options: those that `fit` came from, and lines not yet added to it.
/// Errors: those of budget_of; not_observable (positions are doubtful); too_few_samples (fewer than
/// 100 draws were calibrated). Cost: one calibration a draw.
[[nodiscard]] Result<MonteCarloCheck> check_by_monte_carlo(View<Pose> poses,
                                                           const MultiPositionOptions& options,
                                                           const MultiPosition& fit,
                                                           const MonteCarloOptions& how = {});

}  // namespace proofmass::calibrate
