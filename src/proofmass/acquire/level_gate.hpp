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

/// The latest rows, so many at most.
class RecentRows {
 public:
  RecentRows(std::size_t columns, std::size_t most_rows);

  void add(const Block& block);
  /// Both say how many rows there were.
  std::size_t drop_before(double time_s);
  std::size_t drop_first(std::size_t count);
  [[nodiscard]] std::size_t rows() const { return rows_.rows() - first_; }
  [[nodiscard]] double time_s(std::size_t row) const { return rows_.stamps_s[first_ + row]; }
  [[nodiscard]] Block view() const;

 private:
  Rows rows_;
  std::size_t first_ = 0;  ///< those before it are gone
  std::size_t most_rows_;
};

/// Lets through what lies around the moments at which a channel passes a level. Estimates come
/// later than their samples and wait for what these decide.
class LevelGate {
 public:
  struct Keep {
    /// A stretch begins that is apart from the one before; nothing of it has been kept yet.
    std::function<void(double from_s)> begin_stretch;
    std::function<void(double time_s)> triggered;
    std::function<void(const Block& rows)> samples;
    std::function<void(const Block& rows)> estimates;
  };

  /// channel: of the block, that the trigger names. most_bytes: of the rows that wait.
  LevelGate(const LevelTrigger& trigger,
            std::size_t channel,
            std::size_t channels,
            std::size_t estimate_columns,
            std::size_t most_bytes);

  void add_samples(const Block& block, const Keep& keep);
  void add_estimates(const Block& rows, const Keep& keep);
  /// Rows that were not kept and will not be, if nothing follows.
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
  double before_ = std::numeric_limits<double>::quiet_NaN();  ///< the value of the row before
  double now_s_ = never;
  double until_s_ = never;  ///< end of the stretch that is kept
  std::deque<Window> windows_;
  RecentRows recent_;
  RecentRows recent_estimates_;
  std::uint64_t dropped_ = 0;
};

}  // namespace proofmass::acquire
