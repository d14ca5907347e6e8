#pragma once

#include "proofmass/report/noise/report.hpp"

// Entries of the document of `noise`.
namespace proofmass::report {

/// The entries of a channel.
[[nodiscard]] Fields noise_fields(const ChannelNoise& channel);

/// Spectrum with its floor and lines, and events in time.
[[nodiscard]] Fields noise_spectrum_fields(const ChannelNoise& channel);

}  // namespace proofmass::report
