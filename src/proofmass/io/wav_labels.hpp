#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/io/wav_header.hpp"

namespace proofmass::io {

/// What the texts of a WAV file make of its channels.
struct WavLabels {
  std::vector<std::string> headings;  ///< one a channel, unit included
  std::vector<double> factors;        ///< one a channel: 1 unless a full scale is named
  /// The channel whose topmost bit says that a sample is made up, the data being lost.
  std::optional<std::size_t> validity;
  std::optional<std::int64_t> start_ns;
  std::vector<Note> notes;
};

/// Channels are "channel_1", … unless the comment names them: "Channel-1: Accel-X", "Scale-1: 8"
/// (in g, of the full scale of the whole numbers).
/// Source: Open Movement, omconvert, "WAV file".
[[nodiscard]] WavLabels label_wav(const WavHeader& header);

}  // namespace proofmass::io
