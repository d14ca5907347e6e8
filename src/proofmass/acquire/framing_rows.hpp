#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/acquire/framing_clock.hpp"
#include "proofmass/acquire/source.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/view.hpp"

namespace proofmass::acquire {

/// A trouble that may come a million times: told in words the first few times, then at each power
/// of ten.
class RepeatedNote {
 public:
  explicit RepeatedNote(std::string plural)
      : plural_(std::move(plural)) {}  ///< "lines passed over"
  void add(const std::string& text, std::vector<Note>& notes);

 private:
  std::string plural_;
  std::uint64_t count_ = 0, next_ = 10;
};

/// What the fields of a row are for.
struct RowPlan {
  struct Column {
    std::size_t field = 0;
    double scale = 1.0;
    Channel head{};  ///< without values
  };
  struct Clock {
    std::string name{};
    std::int64_t unit_ns = 1;
    int bits = 0;  ///< as DeviceClock
  };
  struct Counter {
    std::size_t field = 0;
    std::string name{};
    int bits = 0;  ///< as RowCounter
  };
  std::vector<Column> columns{};
  std::optional<Clock> clock{};
  std::optional<Counter> counter{};
};

/// Rows on their way from a decoder to whoever reads, with what is missing between them.
class RowQueue {
 public:
  RowQueue() = default;
  void begin(RowPlan plan, bool may_be_late);
  [[nodiscard]] const RowPlan& plan() const { return plan_; }

  /// A row's fields in the decoder's order, and its clock's reading. One that comes late, or whose
  /// clock's reading is none, is passed over, counted and told.
  void add(View<double> fields, const std::optional<Tick>& tick, std::int64_t host_ns);
  /// Rows that the framing knows to be missing here; a counter knows better.
  void lose(std::uint64_t rows);
  /// The device began anew: clock and counter do not go on.
  void begin_anew();
  void note(Severity severity, std::string text) { notes_.push_back({severity, std::move(text)}); }
  [[nodiscard]] std::vector<Note>& notes() { return notes_; }

  [[nodiscard]] bool empty() const { return next_group_ == groups_.size(); }
  /// As Decoder::hand_out.
  bool hand_out(Arrival& arrival);
  [[nodiscard]] std::uint64_t rows() const { return rows_; }
  [[nodiscard]] std::uint64_t lost() const { return lost_; }
  [[nodiscard]] std::uint64_t late() const { return late_; }
  [[nodiscard]] std::uint64_t untimed() const { return untimed_; }
  /// The device's clock at the first row.
  [[nodiscard]] std::optional<std::int64_t> first_device_ns() const { return first_device_ns_; }

 private:
  /// Rows that none is known to be missing between.
  struct Group {
    std::size_t first = 0;
    std::uint64_t lost_before = 0;
    std::int64_t first_host_ns = 0, host_ns = 0;
    double first_count = 0.0, last_count = 0.0;  ///< where rows are counted
  };
  /// False: the row is to be passed over.
  bool count(View<double> fields);
  bool place(const std::optional<Tick>& tick);
  void join_group(std::int64_t host_ns);

  RowPlan plan_;
  std::optional<DeviceClock> clock_;
  std::optional<RowCounter> counter_;
  std::vector<std::vector<double>> channels_;
  std::vector<std::int64_t> device_ns_;
  std::vector<Group> groups_;
  std::size_t next_group_ = 0;
  std::vector<Note> notes_;
  RepeatedNote late_notes_{"rows that came late"};
  RepeatedNote restart_notes_{"times that the count jumped"};
  RepeatedNote untimed_notes_{"rows without a reading of the clock"};
  std::uint64_t pending_lost_ = 0;
  double count_ = 0.0;  ///< of the row that came last
  std::uint64_t rows_ = 0, lost_ = 0, late_ = 0, untimed_ = 0;
  std::optional<std::int64_t> first_device_ns_;
};

}  // namespace proofmass::acquire
