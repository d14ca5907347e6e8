#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/signal/audit.hpp"
#include "proofmass/signal/even_grid.hpp"

// Choice of the channels and units for the analysis of a recording at rest, whole or in pieces.
namespace proofmass::app {

struct RestChoice {
  std::vector<std::size_t> channels;             ///< indices in the recording
  std::vector<std::optional<std::size_t>> axes;  ///< of each channel: 0, 1, 2 of the only
                                                 ///< sensor of its kind
};

/// All accelerations; else the voltages or counts that look like axes; else everything but
/// counters. All of the channels that were named, if any. Never `temperature`.
[[nodiscard]] RestChoice choose_rest(const Recording& recording,
                                     const std::optional<std::size_t>& temperature,
                                     bool named);

/// Unit after conversion: SI, or unchanged if there is no conversion.
[[nodiscard]] Unit si_unit(const Unit& unit);

/// Unit of the analysed series for values in `unit`; that of the rate if the values are its
/// integral.
[[nodiscard]] Unit series_unit(const Unit& unit, bool is_phase);

/// Reason to refuse a channel with this number of clipped samples, whose noise is truncated; empty
/// if acceptable.
[[nodiscard]] std::string clipping(const signal::ChannelAudit& audit, std::size_t samples);

/// Notes missing grid points, their number of gaps, and irregular stamps.
void note_grid(const signal::EvenGrid& grid,
               std::size_t places,
               const std::string& prefix,
               std::vector<Note>& notes);

}  // namespace proofmass::app
