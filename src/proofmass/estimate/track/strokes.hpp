#pragma once

#include <functional>
#include <vector>

#include "proofmass/estimate/track.hpp"

// Strokes from a smoothed position.
namespace proofmass::estimate {

/// Covariance of the smoothed positions at some samples, row by row, m²; empty if too expensive.
using PositionCovarianceAt = std::function<std::vector<double>(const std::vector<std::size_t>&)>;

struct Strokes {
  std::vector<Stroke> strokes;
  std::optional<double> path_std_m;
};

/// The position reverses where its leg exceeds half the median of all legs beyond a twentieth
/// of the travel; a leg and the next make a stroke, there and back. A stroke within twice its own
/// standard deviation is ignored.
[[nodiscard]] Strokes find_strokes(const TrackSolution& solution,
                                   const PositionCovarianceAt& covariance);

}  // namespace proofmass::estimate
