#pragma once

#include <vector>

#include "proofmass/signal/event_findings.hpp"
#include "proofmass/signal/event_source.hpp"
#include "proofmass/signal/events.hpp"

// Assembles hits and steps into events.
namespace proofmass::signal {

/// Joins nearby hits, pairs steps that cancel, assigns adjacent hits to each step, and measures the
/// result. The events ascend and do not overlap.
[[nodiscard]] std::vector<Event> assemble(const Source& source,
                                          std::vector<Hit> hits,
                                          std::vector<Step> steps,
                                          double rate_hz);

}  // namespace proofmass::signal
