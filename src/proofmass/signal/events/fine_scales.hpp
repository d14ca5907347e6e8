#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "proofmass/signal/events/findings.hpp"
#include "proofmass/signal/events/kernels.hpp"
#include "proofmass/signal/events/source.hpp"
#include "proofmass/signal/events/thresholds.hpp"

// The outlier filter over windows of 1, 2, 4 and 8 samples. Every sample is filtered once to
// determine the scatter of the outputs, and again only in the blocks with a detection.
namespace proofmass::signal {

inline constexpr std::size_t fine_scales = 4;

/// One tally per block and scale.
using FineTallies = std::array<std::vector<Tally>, fine_scales>;

/// Where the filter lacks samples, tallies the deviation from those present.
[[nodiscard]] FineTallies tally_fine_scales(const Source& source);

/// Filters the blocks with a detection again, with a level that excludes the outlier itself.
[[nodiscard]] std::vector<Hit> hits_on_fine_scales(const Source& source,
                                                   const FineTallies& blocks,
                                                   const std::array<Bar, fine_scales>& bars);

}  // namespace proofmass::signal
