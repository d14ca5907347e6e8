#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "proofmass/signal/event_findings.hpp"
#include "proofmass/signal/event_kernels.hpp"
#include "proofmass/signal/event_source.hpp"
#include "proofmass/signal/event_thresholds.hpp"

// The knock filter over windows of 1, 2, 4 and 8 samples. Every sample is filtered once to know how
// the outputs scatter, and once more only in the blocks where one stood out.
namespace proofmass::signal {

inline constexpr std::size_t fine_scales = 4;

/// One tally for every block of every scale.
using FineTallies = std::array<std::vector<Tally>, fine_scales>;

/// Where the filter lacks samples, of the departure from those that are there.
[[nodiscard]] FineTallies tally_fine_scales(const Source& source);

/// Looks again, with a level that the knock itself does not move, where a block stood out.
[[nodiscard]] std::vector<Hit> hits_on_fine_scales(const Source& source,
                                                   const FineTallies& blocks,
                                                   const std::array<Bar, fine_scales>& bars);

}  // namespace proofmass::signal
