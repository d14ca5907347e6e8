#pragma once

#include <Eigen/Core>

#include "proofmass/characterise/run_set.hpp"

namespace proofmass::characterise {

/// Runs over their common length as block means.
struct RunBlocks {
  double duration_s = 0.0;
  double block_s = 0.0;
  Eigen::MatrixXd means;   ///< a row a block, a column a run; NaN where half a block is missing
  Eigen::VectorXd level;   ///< of each run
  Eigen::VectorXd common;  ///< common to all runs, a value a block, of mean
};

/// The blocks of the noise fit; the number of RunBlocks is a multiple.
inline constexpr int noise_blocks = 64;

/// Up to 2048 blocks of at least four samples, and the least-squares fit of means = level + common.
/// Errors: those of compare_runs.
[[nodiscard]] Result<RunBlocks> run_blocks(View<Run> runs);

/// means − level − common over noise_blocks blocks, with missing ones interpolated.
[[nodiscard]] Eigen::MatrixXd residuals(const RunBlocks& of);

/// Mean of the finite samples of a run from_s <= t < to_s; NaN where there is none.
[[nodiscard]] double mean_between(const Run& run, double from_s, double to_s);

}  // namespace proofmass::characterise
