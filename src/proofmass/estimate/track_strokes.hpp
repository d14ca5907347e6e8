#pragma once

#include <functional>
#include <vector>

#include "proofmass/estimate/track.hpp"

// From a smoothed position to strokes. Private to the module's track*.cpp.
namespace proofmass::estimate {

/// Covariance of the smoothed positions at some samples, row by row, m²; empty where it is too much
/// to work out.
using PositionCovarianceAt = std::function<std::vector<double>(const std::vector<std::size_t>&)>;

struct Strokes {
  std::vector<Stroke> strokes;
  std::optional<double> path_std_m;
};

/// Turns the position round where it swings by more than half the median of all swings beyond a
/// twentieth of the travel; a swing and the next make a stroke, there and back. A stroke within
/// twice its own standard deviation is none.
[[nodiscard]] Strokes find_strokes(const TrackSolution& solution,
                                   const PositionCovarianceAt& covariance);

}  // namespace proofmass::estimate
