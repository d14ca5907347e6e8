#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "proofmass/core/view.hpp"
#include "proofmass/signal/dyadic_ladder.hpp"
#include "proofmass/signal/rests.hpp"

// Whether the sensor lies still, told while the samples come.
namespace proofmass::signal {

enum class RestPhase {
  listening,  ///< nothing has been quiet for long enough to know the sensor's noise
  moving,
  settling,  ///< as quiet as at rest, but not for long enough, or its mean still creeps
  resting,
  stuck,  ///< one reading is repeated, by a sensor that has noise
};

struct RestState {
  RestPhase phase = RestPhase::listening;
  double since_s = 0.0, until_s = 0.0;  ///< of resting: its first and last sample
  std::size_t samples = 0;              ///< behind the mean: those of the last half minute
  std::array<double, 3> mean{};         ///< of the rest, axis by axis
  std::array<double, 3> noise_std{};    ///< of one sample about the mean of its block
  std::array<double, 3> step{};         ///< of the converter; 0 where none shows
  /// The newest block's mean, at rest or not; valid where it has samples.
  std::array<double, 3> newest_mean{};
  double newest_s = 0.0;  ///< its end
  bool newest_there = false;
};

/// Finds rests as find_rests() does, with the same tests, in the last 512 blocks (half a minute at
/// 64 Hz and above), each time a block is full.
///
/// The noise is that of the quietest well-filled set of windows in these blocks, once they span
/// three seconds and their means do not swing. It is kept while the sensor moves, follows a noise
/// that falls, or rises by half at most, and is learned anew where nothing was at rest for as long
/// as the memory reaches.
///
/// A rest begins a window later than there, behind what is left of settling: live, there is time
/// for that. It ends two blocks before the newest: motion that has just begun does not show yet. A
/// knock ends it; what follows is another rest. Where stamps step by more than a window, or back,
/// nobody knows what happened in between, and a rest ends.
///
/// Memory: 512 blocks and the samples of one. Cost: about 0.2 ms a block, that is 3 ms for a second
/// of samples.
class RunningRests {
 public:
  /// One to three axes. options.rate_hz 0: it is measured from the first two seconds' stamps.
  RunningRests(std::size_t axes, const RestOptions& options);
  RunningRests(RunningRests&&) noexcept;
  RunningRests& operator=(RunningRests&&) noexcept;
  ~RunningRests();

  /// One sample of all axes, its time in seconds. True: a block is full, and state() is new.
  /// Values that are no measurement (is_plausible) count as missing.
  bool add(double time_s, View<double> values);

  [[nodiscard]] const RestState& state() const;
  /// Of the rest, on one axis: over 1 sample, 1, 2, 4, … blocks. Empty where it does not rest.
  [[nodiscard]] std::vector<AllanLevel> levels(std::size_t axis) const;
  [[nodiscard]] std::size_t samples_a_block() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace proofmass::signal
