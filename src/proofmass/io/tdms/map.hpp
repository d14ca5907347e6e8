#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/io/bytes/random_bytes.hpp"
#include "proofmass/io/tdms/layout.hpp"
#include "proofmass/io/tdms/value.hpp"

namespace proofmass::io::tdms {

/// The file, a group, or a channel.
struct Object {
  std::string group;  ///< empty: the object is the file
  std::string name;   ///< channel's name; empty: the object is the group
  Properties properties{};
  Kind kind = Kind::other;  ///< kind of its first values
  std::uint32_t type = 0;
  bool has_index = false;     ///< has, or could have, values
  bool changes_kind = false;  ///< switches between numbers, timestamps, and unsupported kinds
  std::uint64_t values = 0;
  std::uint64_t promised = 0;  ///< number of values if the last chunk were complete
};

/// Consecutive segments with the same layout, size and distance.
struct Run {
  std::uint64_t data_at = 0;   ///< first byte of the first segment's data
  std::uint64_t distance = 0;  ///< bytes from one segment to the next; 0 if there is only one
  std::uint64_t segments = 1;
  std::uint64_t chunks = 0;  ///< per segment
  std::uint32_t layout = 0;
};

/// Contents of a TDMS file and their locations.
struct Map {
  std::vector<Object> objects;  ///< in the order of the file
  std::vector<Layout> layouts;
  std::vector<Run> runs;
  std::uint64_t segments = 0;       ///< total
  std::uint64_t data_segments = 0;  ///< segments with values
  std::vector<Note> notes;          ///< faults

  std::map<std::string, std::uint32_t> groups;  ///< index into objects; "": the file itself

  /// Properties of a group, or, for "", of the file; empty if there is no such object.
  [[nodiscard]] const Properties& properties_of(const std::string& group) const;
};

/// Scans the segments of a file. For a damaged file returns the segments before the damage, with a
/// note of Severity::bad.
/// Errors: corrupt (no segment before the damage), unsupported (an index file), unreadable.
/// Cost: one pass over lead-ins and metadata; repeated metadata are only compared.
[[nodiscard]] Result<Map> map_file(const RandomBytes& bytes);

}  // namespace proofmass::io::tdms
