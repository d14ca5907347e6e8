#pragma once

#include <string>
#include <utility>
#include <vector>

#include "proofmass/core/recording_log.hpp"
#include "proofmass/report/document.hpp"

namespace proofmass::report {

/// A finished recording.
struct RecordReport {
  std::string source;
  std::vector<std::pair<std::string, std::string>> settings{};  ///< requested and granted
  RecordSummary summary{};
  std::vector<Note> notes{};  ///< notes of the verb
};

/// What the file contains, what is missing, and how the clock ran. --strict fails if anything is
/// missing or doubtful.
[[nodiscard]] Document describe(const RecordReport& report);

/// "12.40 s: 0.5 s without a sample: …"
[[nodiscard]] std::string event_words(const RecordEvent& event);

/// The sources available now. `kinds` has grammar and sentence of each kind of source, `found` URI
/// and description of each source.
struct SourceList {
  std::vector<std::pair<std::string, std::string>> kinds{}, found{};
  std::vector<Note> notes{};  ///< why sources of a kind could not be listed
};
[[nodiscard]] Document describe(const SourceList& list);

}  // namespace proofmass::report
