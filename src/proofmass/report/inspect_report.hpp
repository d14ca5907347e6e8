#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/report/page.hpp"
#include "proofmass/signal/audit.hpp"

namespace proofmass::report {

/// One file and what the audit found in it.
struct InspectedFile {
  std::string name;  ///< as the user named it
  const Recording& recording;
  const signal::RecordingAudit& audit;
  /// The recording is an overview, the smallest and largest value of spans of so many samples; 0:
  /// it is whole.
  std::size_t overview_span = 0;
};

/// The document of `inspect`: docs/schema/inspect.schema.json. The fields of the first file stand
/// at the top; with several files, `files` has those of each.
[[nodiscard]] std::string inspect_json(const std::vector<InspectedFile>& files);

/// The page: each file's channels and timing as tables, each channel against time, and how the
/// steps between the stamps are spread.
[[nodiscard]] std::string inspect_html(const std::vector<InspectedFile>& files);

[[nodiscard]] Page inspect_page(const std::vector<InspectedFile>& files);

/// The name of a time source in documents: "stamps", "counter", "given_rate" or "none".
[[nodiscard]] const char* time_source_name(TimeSource source);

/// A screenful a file for a terminal.
[[nodiscard]] std::string inspect_text(const InspectedFile& file);

/// One name among a recording's labels.
struct LabelUse {
  std::string name;
  std::size_t runs = 0;
  std::size_t samples = 0;
};

/// The names among the labels, in the order in which they first come.
[[nodiscard]] std::vector<LabelUse> label_uses(const Recording& recording);

/// "0.031 ms"; what lies below a nanosecond is the rounding of the stamps and none of the clock.
[[nodiscard]] std::string jitter_words(const signal::TimingAudit& timing);

/// "120 Hz for 91.6 s, 3 channels, nothing wrong with it."
[[nodiscard]] std::string inspect_conclusion(const InspectedFile& file);

}  // namespace proofmass::report
