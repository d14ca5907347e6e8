#pragma once

#include <vector>

#include "proofmass/signal/events.hpp"
#include "proofmass/signal/events/findings.hpp"
#include "proofmass/signal/events/source.hpp"

// Assembles hits and steps into events.
namespace proofmass::signal {

/// Joins nearby hits, pairs steps that cancel, assigns adjacent hits to each step, and measures the
/// result. The events ascend and do not overlap.
[[nodiscard]] std::vector<Event> assemble(const Source& source,
                                          std::vector<Hit> hits,
                                          std::vector<Step> steps,
                                          double rate_hz);

}  // namespace proofmass::signal
