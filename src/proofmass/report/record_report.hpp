#pragma once

#include <string>
#include <utility>
#include <vector>

#include "proofmass/core/recording_log.hpp"
#include "proofmass/report/document.hpp"

namespace proofmass::report {

/// A recording as it was made.
struct RecordReport {
  std::string source;
  std::vector<std::pair<std::string, std::string>> settings{};  ///< asked for and granted
  RecordSummary summary{};
  std::vector<Note> notes{};  ///< of the verb itself
};

/// What is in the file, what is missing from it, and how the clock ran. --strict fails if anything
/// is missing or doubtful.
[[nodiscard]] Document describe(const RecordReport& report);

/// "12.40 s: 0.5 s without a sample: …"
[[nodiscard]] std::string event_words(const RecordEvent& event);

/// The sources that can be recorded from now; `kinds` are grammar and sentence of each kind of
/// source, `found` URI and description of what is there.
struct SourceList {
  std::vector<std::pair<std::string, std::string>> kinds{}, found{};
  std::vector<Note> notes{};  ///< why a kind could not be looked for
};
[[nodiscard]] Document describe(const SourceList& list);

}  // namespace proofmass::report
