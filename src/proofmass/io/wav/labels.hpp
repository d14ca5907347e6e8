#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/io/wav/header.hpp"

namespace proofmass::io::wav {

/// Channel information from the texts of a WAV file.
struct Labels {
  std::vector<std::string> headings;  ///< one per channel, with units
  std::vector<double> factors;        ///< one per channel: 1 unless a full scale is given
  /// The channel whose highest bit marks a sample as filled in because the data were lost.
  std::optional<std::size_t> validity;
  std::optional<std::int64_t> start_ns;
  std::vector<Note> notes;
};

/// Channels are "channel_1", … unless the comment names them: "Channel-1: Accel-X", "Scale-1: 8"
/// (in g, for the full scale of the integers).
/// Source: Open Movement, omconvert, "WAV file".
[[nodiscard]] Labels labels_of(const Header& header);

}  // namespace proofmass::io::wav
