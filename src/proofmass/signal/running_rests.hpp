#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "proofmass/core/view.hpp"
#include "proofmass/signal/audit/dyadic_allan.hpp"
#include "proofmass/signal/rests.hpp"

// Online detection of static intervals.
namespace proofmass::signal {

enum class RestPhase {
  listening,  ///< no interval quiet enough yet to determine the sensor's noise
  moving,
  settling,  ///< as quiet as at rest, but too short, or its mean still drifts
  resting,
  stuck,  ///< one value is repeated, by a sensor that has noise
};

struct RestState {
  RestPhase phase = RestPhase::listening;
  double since_s = 0.0, until_s = 0.0;  ///< while resting: first and last sample
  std::size_t samples = 0;              ///< used for the mean: those of the last half minute
  std::array<double, 3> mean{};         ///< mean of the rest, per axis
  std::array<double, 3> noise_std{};    ///< std of one sample about the mean of its block
  std::array<double, 3> step{};         ///< quantisation step; 0 if none is visible
  /// Mean of the newest block, static or not; valid if it has samples.
  std::array<double, 3> newest_mean{};
  double newest_s = 0.0;  ///< end of the newest block
  bool newest_there = false;
};

/// Detects rests as find_rests() does, with the same tests, over the last 512 blocks (half a minute
/// at 64 Hz and above), each time a block is complete.
///
/// - The noise is that of the quietest well-filled set of windows in these blocks, once they span
///   three seconds and their means are steady. It is kept during motion, follows a decreasing
///   noise, may rise by at most half, and is estimated again if nothing in the memory was static.
/// - A rest begins one window later than in find_rests(), after any remaining settling.
/// - It ends two blocks before the newest: motion that has just begun is not detectable yet.
/// - A shock ends it; another rest follows. Stamps that jump by more than a window, or backwards,
///   end it as well.
///
/// Memory: 512 blocks and the samples of one. Cost: about 0.2 ms per block, that is 3 ms per second
/// of samples.
class RunningRests {
 public:
  /// One to three axes. If options.rate_hz is 0, the rate is estimated from the first two seconds
  /// of stamps.
  RunningRests(std::size_t axes, const RestOptions& options);
  RunningRests(RunningRests&&) noexcept;
  RunningRests& operator=(RunningRests&&) noexcept;
  ~RunningRests();

  /// Adds one sample of all axes, its time in seconds. Returns true if a block is complete and
  /// state() is new. Implausible values (is_plausible) count as missing.
  bool add(double time_s, View<double> values);

  [[nodiscard]] const RestState& state() const;
  /// Allan variances of the rest on one axis: over 1 sample, 1, 2, 4, … blocks. Empty unless at
  /// rest.
  [[nodiscard]] std::vector<AllanLevel> levels(std::size_t axis) const;
  [[nodiscard]] std::size_t samples_a_block() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace proofmass::signal
