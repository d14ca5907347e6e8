#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/thesis/programme.hpp"

// What `thesis` shows.
namespace proofmass::thesis {

struct ThesisReport {
  std::vector<std::string> inputs;  ///< files, as the user named them
  std::uint64_t seed = 1;           ///< of what is simulated
  std::size_t runs = 0;             ///< simulated at each speed
  std::vector<Note> notes = {};     ///< of reading
  Programme programme = {};
};

/// docs/schema/thesis.schema.json: items[] of {id, title, thesis, ours, note}.
[[nodiscard]] std::string thesis_json(const ThesisReport& report);

/// One page, chapter by chapter.
[[nodiscard]] std::string thesis_html(const ThesisReport& report);

/// A line or two an item, for a terminal.
[[nodiscard]] std::string thesis_text(const ThesisReport& report);

}  // namespace proofmass::thesis
