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

/// Runs of blocks that are quiet, each for itself (less one outlier, if that helps, of which
/// `blocks` is then cleaned) and in windows:
///
///     Σ_a squares_a / σ_a² ≤ 9 χ²_{1−p}(Σ_a (n − 1)).
///
/// Missing blocks divide a run where more than a window of them follow each other.
[[nodiscard]] std::vector<RestRun> quiet_runs(View<View<double>> axes,
                                              RestBlocks& blocks,
                                              const RestNoise& noise);

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
