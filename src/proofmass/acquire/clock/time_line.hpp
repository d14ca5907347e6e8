#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "proofmass/acquire/clock/clock_tracker.hpp"
#include "proofmass/acquire/clock/sample_period.hpp"
#include "proofmass/acquire/source.hpp"
#include "proofmass/acquire/stream/queue_item.hpp"
#include "proofmass/core/recording_log.hpp"

namespace proofmass::acquire {

/// Minimum of a delay over the last ten to twenty seconds.
class DelayFloor {
 public:
  void add(double host_s, double delay_s);
  [[nodiscard]] double value() const;

 private:
  std::optional<double> before_, now_;
  double since_s_ = 0.0;
};

/// Assigns rows their time on the recording's clock: seconds since its first row, never less than
/// the previous row.
class TimeLine {
 public:
  explicit TimeLine(const SourceHead& head) { reopen(head); }

  /// The source was reopened: its clock may have any origin; the host's clock bridges the gap.
  void reopen(const SourceHead& head);
  /// Replaces `stamps_s` by the stamps of an item's rows; appends events to `events`.
  void stamp(const QueueItem& item,
             std::vector<double>& stamps_s,
             std::vector<RecordEvent>& events);

  [[nodiscard]] double last_s() const { return last_s_; }
  /// Rows up to the last stamp, including missing ones.
  [[nodiscard]] std::uint64_t rows() const { return rows_; }
  /// Typical interval between rows; 0: not known yet.
  [[nodiscard]] double step_s() const { return step_.step_s(); }
  /// The host's steady clock, in seconds since the first arrival.
  [[nodiscard]] double host_s(std::int64_t host_ns) const;

 private:
  enum class Clock { device, count, host };
  enum class RowPlace { first, after_break, within };
  void stamp_by_device(const QueueItem& item, std::vector<double>& stamps_s);
  void stamp_by_count(const QueueItem& item, std::vector<double>& stamps_s);
  void stamp_by_host(const QueueItem& item, std::vector<double>& stamps_s);
  [[nodiscard]] bool is_dead(const Arrival& arrival);
  [[nodiscard]] double device_stamp(const Arrival& arrival, std::size_t row);
  [[nodiscard]] double bridged(const Arrival& arrival, std::size_t row) const;
  void report_missing(const QueueItem& item, View<double> stamps_s);
  void report_known(const QueueItem& item, double hole_s);
  [[nodiscard]] std::uint64_t report_gap(double hole_s, double open_s);
  [[nodiscard]] std::uint64_t missing_in(const QueueItem& item,
                                         double hole_s,
                                         std::uint64_t known,
                                         RowPlace place);
  void report(EventKind kind, double duration_s, std::uint64_t rows, std::string text);

  Clock clock_ = Clock::host;
  bool is_paced_ = true;
  double rate_hz_ = 0.0;
  SamplePeriod step_{0.0};
  DelayFloor floor_;
  ClockTracker line_;

  bool has_rows_ = false;
  bool is_new_ = true;   ///< the clock has given no stamp yet
  bool is_gap_ = false;  ///< before the current rows, whatever the device's clock shows
  double last_s_ = 0.0;
  std::uint64_t rows_ = 0;
  std::int64_t first_host_ns_ = 0;

  std::int64_t device_ns_ = 0;  ///< the device's clock when the recording's is device_s_
  double device_s_ = 0.0;
  std::int64_t still_at_ns_ = 0;  ///< value of the device's clock for still_rows_
  std::size_t still_rows_ = 0;
  double count_s_ = 0.0;  ///< start of the row count
  std::uint64_t counted_ = 0;
  std::vector<RecordEvent>* events_ = nullptr;  ///< events of the current item
};

}  // namespace proofmass::acquire
