#pragma once

#include <vector>

#include "input/rest_channels.hpp"
#include "proofmass/characterise/noise_analysis.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/io/recording_stream.hpp"
#include "proofmass/report/noise/report.hpp"

// Noise of recordings that are larger than memory.
namespace proofmass::app {

/// A channel with its prepared series and its result.
struct NoiseChannel {
  RestChannel rest;
  report::ChannelNoise shown;
};

/// Analyses the channels in one pass over the recording. Throws Failure, also if the options
/// require the whole recording in memory.
[[nodiscard]] std::vector<NoiseChannel> analyse_pieces(io::RecordingStream stream,
                                                       const RestOptions& options,
                                                       const characterise::NoiseOptions& noise,
                                                       std::vector<Note>& notes);

}  // namespace proofmass::app
