#pragma once

#include <vector>

#include "proofmass/signal/event_findings.hpp"
#include "proofmass/signal/event_source.hpp"
#include "proofmass/signal/events.hpp"

// From hits and steps to events.
namespace proofmass::signal {

/// Joins the hits near to one another, pairs the steps that cancel, gives each step the hits beside
/// it, and measures what results. The events ascend and do not overlap.
[[nodiscard]] std::vector<Event> assemble(const Source& source,
                                          std::vector<Hit> hits,
                                          std::vector<Step> steps,
                                          double rate_hz);

}  // namespace proofmass::signal
