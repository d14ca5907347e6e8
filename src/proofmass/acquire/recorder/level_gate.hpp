#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <limits>

#include "proofmass/acquire/recorder.hpp"
#include "proofmass/core/block.hpp"
#include "proofmass/core/rows.hpp"

namespace proofmass::acquire {

/// Rows `first` to `first + count` of a block.
[[nodiscard]] Block part_of(const Block& block, std::size_t first, std::size_t count);

/// The most recent rows, up to a limit.
class RecentRows {
 public:
  RecentRows(std::size_t columns, std::size_t most_rows);

  void add(const Block& block);
  /// Both return the number of rows.
  std::size_t drop_before(double time_s);
  std::size_t drop_first(std::size_t count);
  [[nodiscard]] std::size_t rows() const { return rows_.rows() - first_; }
  [[nodiscard]] double time_s(std::size_t row) const { return rows_.stamps_s[first_ + row]; }
  [[nodiscard]] Block view() const;

 private:
  Rows rows_;
  std::size_t first_ = 0;  ///< rows before it are removed
  std::size_t most_rows_;
};

/// Passes on the data around the times at which a channel crosses a level. Estimates arrive later
/// than their samples and wait for the decision on these.
class LevelGate {
 public:
  struct Keep {
    /// A new segment begins, separate from the previous one; nothing of it has been kept yet.
    std::function<void(double from_s)> begin_stretch;
    std::function<void(double time_s)> triggered;
    std::function<void(const Block& rows)> samples;
    std::function<void(const Block& rows)> estimates;
  };

  /// channel: index in the block of the trigger's channel. most_bytes: limit of the waiting rows.
  LevelGate(const LevelTrigger& trigger,
            std::size_t channel,
            std::size_t channels,
            std::size_t estimate_columns,
            std::size_t most_bytes);

  void add_samples(const Block& block, const Keep& keep);
  void add_estimates(const Block& rows, const Keep& keep);
  /// Rows that were not kept and will not be if nothing follows.
  [[nodiscard]] std::uint64_t not_kept() const { return dropped_ + recent_.rows(); }

 private:
  struct Window {
    double from_s, until_s;
  };
  [[nodiscard]] bool passes(double value);
  void open(double time_s, const Keep& keep);
  void let_estimates(const Keep& keep);

  static constexpr double never = -std::numeric_limits<double>::infinity();
  LevelTrigger trigger_;
  std::size_t channel_;
  double before_ = std::numeric_limits<double>::quiet_NaN();  ///< the previous value
  double now_s_ = never;
  double until_s_ = never;  ///< end of the segment that is kept
  std::deque<Window> windows_;
  RecentRows recent_;
  RecentRows recent_estimates_;
  std::uint64_t dropped_ = 0;
};

}  // namespace proofmass::acquire
