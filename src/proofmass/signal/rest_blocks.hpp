#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "proofmass/core/view.hpp"

// The series as short blocks, which is all that the search for rests looks at.
namespace proofmass::signal {

inline constexpr std::size_t most_axes = 3;
using PerAxis = std::array<double, most_axes>;

/// What a block's samples come to, of those that are there on every axis.
struct RestBlock {
  double count = 0.0;
  PerAxis mean{};
  PerAxis squares{};     ///< Σ (x − mean)²
  PerAxis steps{};       ///< Σ (x[k] − x[k−1])²
  bool cleaned = false;  ///< of one outlier
};

struct RestBlocks {
  std::size_t samples = 0;  ///< of the series
  std::size_t axes = 0;
  std::size_t block = 0;   ///< samples; the last block may hold up to twice as many
  std::size_t window = 0;  ///< blocks over which the variance is taken
  std::vector<RestBlock> at;
  std::vector<unsigned char> there;  ///< of each sample, whether every axis has a measurement
  PerAxis quantum{};                 ///< step of the converter, 0 where none shows
  PerAxis variance_floor{};          ///< below it a variance is one of rounding

  [[nodiscard]] std::size_t first_sample(std::size_t k) const { return k * block; }
  [[nodiscard]] std::size_t end_sample(std::size_t k) const {
    return k + 1 == at.size() ? samples : (k + 1) * block;
  }
  [[nodiscard]] bool missing(std::size_t k) const {
    return 2.0 * at[k].count < static_cast<double>(block);
  }
};

/// Below it a variance is one of rounding: of a converter's steps, or of numbers up to `largest`.
[[nodiscard]] double variance_floor(double quantum, double largest);

/// None yet, with their lengths for windows of so many samples.
[[nodiscard]] RestBlocks no_blocks(std::size_t axes, std::size_t window);

/// Blocks of an eighth of `window` samples, 4 at least. A sample that is no measurement on one axis
/// (is_plausible) counts on none. Expects one to three axes of the same length.
[[nodiscard]] RestBlocks blocks_of(View<View<double>> axes, std::size_t window);

/// Block k less the sample that lies farthest from its median, in units of `variance`.
[[nodiscard]] RestBlock without_outlier(View<View<double>> axes,
                                        const RestBlocks& blocks,
                                        std::size_t k,
                                        const PerAxis& variance);

/// The blocks k … k + count − 1 in one, without `steps`.
[[nodiscard]] RestBlock joined(const RestBlocks& blocks, std::size_t k, std::size_t count);

/// Sums over windows of 1, 2, 4, … blocks, from each block on.
struct BlockSums {
  std::size_t width = 1;      ///< blocks
  std::vector<double> count;  ///< samples in the window
  std::array<std::vector<double>, most_axes> sum;

  explicit BlockSums(const RestBlocks& blocks);
  /// Takes windows of twice the width.
  void widen();
  /// Half the squared difference between the means of the window at k and of the next one, whose
  /// mean is the Allan variance; 0 where one is empty.
  [[nodiscard]] double half_square(std::size_t axis, std::size_t k) const;
};

}  // namespace proofmass::signal
