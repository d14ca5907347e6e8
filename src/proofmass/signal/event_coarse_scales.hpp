#pragma once

#include <vector>

#include "proofmass/signal/event_findings.hpp"
#include "proofmass/signal/event_source.hpp"

// Both filters over windows of 16 samples and more.
namespace proofmass::signal {

/// Everything about the record that each scale asks for.
struct Record {
  const Source& source;
  double rate_hz;
  double step_floor, knock_floor;  ///< least standard deviation of the filters' outputs
};

/// Scales of 16 samples and more, short to long; what one finds the next does not see. Adds to the
/// hits and steps.
void search_coarse_scales(const Record& record, std::vector<Hit>& hits, std::vector<Step>& steps);

}  // namespace proofmass::signal
