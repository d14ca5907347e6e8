#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/report/document.hpp"
#include "proofmass/report/page/figure.hpp"
#include "proofmass/signal/audit.hpp"

namespace proofmass::report {

/// One file and its audit.
struct InspectedFile {
  std::string name;  ///< as the user named it
  const Recording& recording;
  const signal::RecordingAudit& audit;
  /// Samples per interval if the recording is an overview of minima and maxima; 0 if it has all
  /// samples.
  std::size_t overview_span = 0;
};

/// Fields of the first file at the top level; with several files, `files` has those of each. Holds
/// references to the recordings and audits, which must outlive it.
[[nodiscard]] Document describe(const std::vector<InspectedFile>& files);

/// Each channel against time, up to three of one unit in a figure, and the distribution of the time
/// steps. Holds a reference to the recording until the plots are drawn.
[[nodiscard]] std::vector<Plot> inspect_plots(const InspectedFile& file);

/// Name of a time source in documents: "stamps", "counter", "given_rate" or "none".
[[nodiscard]] const char* time_source_name(TimeSource source);

}  // namespace proofmass::report
