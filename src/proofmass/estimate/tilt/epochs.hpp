#pragma once

#include <cstddef>

#include "proofmass/estimate/tilt/model.hpp"

// From a record to the input of the moving-base filter.
namespace proofmass::estimate {

/// Rate over a step: the mean of its ends, or the only one available; NaN (unknown) over a longer
/// step.
[[nodiscard]] Mat<3> rate_over(const Mat<3>& before,
                               const Mat<3>& now,
                               double step_s,
                               double longest_s);
/// Five usual steps, at least 0.2 s.
[[nodiscard]] double longest_bridge_s(double usual_step_s);

/// Steps, forces and rates.
[[nodiscard]] TiltEpochs epochs_of(const TiltRecord& record, const TiltSolution& solution);

/// Merges measurements that a logger repeated until the next one arrived, and returns the number
/// removed. They are identified by repeated whole rows in motion, where noise alone would make them
/// differ.
[[nodiscard]] std::size_t drop_held(TiltEpochs& epochs);

/// Gravity's norm, the noise at rest, and the base's usual rotation rate.
[[nodiscard]] TiltKnown known_of(const TiltRecord& record,
                                 const TiltOptions& options,
                                 const TiltSolution& solution,
                                 const TiltEpochs& epochs);

}  // namespace proofmass::estimate
