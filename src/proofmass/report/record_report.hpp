#pragma once

#include <string>
#include <utility>
#include <vector>

#include "proofmass/core/recording_log.hpp"

namespace proofmass::report {

/// What was recorded, from where.
struct RecordReport {
  std::string source;
  std::vector<std::pair<std::string, std::string>> settings{};  ///< asked for and granted
  RecordSummary summary{};
  std::vector<Note> notes{};  ///< of the verb itself
};

/// The document of `record`: docs/schema/record.schema.json.
[[nodiscard]] std::string record_json(const RecordReport& report);

/// A screenful for a terminal: what is in the file, what is missing from it, how the clock ran.
[[nodiscard]] std::string record_text(const RecordReport& report);

/// Whether something is missing or in doubt: what `--strict` asks.
[[nodiscard]] bool is_bad(const RecordReport& report);

/// "12.40 s: 0.5 s without a sample: …"
[[nodiscard]] std::string event_words(const RecordEvent& event);

/// What can be recorded from now, for a terminal; `kinds` are grammar and sentence of each kind of
/// source, `found` URI and description of what is there.
struct SourceList {
  std::vector<std::pair<std::string, std::string>> kinds{}, found{};
  std::vector<Note> notes{};  ///< why a kind could not be looked for
};
[[nodiscard]] std::string source_list_text(const SourceList& list);
[[nodiscard]] std::string source_list_json(const SourceList& list);

}  // namespace proofmass::report
