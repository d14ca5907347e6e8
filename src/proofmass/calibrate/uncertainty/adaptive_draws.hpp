#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "proofmass/core/progress.hpp"

namespace proofmass::calibrate {

struct AdaptiveOptions {
  std::size_t batch = 10000;   ///< draws of one batch, at least 10⁴ for a 95 % interval
  std::size_t most = 1000000;  ///< draws in all
  int digits = 2;              ///< significant digits of a standard uncertainty that must be stable
  Progress progress = {};
};

/// Fills one batch: a column of equal length for each output, NaN where a draw has no result. It
/// depends on nothing but the batch's number, and may be called from several threads.
using FillBatch = std::function<void(std::size_t batch, std::span<std::vector<double>> columns)>;

struct AdaptiveDraws {
  std::vector<std::vector<double>> columns;  ///< the draws of each output, batch after batch
  /// Two standard errors of each output's mean, standard deviation and ends of its symmetric 95 %
  /// interval are below half of the last of `digits` significant digits of its standard deviation.
  bool stable = false;
};

/// The adaptive Monte Carlo procedure: batches until the averages over the batches are stable.
/// Source: JCGM 101:2008, 7.9.4. The result does not depend on the number of threads.
[[nodiscard]] AdaptiveDraws draw_until_stable(std::size_t outputs,
                                              const FillBatch& fill,
                                              const AdaptiveOptions& options = {});

}  // namespace proofmass::calibrate
