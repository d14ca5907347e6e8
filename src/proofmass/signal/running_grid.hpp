#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "proofmass/core/block.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/core/view.hpp"
#include "proofmass/signal/even_grid.hpp"
#include "proofmass/signal/resample/hole_finder.hpp"

namespace proofmass::signal {

/// Receives a few consecutive grid points: one view per channel, of equal length, NaN where there
/// is no plausible sample. The views are valid during the call.
using GridSink = std::function<void(std::span<const View<double>> channels)>;

/// Maps a recording in blocks onto an even grid; identical point by point to even_grid() and
/// on_even_grid() of the whole recording. A sample after a long interval waits for the eight that
/// follow it; the others are passed on at once.
///
/// Positions depend on the nominal rate alone. The mean rate of the grid is known only at the end
/// and does not change them.
class RunningEvenGrid {
 public:
  /// time: its rate must be known; stamps are ignored. expected_samples: 0 if unknown.
  RunningEvenGrid(const TimeBase& time, std::size_t channels, std::size_t expected_samples = 0);

  /// The next samples; with stamps in every block or in none. The sink gets at most 4096 points per
  /// call, however long a hole is.
  /// Errors: corrupt (gaps far longer than the recording can be; see finish()).
  [[nodiscard]] Status add(const Block& block, const GridSink& sink);

  /// Passes on the pending samples; call once, after all are added. At most most_holes holes are
  /// listed.
  /// Errors: as even_grid().
  [[nodiscard]] Result<EvenGrid> finish(const GridSink& sink);

  /// Number of holes so far.
  [[nodiscard]] std::size_t hole_count() const { return finder_.hole_count(); }

  static constexpr std::size_t most_holes = std::size_t{1} << 20;

 private:
  void lay(const Block& block, const GridSink& sink);
  void copy(const Block& block, std::size_t from, std::size_t to, const GridSink& sink);
  void skip(std::size_t places, const GridSink& sink);
  void flush(const GridSink& sink);

  HoleFinder finder_;
  std::size_t expected_;
  std::size_t laid_ = 0;                   ///< samples passed on or in the current piece
  std::vector<std::vector<double>> held_;  ///< pending samples, one vector per channel
  std::vector<std::vector<double>> piece_;
  std::size_t filled_ = 0;  ///< points in the current piece
  std::vector<Hole> fresh_, listed_;
  bool has_stamps_ = false;
};

}  // namespace proofmass::signal
