#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/block.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/recording_log.hpp"

namespace proofmass::serve {

/// What a recorder does, as lines of JSON, each an object with one key (docs/serve.md lists their
/// fields):
///
///     head        the source was opened: its name, rate, channels and settings
///     columns     those of the estimate
///     rows        the samples of the last frame, as extremes of `every` consecutive ones
///     estimates   the last row of the estimate
///     state       counts
///     event       a gap, a stall, a note
///     end         how the recording ended
///
/// A frame of 25 ms has one `rows` line; the number of buckets is at most a thousand a second,
/// whatever the rate of the source. For one thread.
class LiveLines {
 public:
  using Clock = std::chrono::steady_clock;
  /// write: takes a line, without its end, and must not wait.
  explicit LiveLines(std::function<void(std::string_view line)> write);

  /// head: channels without values, source, nominal rate; `file` is empty where none is written.
  void opened(const Recording& head, const std::string& file);
  void estimating(const std::vector<Channel>& columns);
  /// Samples with stamps in seconds since the recording's first.
  void samples(const Block& block, Clock::time_point now);
  void estimates(const Block& rows);
  void event(const RecordEvent& event);
  /// Writes the frame and the state if they are due.
  void refresh(Clock::time_point now);
  void ended(const RecordSummary& summary);

 private:
  void add_row(const Block& block, std::size_t row);
  void write_rows();
  void write_state(Clock::time_point now);

  std::function<void(std::string_view line)> write_;
  std::size_t every_ = 1;                       ///< samples in a bucket
  std::size_t in_bucket_ = 0;                   ///< samples of the bucket that is being filled
  std::vector<double> times_s_;                 ///< of each bucket's first sample
  std::vector<std::vector<double>> min_, max_;  ///< [channel][bucket]
  std::vector<double> estimates_;
  double estimates_time_s_ = 0.0;
  double last_time_s_ = 0.0;
  std::uint64_t samples_ = 0, lost_ = 0, gaps_ = 0;
  std::int64_t arrived_ms_ = 0;  ///< time of day at which the frame's first samples came
  Clock::time_point framed_{}, stated_{}, heard_{};
};

/// The line of an object with one key, `key`, whose value is `value`, JSON that may be indented.
[[nodiscard]] std::string live_line(std::string_view key, std::string_view value);

}  // namespace proofmass::serve
