#pragma once

#include <cstddef>
#include <vector>

#include "proofmass/core/view.hpp"
#include "proofmass/estimate/models/inertial_1d.hpp"
#include "proofmass/estimate/track.hpp"

// Strokes from the smoothed position.
namespace proofmass::estimate {

/// Covariance of the smoothed positions at some epochs, from the filter's and the smoother's
/// quantities alone:
///
///     cov(x[j], x[k] | N) = P[j|j] Φᵀ (I − Λ P[k|k]),   Φ = Π_{i=j+1…k} (I − K H) F,
///
/// with Λ the adjoint after k. Source: derived from A. E. Bryson, M. Frazier's form; compare P. de
/// Jong, M. J. MacKinnon, Covariances for smoothed estimates in state space models, Biometrika 75
/// (1988) 601.
struct PositionCovariance {
  std::vector<double> position_m;
  std::vector<double> row_by_row;  ///< size² entries, m²
  [[nodiscard]] double at(std::size_t i, std::size_t j) const {
    return row_by_row[i * position_m.size() + j];
  }
};
[[nodiscard]] PositionCovariance smoothed_positions(const InertialAxis& model,
                                                    const InertialStart& start,
                                                    const std::vector<std::size_t>& at);

/// Samples at which the position reverses, including its start and end, for each motion between two
/// rests; a leg shorter than `least_m` is ignored.
[[nodiscard]] std::vector<std::vector<std::size_t>> turning_points(
    View<double> position_m, const std::vector<signal::Rest>& rests, double least_m);

struct LegPair {
  std::size_t out;    ///< index of the leg
  bool back = false;  ///< the next leg is its way back
};

/// The legs of one motion in pairs, there and back. With an odd number the first or the last has
/// no partner, whichever makes the others more similar.
[[nodiscard]] std::vector<LegPair> pair_legs(View<double> lengths_m);

}  // namespace proofmass::estimate
