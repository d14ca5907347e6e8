#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "proofmass/signal/rests/blocks.hpp"
#include "proofmass/signal/rests/noise.hpp"

// Runs of blocks in which neither the noise nor the mean indicates motion.
namespace proofmass::signal {

/// Blocks from first to end − 1; neither the first nor the last is missing.
struct RestRun {
  std::size_t first, end;
  [[nodiscard]] std::size_t size() const { return end - first; }
};

/// Maximum noise of blocks and of windows of blocks: Σ_a squares_a / σ_a² ≤ 9 χ²_{1−p}(Σ_a (n −
/// 1)).
struct QuietTest {
  double block_bound, window_bound;  ///< bounds on loudness()

  explicit QuietTest(const RestBlocks& blocks);
  [[nodiscard]] bool passes(const RestBlocks& blocks, const RestNoise& noise, std::size_t k) const {
    return loudness(blocks, noise, k, 1) <= block_bound;
  }
};

/// Removes one outlier from each block that is quiet without it.
void clean_outliers(View<View<double>> axes, RestBlocks& blocks, const RestNoise& noise);

/// Runs of half a window and more that repeat one value.
[[nodiscard]] std::vector<RestRun> constant_runs(const RestBlocks& blocks);

/// The noise of the sensor, without blocks in which it was stuck (constant_runs()): they are
/// excluded from `blocks`, unless they are a third of them or the sensor's noise does not exceed
/// its quantisation step, since it may then be constant at rest.
[[nodiscard]] std::optional<RestNoise> find_noise_and_drop_stuck(RestBlocks& blocks);

/// Excludes runs that repeat one value although the sensor's noise exceeds the quantisation step.
void drop_stuck(RestBlocks& blocks, const RestNoise& noise);

/// Runs of blocks that are quiet, individually and in windows. More than a window of consecutive
/// missing blocks splits a run.
[[nodiscard]] std::vector<RestRun> quiet_runs(const RestBlocks& blocks, const RestNoise& noise);

/// The parts of the runs in which the means m of adjacent windows over 1, 2, 4, … blocks up to 16
/// variance windows agree:
///
///     Σ_a (m_a⁺ − m_a⁻)² / (2 r_a σ_a²(τ)) ≤ 2.25 χ²_{1−p}(A),
///
/// σ²(τ) the Allan variance at rest and r_a the run's noise_ratio.
///
/// - From one window on, σ²(τ) is the median over the remaining runs. It may grow with τ at most as
///   for a random walk, and is constant, as for flicker noise, if there is too little data. It is
///   added to `noise`.
/// - p corresponds to one recording in a hundred with a false alarm.
/// - A run is cut where the means differ, so that a step splits it. Where the run drifts, blocks
///   between two cuts, or closer than τ to one, are lost.
[[nodiscard]] std::vector<RestRun> still_runs(const RestBlocks& blocks,
                                              RestNoise& noise,
                                              std::vector<RestRun> runs);

}  // namespace proofmass::signal
