#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "proofmass/signal/rests/blocks.hpp"

// Noise of the static sensor, estimated where the recording is quietest.
namespace proofmass::signal {

/// Noise of the static sensor on each axis. Variances of one sample, except for the Allan variance.
struct RestNoise {
  PerAxis window_variance{};  ///< about the mean of its window
  PerAxis block_variance{};   ///< about the mean of its block
  PerAxis step_variance{};    ///< from differences of adjacent samples, free of slow motion
  /// Lower bound of the Allan variance: with noise below half a quantisation step, a mean moves by
  /// a step where the level crosses a code.
  PerAxis quantum_variance{};
  /// For means over 2^scale blocks; initially up to half a window.
  std::vector<PerAxis> allan_variance;
  /// Instability of the means, 1 being the maximum for a rest: the largest Allan variance over
  /// max(c · window_variance, 4 · step_variance), c = 0.8 up to half a window and 0.5 between
  /// adjacent windows. Noise below one corner stays under c (0.4 at most), an oscillation does not;
  /// and a line may be 2.8 times as high as the noise.
  double unrest = 0.0;
  /// True if the set contains consecutive windows, so that their means were compared.
  bool followed = false;
};

/// Noise of the quietest well-filled set of windows; nullopt if there are fewer than eight windows.
///
/// - Level of a window: with v_a its variance on axis a, the largest over the axes of ½ ln v_a
///   minus its 5 % quantile. Neither the unit nor different noise of the axes matter, and motion
///   along a single axis counts.
/// - A set holds the windows within ln 2 + 4/√(2 A (n − 1)) of its lowest level: the χ² scatter of
///   a mean over A axes of n samples each.
/// - Of the sets that begin within a factor of 4 of the lowest, the largest is used. If its means
///   are unstable, the lowest set is tried, or the largest without the windows whose halves differ.
/// - The results are medians over the set, corrected to means of χ².
[[nodiscard]] std::optional<RestNoise> find_rest_noise(const RestBlocks& blocks);

/// Noise of blocks relative to rest: Σ_a squares_a / σ_a² over its degrees of freedom.
[[nodiscard]] double loudness(const RestBlocks& blocks,
                              const RestNoise& noise,
                              std::size_t k,
                              std::size_t count);

/// Maximum variance of a rest in another position, relative to that of all rests.
inline constexpr double most_noise_ratio = 9.0;

/// The noise of blocks relative to that of all rests, per axis, limited to 1 … most_noise_ratio.
[[nodiscard]] PerAxis noise_ratio(const RestBlocks& blocks,
                                  const RestNoise& noise,
                                  std::size_t k,
                                  std::size_t count);

/// The median of χ² with one degree of freedom.
inline constexpr double median_of_square = 0.454936;

}  // namespace proofmass::signal
