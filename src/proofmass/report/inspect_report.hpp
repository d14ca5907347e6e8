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
  /// The recording is an overview, the minimum and maximum of each span of this many samples; 0: it
  /// has all samples.
  std::size_t overview_span = 0;
};

/// Fields of the first file at the top; with several files, `files` has those of each. The
/// recordings and audits must outlive the document.
[[nodiscard]] Document describe(const std::vector<InspectedFile>& files);

/// Each channel against time, up to three of one unit in a figure, and the distribution of the
/// steps between the time stamps. Refer to the recording until they are drawn.
[[nodiscard]] std::vector<Plot> inspect_plots(const InspectedFile& file);

/// The name of a time source in documents: "stamps", "counter", "given_rate" or "none".
[[nodiscard]] const char* time_source_name(TimeSource source);

}  // namespace proofmass::report
