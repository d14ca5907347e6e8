#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include "proofmass/core/view.hpp"
#include "proofmass/signal/event_kernels.hpp"

// What the output of a filter must exceed to be an event: so many of its own standard deviations,
// as short blocks of it show them, that noise of this tail does so once in a hundred records.
namespace proofmass::signal {

/// Of the outputs that are not NaN.
[[nodiscard]] Tally tally(View<double> outputs);

/// By blocks of coarse_block outputs; the last may be shorter.
[[nodiscard]] std::vector<Tally> tallies(View<double> outputs);

/// What an output must exceed, block by block.
struct Bar {
  std::size_t group = 1;      ///< blocks that share a scale
  std::vector<double> scale;  ///< standard deviation of the output, of each group
  double sigmas = 0.0;

  [[nodiscard]] double scale_at(std::size_t block) const {
    return scale[std::min(block / group, scale.size() - 1)];
  }
  /// Infinite where the scale is 0: too few outputs to know one by.
  [[nodiscard]] double at(std::size_t block) const {
    const double here = scale_at(block);
    return here > 0.0 ? sigmas * here : std::numeric_limits<double>::infinity();
  }
};

/// Blocks that share a scale: those of half a minute, 16 at least.
[[nodiscard]] std::size_t group_of(double rate_hz, std::size_t samples_per_block);

/// For each group of blocks the median of √(π/2) · mean |output|, the largest of its own, those of
/// the groups beside it, that of the record and `floor`.
[[nodiscard]] std::vector<double> group_scales(const std::vector<Tally>& blocks,
                                               std::size_t group,
                                               double floor);

/// √(2 ln 1000 n) standard deviations for n outputs, or what a Gumbel law through the quartiles of
/// the blocks' largest outputs reaches once in a hundred records, if that is more.
[[nodiscard]] Bar bar_of(const std::vector<Tally>& blocks,
                         std::size_t group,
                         double floor,
                         std::size_t outputs);

}  // namespace proofmass::signal
