#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include "proofmass/core/view.hpp"
#include "proofmass/signal/events/kernels.hpp"

// Threshold of an event: a multiple of the filter output's standard deviation, estimated over short
// blocks, that noise with this tail exceeds once in a hundred records.
namespace proofmass::signal {

/// Tally of the outputs that are not NaN.
[[nodiscard]] Tally tally(View<double> outputs);

/// In blocks of coarse_block outputs; the last may be shorter.
[[nodiscard]] std::vector<Tally> tallies(View<double> outputs);

/// Threshold for the outputs, per block.
struct Bar {
  std::size_t group = 1;      ///< blocks that share a scale
  std::vector<double> scale;  ///< standard deviation of the output, per group
  double sigmas = 0.0;

  [[nodiscard]] double scale_at(std::size_t block) const {
    return scale[std::min(block / group, scale.size() - 1)];
  }
  /// Infinite if the scale is 0: too few outputs to estimate it.
  [[nodiscard]] double at(std::size_t block) const {
    const double here = scale_at(block);
    return here > 0.0 ? sigmas * here : std::numeric_limits<double>::infinity();
  }
};

/// Number of blocks that share a scale: half a minute, at least 16.
[[nodiscard]] std::size_t group_of(double rate_hz, std::size_t samples_per_block);

/// For each group of blocks the median of √(π/2) · mean |output|: the largest of its own, those of
/// the adjacent groups, that of the record and `floor`.
[[nodiscard]] std::vector<double> group_scales(const std::vector<Tally>& blocks,
                                               std::size_t group,
                                               double floor);

/// √(2 ln 1000 n) standard deviations for n outputs, or the level that a Gumbel law through the
/// quartiles of the blocks' largest outputs reaches once in a hundred records, whichever is larger.
[[nodiscard]] Bar bar_of(const std::vector<Tally>& blocks,
                         std::size_t group,
                         double floor,
                         std::size_t outputs);

}  // namespace proofmass::signal
