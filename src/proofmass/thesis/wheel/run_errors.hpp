#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "proofmass/core/quantity.hpp"
#include "proofmass/thesis/thesis_paths.hpp"
#include "proofmass/thesis/wheel/first_turn.hpp"

// Errors of each estimator within one revolution.
namespace proofmass::thesis {

/// Error of a path along the sensors' circle, m, or of an angle, rad; estimate minus reference.
struct PathError {
  double at_2s = 0.0;  ///< or at the end of a shorter revolution
  double half = 0.0;   ///< at half of the revolution's time
  double end = 0.0;
  double rms = 0.0, mean_abs = 0.0;  ///< over the revolution
  double end_std = 0.0;              ///< what the estimator claims for the end; 0: nothing
};

struct ThesisErrors {
  PathError integrated, filtered, smoothed;
};

struct RunErrors {
  /// y1 and y2, and x1 and x2, fused so that gravity cancels; absent without a pair.
  std::optional<ThesisErrors> roll, pitch;
  std::optional<ThesisErrors> roll_gravity, pitch_gravity;  ///< gravity not cancelled
  /// The wheel model, m; of the angle itself, and of the change since the start. The smoothed ones
  /// are absent if they are the reference.
  std::optional<PathError> wheel_filtered, wheel_smoothed, wheel_moved;
};

/// What to compute: all of it costs four filters and smoothers of the thesis.
enum class Detail { all, tangential };

/// Errors: those of thesis_paths(). All are absent if the sensors' radius is unknown.
[[nodiscard]] Result<RunErrors> run_errors(const FirstTurn& turn, Detail detail);

[[nodiscard]] PathError path_error(const FirstTurn& turn,
                                   const std::vector<double>& path,
                                   const std::vector<double>& reference,
                                   double end_std);

/// One number of each run; absent where it has none.
using Pick = std::function<std::optional<double>(const RunErrors&)>;

/// One number of one error.
[[nodiscard]] Pick picked(std::optional<PathError> RunErrors::* which, double PathError::* what);
[[nodiscard]] Pick picked(std::optional<ThesisErrors> RunErrors::* which,
                          PathError ThesisErrors::* method,
                          double PathError::* what);

/// Root mean square over the runs, with its own standard deviation from their scatter; for one run
/// the absolute value. nullopt if a run has no such number.
[[nodiscard]] std::optional<Uncertain> rms_over(const std::vector<RunErrors>& runs,
                                                const Pick& pick);

/// Absolute values of all runs that have the number.
[[nodiscard]] std::vector<double> sizes_over(const std::vector<RunErrors>& runs, const Pick& pick);

}  // namespace proofmass::thesis
