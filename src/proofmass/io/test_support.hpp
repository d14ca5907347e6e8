#pragma once

#include <cstdlib>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "proofmass/io/read_recording.hpp"

namespace proofmass::io {

/// Reads a text as a file.
inline Result<Recording> read_text(std::string_view text, const ReadOptions& options = {}) {
  return read_recording(std::as_bytes(std::span(text)), "text", options);
}

/// True if any note contains `part`.
inline bool is_noted(const Recording& recording, std::string_view part) {
  for (const Note& note : recording.notes)
    if (note.text.find(part) != std::string::npos) return true;
  return false;
}

/// Whether a note recommends the option.
inline bool recommends(const Recording& recording, std::string_view option) {
  for (const Note& note : recording.notes)
    for (const Advice& one : note.advice)
      if (one.option == option) return true;
  return false;
}

/// All notes, for a test's message.
inline std::string notes_of(const Recording& recording) {
  std::string all;
  for (const Note& note : recording.notes) all += note.text + "\n";
  return all;
}

/// The folder of published recordings, or an empty path if there is none.
inline std::filesystem::path published_data() {
  if (const char* given = std::getenv("PROOFMASS_DATA")) return given;
  std::filesystem::path beside = std::filesystem::path(PROOFMASS_SOURCE_DIR) / "../shared/data";
  return std::filesystem::exists(beside) ? beside : std::filesystem::path{};
}

}  // namespace proofmass::io
