#pragma once

#include <cstddef>
#include <vector>

#include "proofmass/signal/rest_blocks.hpp"
#include "proofmass/signal/rest_noise.hpp"

// Runs of blocks in which neither the noise nor the mean tells of motion.
namespace proofmass::signal {

/// Blocks from first to end − 1, of which neither the first nor the last is missing.
struct RestRun {
  std::size_t first, end;
  [[nodiscard]] std::size_t size() const { return end - first; }
};

/// How loud blocks and windows of them may be: Σ_a squares_a / σ_a² ≤ 9 χ²_{1−p}(Σ_a (n − 1)).
struct QuietTest {
  double block_bound, window_bound;  ///< of loudness()

  explicit QuietTest(const RestBlocks& blocks);
  [[nodiscard]] bool passes(const RestBlocks& blocks, const RestNoise& noise, std::size_t k) const {
    return loudness(blocks, noise, k, 1) <= block_bound;
  }
};

/// Takes one outlier out of each block that is quiet without it.
void clean_outliers(View<View<double>> axes, RestBlocks& blocks, const RestNoise& noise);

/// Takes out windows that repeat one reading where the sensor has more noise than its converter
/// hides.
void drop_stuck(RestBlocks& blocks, const RestNoise& noise);

/// Runs of blocks that are quiet, each for itself and in windows. Missing blocks divide a run where
/// more than a window of them follow each other.
[[nodiscard]] std::vector<RestRun> quiet_runs(const RestBlocks& blocks, const RestNoise& noise);

/// What remains of the runs where the means m of neighbouring windows over 1, 2, 4, … blocks up to
/// 16 windows of the variance agree:
///
///     Σ_a (m_a⁺ − m_a⁻)² / (2 r_a σ_a²(τ)) ≤ 2.25 χ²_{1−p}(A),
///
/// σ²(τ) being the Allan variance at rest and r_a the run's noise_ratio. From one window on σ²(τ)
/// is the median over the runs that are left; it may grow with τ as for a random walk, not faster,
/// and stays where there are too few data, as for flicker noise. It is added to `noise`. p is such
/// that one recording in a hundred has a false alarm.
///
/// A run is cut where the means differ, so that a step divides it; blocks between two cuts or
/// nearer than τ to one are lost where the run creeps.
[[nodiscard]] std::vector<RestRun> still_runs(const RestBlocks& blocks,
                                              RestNoise& noise,
                                              std::vector<RestRun> runs);

}  // namespace proofmass::signal
