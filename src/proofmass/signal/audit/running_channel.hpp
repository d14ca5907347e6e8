#pragma once

#include <cstddef>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/view.hpp"
#include "proofmass/signal/audit.hpp"
#include "proofmass/signal/audit/chunk_statistics.hpp"
#include "proofmass/signal/audit/stuck_values.hpp"
#include "proofmass/signal/audit/subsample.hpp"
#include "proofmass/signal/audit/value_excerpts.hpp"
#include "proofmass/signal/clipping_tail.hpp"
#include "proofmass/signal/resample/sample_times.hpp"

namespace proofmass::signal {

/// Odd values of one kind.
struct OddValues {
  std::size_t count = 0;
  Place first, last;

  void add(Place place) {
    if (count++ == 0) first = place;
    last = place;
  }
};

/// Audits one channel in chunks. The same chunks give the same digits.
class RunningChannel {
 public:
  explicit RunningChannel(std::size_t sample_capacity);

  /// Adds the values of samples times.first, times.first + 1, …
  void add(View<double> values, const SampleTimes& times);

  /// Adds the same values to the tails. Shares no data with add(), so that both can run at once.
  void add_to_tails(View<double> values);

  /// Call once. `channel` gives the name and the unit. Rails are found at once; the search for
  /// limits that are no single value takes longest.
  enum class Limits { rails, all };
  [[nodiscard]] ChannelAudit finish(const Channel& channel, Limits limits = Limits::all);

  [[nodiscard]] const OddValues& nan() const { return nan_; }
  [[nodiscard]] const OddValues& infinite() const { return infinite_; }
  [[nodiscard]] const OddValues& absurd() const { return absurd_; }
  [[nodiscard]] const OddValues& denormal() const { return denormal_; }

 private:
  void add_plausible(View<double> values, const ChunkStatistics& figures);
  void add_odd(View<double> values, const SampleTimes& times);
  void take_odd(double value, Place place);
  void judge_range(ChannelAudit& audit, Limits limits) const;
  void judge_rails(ChannelAudit& audit) const;

  Moments moments_;
  StuckValues runs_;
  Subsample sample_;
  ClippingTail lowest_, highest_;
  ValueExcerpts excerpts_;
  OddValues nan_, infinite_, absurd_, denormal_;
  std::vector<double> plausible_, of_tails_;  ///< plausible values of a chunk that contains others
};

}  // namespace proofmass::signal
