#pragma once

#include <cstddef>

#include "proofmass/estimate/tilt_model.hpp"

// From a record to what the filter of a moving base takes. Private to the module's tilt*.cpp.
namespace proofmass::estimate {

/// A rate over a step: the mean of its ends, or the one that there is; NaN, unknown, over a longer
/// one than that.
[[nodiscard]] Mat<3> rate_over(const Mat<3>& before,
                               const Mat<3>& now,
                               double step_s,
                               double longest_s);
/// Five usual steps, at least 0.2 s.
[[nodiscard]] double longest_bridge_s(double usual_step_s);

/// Steps, forces and rates.
[[nodiscard]] TiltInstants instants_of(const TiltRecord& record, const TiltSolution& solution);

/// Takes measurements that a logger wrote again and again until the next came for one, and says how
/// many it took out. They are told by whole rows that repeat, in motion, where noise alone would
/// keep them apart.
[[nodiscard]] std::size_t drop_held(TiltInstants& instants);

/// Gravity's norm, the noise at rest, and how fast the base usually turns.
[[nodiscard]] TiltKnown known_of(const TiltRecord& record,
                                 const TiltOptions& options,
                                 const TiltSolution& solution,
                                 const TiltInstants& instants);

}  // namespace proofmass::estimate
