#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/io/random_bytes.hpp"
#include "proofmass/io/tdms_layout.hpp"
#include "proofmass/io/tdms_value.hpp"

namespace proofmass::io {

/// The file, a group, or a channel.
struct TdmsObject {
  std::string group;  ///< empty: the file
  std::string name;   ///< of the channel; empty: the group
  TdmsProperties properties{};
  TdmsKind kind = TdmsKind::other;  ///< of its first values
  std::uint32_t type = 0;
  bool has_index = false;     ///< has, or could have had, values
  bool changes_kind = false;  ///< between figures, points in time, and what is not read
  std::uint64_t values = 0;
  std::uint64_t promised = 0;  ///< values, had the last chunk not broken off
};

/// Segments one behind another of one layout, size and distance.
struct TdmsRun {
  std::uint64_t data_at = 0;   ///< first byte of the first one's data
  std::uint64_t distance = 0;  ///< bytes from one to the next; 0 if there is one only
  std::uint64_t segments = 1;
  std::uint64_t chunks = 0;  ///< of each
  std::uint32_t layout = 0;
};

/// What a TDMS file holds and where.
struct TdmsMap {
  std::vector<TdmsObject> objects;  ///< in the order of the file
  std::vector<TdmsLayout> layouts;
  std::vector<TdmsRun> runs;
  std::uint64_t segments = 0;       ///< in all
  std::uint64_t data_segments = 0;  ///< of these: with values
  std::vector<Note> notes;          ///< what is broken

  std::map<std::string, std::uint32_t> groups;  ///< objects; "": the file itself

  /// What is said of a group, or, by "", of the file; nothing where there is no such object.
  [[nodiscard]] const TdmsProperties& properties_of(const std::string& group) const;
};

/// Walks through the segments of a file. A file that is broken yields what was found before, with a
/// note of Severity::bad.
/// Errors: corrupt (nothing found before), unsupported (the index of a file), unreadable.
/// Cost: one pass over lead-ins and metadata; the same metadata again and again is compared only.
[[nodiscard]] Result<TdmsMap> map_tdms(const RandomBytes& bytes);

}  // namespace proofmass::io
