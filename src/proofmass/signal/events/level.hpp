#pragma once

#include <cstddef>
#include <vector>

#include "proofmass/core/view.hpp"
#include "proofmass/signal/events/findings.hpp"
#include "proofmass/signal/events/kernels.hpp"
#include "proofmass/signal/events/source.hpp"

// The series as block means, the input of the coarse scales.
namespace proofmass::signal {

/// Means of the series over blocks, and the fraction of each that is present.
struct Level {
  std::size_t block = base_block;  ///< samples
  std::vector<double> mean;
  std::vector<float> weight;
};

/// Over blocks of base_block samples; samples after the last whole block are omitted.
[[nodiscard]] Level base_level(const Source& source);

/// Over blocks of twice the length.
[[nodiscard]] Level halved(const Level& level);

/// Means over `width` blocks, 1, 2 or 4, starting at each block; NaN if too few samples are
/// present, because the mean of the others is not centred and responds to lines and drift.
[[nodiscard]] std::vector<double> windows(const Level& level, std::size_t width);

/// Removes the steps from the level; a block that contains one is missing.
void level_out(Level& level, View<Step> steps);

}  // namespace proofmass::signal
