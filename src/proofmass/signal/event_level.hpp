#pragma once

#include <cstddef>
#include <vector>

#include "proofmass/core/view.hpp"
#include "proofmass/signal/event_findings.hpp"
#include "proofmass/signal/event_kernels.hpp"
#include "proofmass/signal/event_source.hpp"

// The series as block means, from which the coarse scales take their windows.
namespace proofmass::signal {

/// Means of the series over blocks, and the share of each that is there.
struct Level {
  std::size_t block = base_block;  ///< samples
  std::vector<double> mean;
  std::vector<float> weight;
};

/// Over blocks of base_block samples; those after the last whole block are left out.
[[nodiscard]] Level base_level(const Source& source);

/// Over blocks of twice the length.
[[nodiscard]] Level halved(const Level& level);

/// Means over `width` blocks, 1, 2 or 4, from each block on; NaN where too few samples are there:
/// the mean of the rest does not lie at the middle, where lines and drift are felt.
[[nodiscard]] std::vector<double> windows(const Level& level, std::size_t width);

/// Takes the steps out of the level; a block that holds one is missing.
void level_out(Level& level, View<Step> steps);

}  // namespace proofmass::signal
