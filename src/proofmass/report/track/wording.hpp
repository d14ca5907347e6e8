#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/estimate/track.hpp"

// Words for the results of `track`.
namespace proofmass::report {

/// "0.4412 ± 0.0031 m", or in mm where both are below 0.1 m.
[[nodiscard]] std::string length_with_std(const Uncertain& length_m);

/// "−0.75 to 1.16 m": both ends in one unit, to two significant digits of their difference.
[[nodiscard]] std::string interval_words(double lower_m, double upper_m);

/// The 95 % interval of the displacement.
[[nodiscard]] std::string interval_words(const estimate::TrackMethod& method);

/// "removed", "present" or "unknown".
[[nodiscard]] std::string_view name_of(estimate::GravityContent gravity);

/// "inertial", "pva" or "fused".
[[nodiscard]] std::string_view name_of(estimate::TrackModel model);

/// The model and its jerk density; empty for the inertial model.
[[nodiscard]] std::string model_words(const estimate::TrackSolution& solution);

/// "removed by whoever recorded the readings", …
[[nodiscard]] std::string_view gravity_words(estimate::GravityContent gravity);

/// "there_and_back" or "one_way".
[[nodiscard]] std::string_view kind_of(const estimate::Stroke& stroke);

/// "x", "−z", or "(0.02, 0.99, −0.08)", with its frame.
[[nodiscard]] std::string axis_words(const estimate::TrackSolution& solution);

/// Summary of all strokes.
struct StrokeSummary {
  std::size_t count = 0;
  std::size_t there_and_back = 0;  ///< number of those
  /// Its std is the median of theirs: the errors of scale and level are common to all strokes.
  Uncertain median_length_m;
  std::optional<double> spread_m;  ///< sample standard deviation of the lengths, from two on
};
/// nullopt without strokes.
[[nodiscard]] std::optional<StrokeSummary> summary_of(const std::vector<estimate::Stroke>& strokes);

/// "10 strokes there and back, median 0.441 ± 0.012 m, scattering by 9 mm"
[[nodiscard]] std::string strokes_words(const StrokeSummary& summary);

/// Error budget of sensor, duration and stops, in sentences.
[[nodiscard]] std::vector<std::string> budget_words(const estimate::TrackSolution& solution);

/// Reason why the methods have no results; empty if they have.
[[nodiscard]] std::string refusal(const estimate::TrackSolution& solution);

/// "12 closures: the velocity missed 0 by 0.021 m/s rms, by 0.9 standard deviations".
[[nodiscard]] std::string closures_words(const std::vector<estimate::Closure>& closures);

}  // namespace proofmass::report
