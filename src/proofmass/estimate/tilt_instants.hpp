#pragma once

#include <cstddef>

#include "proofmass/estimate/tilt_model.hpp"

// From a record to what the filter of a moving base takes. Private to the module's tilt*.cpp.
namespace proofmass::estimate {

/// Steps, forces and rates. A rate over a step is the mean of its ends, and unknown over a step
/// five times as long as is usual, and longer than 0.2 s.
[[nodiscard]] TiltInstants instants_of(const TiltRecord& record, const TiltSolution& solution);

/// Takes readings that a logger wrote again and again until the next came for one, and says how
/// many it took out. They are told by whole rows that repeat, in motion, where noise alone would
/// keep them apart.
[[nodiscard]] std::size_t drop_held(TiltInstants& instants);

/// Gravity's norm, the noise at rest, and how fast the base usually turns.
[[nodiscard]] TiltKnown known_of(const TiltRecord& record,
                                 const TiltOptions& options,
                                 const TiltSolution& solution,
                                 const TiltInstants& instants);

}  // namespace proofmass::estimate
