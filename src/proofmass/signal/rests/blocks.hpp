#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "proofmass/core/view.hpp"

// The series as short blocks, the only input of the search for rests.
namespace proofmass::signal {

inline constexpr std::size_t most_axes = 3;
using PerAxis = std::array<double, most_axes>;

/// Sums over a block's samples that are present on every axis.
struct RestBlock {
  double count = 0.0;
  PerAxis mean{};
  PerAxis squares{};     ///< Σ (x − mean)²
  PerAxis steps{};       ///< Σ (x[k] − x[k−1])²
  bool cleaned = false;  ///< one outlier was removed
};

/// One column for each member of RestBlock: most steps of the search read two of them.
struct RestBlocks {
  using AxisColumns = std::array<std::vector<double>, most_axes>;

  std::size_t samples = 0;  ///< length of the series, in samples
  std::size_t axes = 0;
  std::size_t block = 0;   ///< samples per block; the last block may hold up to twice as many
  std::size_t window = 0;  ///< blocks per variance window
  std::vector<double> count;
  AxisColumns mean, squares, steps;
  std::vector<unsigned char> cleaned;
  /// Per sample: true if every axis has a measurement. Empty if that is true of all.
  std::vector<unsigned char> there;
  PerAxis quantum{};         ///< quantisation step, 0 if none is visible
  PerAxis variance_floor{};  ///< a smaller variance is due to rounding

  [[nodiscard]] std::size_t size() const { return count.size(); }
  [[nodiscard]] RestBlock at(std::size_t k) const;
  void set(std::size_t k, const RestBlock& to);
  void resize(std::size_t size);
  void drop_first();

  [[nodiscard]] bool is_there(std::size_t sample) const { return there.empty() || there[sample]; }
  [[nodiscard]] std::size_t samples_there() const;
  [[nodiscard]] std::size_t first_sample(std::size_t k) const { return k * block; }
  [[nodiscard]] std::size_t end_sample(std::size_t k) const {
    return k + 1 == size() ? samples : (k + 1) * block;
  }
  [[nodiscard]] bool missing(std::size_t k) const {
    return 2.0 * count[k] < static_cast<double>(block);
  }
};

/// Variance below which the noise is rounding: of the quantisation step, or of numbers up to
/// `largest`.
[[nodiscard]] double variance_floor(double quantum, double largest);

/// No blocks yet, with block lengths for windows of `window` samples.
[[nodiscard]] RestBlocks no_blocks(std::size_t axes, std::size_t window);

/// Blocks of an eighth of `window` samples, at least 4. A sample that is implausible on one axis
/// (is_plausible) is excluded on all. Expects one to three axes of equal length.
[[nodiscard]] RestBlocks blocks_of(View<View<double>> axes, std::size_t window);

/// Block k without the sample farthest from its median, in units of `variance`.
[[nodiscard]] RestBlock without_outlier(View<View<double>> axes,
                                        const RestBlocks& blocks,
                                        std::size_t k,
                                        const PerAxis& variance);

/// The blocks k … k + count − 1 merged, without `steps`.
[[nodiscard]] RestBlock joined(const RestBlocks& blocks, std::size_t k, std::size_t count);

/// Sums over windows of 1, 2, 4, … blocks, starting at each block.
struct BlockSums {
  std::size_t width = 1;      ///< blocks
  std::vector<double> count;  ///< samples in the window
  std::array<std::vector<double>, most_axes> sum;

  explicit BlockSums(const RestBlocks& blocks);
  /// Doubles the width of the windows.
  void widen();
  /// Half the squared difference between the means of the window at k and of the next one, whose
  /// mean is the Allan variance; 0 if one is empty.
  [[nodiscard]] double half_square(std::size_t axis, std::size_t k) const;
};

}  // namespace proofmass::signal
