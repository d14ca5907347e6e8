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
#include "proofmass/signal/hole_finder.hpp"

namespace proofmass::signal {

/// Takes a few consecutive places of the grid: one view a channel, equally long, NaN where there is
/// no sample or none that is_plausible. The views are valid during the call.
using GridSink = std::function<void(std::span<const View<double>> channels)>;

/// Lays a recording that comes in pieces on an even grid: what even_grid() and on_even_grid() do of
/// a whole one, place by place the same. A sample behind a long step waits for the eight that
/// follow it; the others go on at once.
///
/// Where a sample stands hangs on the nominal rate alone. The rate that the grid has over the whole
/// duration is only known at the end; it moves no place.
class RunningEvenGrid {
 public:
  /// time: its rate, which must be known; stamps are not looked at. expected_samples: 0 if not
  /// known.
  RunningEvenGrid(const TimeBase& time, std::size_t channels, std::size_t expected_samples = 0);

  /// The samples behind those added before; with stamps in every block or in none. The sink gets
  /// pieces of at most 4096 places, however long a hole is.
  /// Errors: corrupt (gaps by far longer than the recording can be; see finish()).
  [[nodiscard]] Status add(const Block& block, const GridSink& sink);

  /// Hands over what was waiting; once, when all is added. Of the holes the first most_holes are
  /// listed.
  /// Errors: as of even_grid().
  [[nodiscard]] Result<EvenGrid> finish(const GridSink& sink);

  /// Holes so far, all of them.
  [[nodiscard]] std::size_t hole_count() const { return finder_.hole_count(); }

  static constexpr std::size_t most_holes = std::size_t{1} << 20;

 private:
  void lay(const Block& block, const GridSink& sink);
  void copy(const Block& block, std::size_t from, std::size_t to, const GridSink& sink);
  void skip(std::size_t places, const GridSink& sink);
  void flush(const GridSink& sink);

  HoleFinder finder_;
  std::size_t expected_;
  std::size_t laid_ = 0;                   ///< samples handed over or in the piece
  std::vector<std::vector<double>> held_;  ///< samples that wait, a channel each
  std::vector<std::vector<double>> piece_;
  std::size_t filled_ = 0;  ///< places of the piece
  std::vector<Hole> fresh_, listed_;
  bool has_stamps_ = false;
};

}  // namespace proofmass::signal
