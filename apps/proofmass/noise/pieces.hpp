#pragma once

#include <vector>

#include "input/rest_channels.hpp"
#include "proofmass/characterise/noise_analysis.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/io/recording_stream.hpp"
#include "proofmass/report/noise/report.hpp"

// The noise of recordings that are larger than memory.
namespace proofmass::app {

/// A channel whose noise is analysed: what it is, and what is shown of it.
struct NoiseChannel {
  RestChannel rest;
  report::ChannelNoise shown;
};

/// Analyses the channels in one pass over the recording. Throws Failure, also where the options ask
/// for what needs the whole of it in memory.
[[nodiscard]] std::vector<NoiseChannel> analyse_pieces(io::RecordingStream stream,
                                                       const RestOptions& options,
                                                       const characterise::NoiseOptions& noise,
                                                       std::vector<Note>& notes);

}  // namespace proofmass::app
