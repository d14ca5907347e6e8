#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/acquire/framing/clock.hpp"
#include "proofmass/acquire/source.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/view.hpp"

namespace proofmass::acquire {

/// A fault that may occur a million times: reported in full the first few times, then at each power
/// of ten.
class RepeatedNote {
 public:
  explicit RepeatedNote(std::string plural) : plural_(std::move(plural)) {}  ///< "lines skipped"
  void add(const std::string& text, std::vector<Note>& notes);

 private:
  std::string plural_;
  std::uint64_t count_ = 0, next_ = 10;
};

/// Role of each field of a row.
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

/// Queue of rows from a decoder to the reader, with the numbers of missing rows between them.
class RowQueue {
 public:
  RowQueue() = default;
  void begin(RowPlan plan, bool may_be_late);
  [[nodiscard]] const RowPlan& plan() const { return plan_; }

  /// A row's fields in the decoder's order, and its clock value. A row that is late or has an
  /// invalid clock value is skipped, counted and reported.
  void add(View<double> fields, const std::optional<Tick>& tick, std::int64_t host_ns);
  /// Rows that the framing reports as missing here; a counter takes precedence.
  void lose(std::uint64_t rows);
  /// The device restarted: clock and counter are not continued.
  void begin_anew();
  void note(Severity severity, std::string text) { notes_.push_back({severity, std::move(text)}); }
  [[nodiscard]] std::vector<Note>& notes() { return notes_; }

  [[nodiscard]] bool empty() const { return next_group_ == groups_.size(); }
  /// See Decoder::hand_out.
  bool hand_out(Arrival& arrival);
  [[nodiscard]] std::uint64_t rows() const { return rows_; }
  [[nodiscard]] std::uint64_t lost() const { return lost_; }
  [[nodiscard]] std::uint64_t late() const { return late_; }
  [[nodiscard]] std::uint64_t untimed() const { return untimed_; }
  /// The device's clock at the first row.
  [[nodiscard]] std::optional<std::int64_t> first_device_ns() const { return first_device_ns_; }

 private:
  /// Rows without known missing rows between them.
  struct Group {
    std::size_t first = 0;
    std::uint64_t lost_before = 0;
    std::int64_t first_host_ns = 0, host_ns = 0;
    double first_count = 0.0, last_count = 0.0;  ///< if rows are counted
  };
  /// False: skip the row.
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
  RepeatedNote untimed_notes_{"rows without a time"};
  std::uint64_t pending_lost_ = 0;
  double count_ = 0.0;  ///< count at the last row
  std::uint64_t rows_ = 0, lost_ = 0, late_ = 0, untimed_ = 0;
  std::optional<std::int64_t> first_device_ns_;
};

}  // namespace proofmass::acquire
