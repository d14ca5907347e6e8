#pragma once

#include "proofmass/estimate/tilt.hpp"
#include "proofmass/signal/rests.hpp"

// Where the base was at rest. Private to the module's tilt*.cpp.
namespace proofmass::estimate {

/// The stretches in which the accelerometer was at rest and its level stood. A search by loudness
/// lets a slow motion within a rest pass for drift; here a rest is cut where the mean of half a
/// second departs from that of the rest before it by more than noise and what a sensor at rest
/// drifts by.
[[nodiscard]] signal::RestSearch rests_of(const TiltRecord& record, const TiltOptions& options);

/// Of a moving base: leaves out quiet stretches that go over smoothly into what is before and after
/// them, as the crest of a slow acceleration does. A rest begins or ends at an edge.
void drop_smooth_rests(const TiltRecord& record, signal::RestSearch& found);

}  // namespace proofmass::estimate
