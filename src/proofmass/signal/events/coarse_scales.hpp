#pragma once

#include <vector>

#include "proofmass/signal/events/findings.hpp"
#include "proofmass/signal/events/source.hpp"

// Both filters over windows of 16 samples and more.
namespace proofmass::signal {

/// The data that every scale needs.
struct Record {
  const Source& source;
  double rate_hz;
  double step_floor, outlier_floor;  ///< lower bounds of the std of the filters' outputs
};

/// Searches scales of 16 samples and more, short to long; findings of one scale are hidden from the
/// next. Adds to the hits and steps.
void search_coarse_scales(const Record& record, std::vector<Hit>& hits, std::vector<Step>& steps);

}  // namespace proofmass::signal
