#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "proofmass/fleet/results.hpp"

// A line of the journal.
namespace proofmass::fleet {

/// On one line, without its end. Bytes that are not UTF-8 become U+FFFD.
[[nodiscard]] std::string line_of(const Entry& entry);

/// nullopt where the line is no entry.
[[nodiscard]] std::optional<Entry> entry_of_line(std::string_view line);

/// Entry::id() and Entry::ended_s alone.
[[nodiscard]] std::optional<std::string> id_of_line(std::string_view line);
[[nodiscard]] double ended_of_line(std::string_view line);

/// One recording that failed, as failures.ndjson has it.
[[nodiscard]] std::string failure_line(const Entry& entry);

}  // namespace proofmass::fleet
