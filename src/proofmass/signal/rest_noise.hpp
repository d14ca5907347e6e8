#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "proofmass/signal/rest_blocks.hpp"

// How noisy the resting sensor is, learned from where the recording is quietest.
namespace proofmass::signal {

/// What the resting sensor does on each axis. Variances of one sample, but for the Allan variance.
struct RestNoise {
  PerAxis window_variance{};  ///< about the mean of its window
  PerAxis block_variance{};   ///< about the mean of its block
  PerAxis step_variance{};    ///< by the differences of neighbours, which see nothing slow
  /// Least Allan variance: below half a step of noise a mean moves by a step where the level
  /// crosses a code.
  PerAxis quantum_variance{};
  /// Of means over 2^scale blocks; to begin with, up to half a window.
  std::vector<PerAxis> allan_variance;
  /// How far means swing, 1 being the most that rest shows: the largest Allan variance over
  /// max(c · window_variance, 4 · step_variance), c = 0.8 up to half a window and 0.5 from one
  /// window to the next. Noise below one corner stays under c (0.4 at most), a swing does not; and
  /// a line may be 2.8 times as high as the noise.
  double unrest = 0.0;
  /// Whether windows of the set follow on others, so that their means were compared.
  bool followed = false;
};

/// The noise of the quietest well-filled set of windows; nullopt if there are fewer than eight.
///
/// With v_a the variance of a window on axis a, its level is the largest over the axes of ½ ln v_a
/// less its 5 % quantile, so that neither the unit nor different noise of the axes count and motion
/// along a single axis does. A set is what lies within ln 2 + 4/√(2 A (n − 1)), by how far χ²
/// scatters a mean over A axes of n samples each. Of the sets that begin within a factor of 4 of
/// the lowest the fullest is taken. If that swings, the lowest may do, or what is left of the
/// fullest without the windows whose halves differ. Figures are medians over the set, corrected to
/// means of χ².
[[nodiscard]] std::optional<RestNoise> find_rest_noise(const RestBlocks& blocks);

/// How much noisier blocks are than rest: Σ_a squares_a / σ_a² over its degrees of freedom.
[[nodiscard]] double loudness(const RestBlocks& blocks,
                              const RestNoise& noise,
                              std::size_t k,
                              std::size_t count);

/// A rest in another position may be so much noisier than all rests are, as a variance.
inline constexpr double most_noise_ratio = 9.0;

/// The noise of blocks over that of all rests, per axis, within 1 … most_noise_ratio.
[[nodiscard]] PerAxis noise_ratio(const RestBlocks& blocks,
                                  const RestNoise& noise,
                                  std::size_t k,
                                  std::size_t count);

/// The median of χ² with one degree of freedom.
inline constexpr double median_of_square = 0.454936;

}  // namespace proofmass::signal
