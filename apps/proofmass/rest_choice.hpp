#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/signal/audit.hpp"
#include "proofmass/signal/even_grid.hpp"

// Which channels of a recording at rest are analysed, and in what unit: of recordings in memory
// and of those that come a piece at a time.
namespace proofmass::app {

struct RestChoice {
  std::vector<std::size_t> channels;  ///< as places in the recording's
  std::vector<std::optional<std::size_t>>
      axes;  ///< of each: 0, 1, 2 of the only sensor of its kind
};

/// All accelerations; else the voltages or counts that look like axes; else all that is no counter.
/// Of channels that were named, all. `temperature` is none of them.
[[nodiscard]] RestChoice choose_rest(const Recording& recording,
                                     const std::optional<std::size_t>& temperature,
                                     bool named);

/// The unit that values in `unit` are brought to: SI, or as it is where they are left as recorded.
[[nodiscard]] Unit si_unit(const Unit& unit);

/// The unit of an analysed series whose values are in `unit`; of the rate, where the values are its
/// integral.
[[nodiscard]] Unit series_unit(const Unit& unit, bool is_phase);

/// Why a channel with so many samples at the rails is refused: their noise is cut off. Else empty.
[[nodiscard]] std::string clipping(const signal::ChannelAudit& audit, std::size_t samples);

/// Tells what is missing on the grid, in how many places, and how uneven the stamps are.
void tell_grid(const signal::EvenGrid& grid,
               std::size_t places,
               const std::string& prefix,
               std::vector<Note>& notes);

}  // namespace proofmass::app
