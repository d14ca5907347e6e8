#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/calibrate/multi_position.hpp"
#include "proofmass/calibrate/uncertainty/monte_carlo.hpp"
#include "proofmass/calibrate/uncertainty/type_b.hpp"
#include "proofmass/core/progress.hpp"

// Monte Carlo check of the uncertainty of a multi-position calibration.
namespace proofmass::calibrate {

struct MonteCarloOptions {
  std::vector<TypeB> lines = {};
  std::string reading_unit = "m/s^2";
  /// Absent: as many as the adaptive procedure of JCGM 101 needs, two significant digits of each
  /// standard uncertainty being stable; at most 10⁶.
  std::optional<std::size_t> draws = 200;
  std::uint64_t seed = 1;
  Progress progress = {};
};

/// Budget compared with the draws, within their statistical uncertainty.
enum class BudgetSize { right, too_small, too_large };

/// One parameter by its budget and by calibrating drawn measurements.
struct ParameterCheck {
  std::string quantity, unit;
  double budget_std = 0.0, drawn_std = 0.0;
  double drawn_shift = 0.0;  ///< of the draws' mean from the value, in budget_std
  Interval drawn_95;         ///< symmetric
  double inside = 0.0;       ///< share of the draws inside the budget's 95 % interval
  BudgetSize agreement = BudgetSize::right;
};

struct MonteCarloCheck {
  std::size_t draws = 0, failed = 0;  ///< failed: the fit did not converge
  std::optional<bool> stable = {};  ///< of the adaptive procedure; absent: a given number of draws
  std::vector<ParameterCheck> parameters = {};
  bool agrees = true;        ///< no budget is too small
  std::string verdict = {};  ///< one or two sentences
};

/// Draws the means from their covariance (from the fit's residuals if that is unknown), gravity,
/// the quantities that the model assumes exact and the type B lines, and calibrates each draw anew.
/// For each parameter it compares the standard deviation and the coverage of the 95 % interval with
/// the budget, each tested at 1 % over all parameters; differences below 5 % of the standard
/// deviation and 1 % of coverage are not significant for a budget. poses, options: those of `fit`,
/// and lines not yet added to it. Errors: those of budget_of; not_observable (positions are
/// doubtful); too_few_samples (fewer than 100 draws were calibrated). Cost: one fit a draw, see
/// RedrawnFit.
[[nodiscard]] Result<MonteCarloCheck> check_by_monte_carlo(View<Pose> poses,
                                                           const MultiPositionOptions& options,
                                                           const MultiPosition& fit,
                                                           const MonteCarloOptions& how = {});

}  // namespace proofmass::calibrate
