#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "proofmass/characterise/temperature_model.hpp"
#include "proofmass/core/view.hpp"

namespace proofmass::characterise {

/// An interval of time with its means.
struct TemperatureBlock {
  std::size_t begin = 0, end = 0;  ///< samples
  double place = 0.0;              ///< its number, missing ones counted
  double mean = 0.0, temperature_k = 0.0;
  double crowd =
      1.0;  ///< blocks about its temperature, as the weights take them; mean of 1/crowd 1
  Sweep sweep = Sweep::dwell;
};

struct TemperatureBlocks {
  std::vector<TemperatureBlock> blocks;
  double block_s = 0.0;
  double lowest_k = 0.0, highest_k = 0.0;
  double risen_k = 0.0, fallen_k = 0.0;  ///< up and down the temperature went, all in all
  double widest_gap_k = 0.0;             ///< between neighbouring temperatures
  double gap_from_k = 0.0;
  int occupied = 0;        ///< of twelve equal parts of the range
  bool both_ways = false;  ///< heating and cooling have at least a fifth of the range in common

  [[nodiscard]] double span_k() const { return highest_k - lowest_k; }
};

/// Up to 256 blocks of equal length, of at least 8 samples; one counts if half its samples have
/// both.
[[nodiscard]] TemperatureBlocks temperature_blocks(View<double> series,
                                                   View<double> temperature_k,
                                                   double rate_hz);

/// Orthogonal over the blocks' temperatures, each with weight 1/crowd, up to `degree`. Source: G.
/// E. Forsythe, J. SIAM 5 (1957) 74.
[[nodiscard]] OrthogonalPolynomials orthogonal_polynomials(const TemperatureBlocks& of, int degree);

/// Means of the polynomials over the samples of each block, one row a block: the mean of the curve
/// over the samples, not the curve at their mean.
[[nodiscard]] Eigen::MatrixXd block_means(const OrthogonalPolynomials& basis,
                                          const TemperatureBlocks& blocks,
                                          View<double> series,
                                          View<double> temperature_k);

/// By 24 equal parts of the range and by sweep, without empty ones.
[[nodiscard]] std::vector<TemperaturePoint> temperature_points(const TemperatureBlocks& blocks);

}  // namespace proofmass::characterise
