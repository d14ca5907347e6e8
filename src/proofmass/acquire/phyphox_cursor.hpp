#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace proofmass::acquire {

/// How far a group of phyphox's buffers has been read, by its time buffer, in seconds.
///
/// The phone gives what lies behind a threshold of time, but for a figure in the eighth place, in
/// which it also writes the times: so a little is asked for again, and what was had is found in it
/// by the last rows that were had.
/// Source: phyphox-android, RemoteServer.java, parseBufferRequest.
class PhyphoxCursor {
 public:
  /// Rows that are new: from first up to the one before end.
  struct Range {
    std::size_t first = 0, end = 0;
    friend bool operator==(const Range&, const Range&) = default;
  };

  /// What to ask of the time buffer: "full", or a threshold.
  [[nodiscard]] std::string threshold() const;
  /// Which rows of what came upon the threshold are new; they count as had then. The columns are
  /// equally long, the times first.
  [[nodiscard]] Range take(std::span<const std::vector<double>> columns);

  /// Rows up to here are not wanted.
  void start_behind(double last_s);
  /// Nothing that was had is on the phone any more.
  void start_anew() { *this = {}; }
  /// The time buffer ends with this now: further back than what was had is a clock set back.
  void see_end(double end_s);
  /// What is asked for goes far back, to find where a clock was set back.
  [[nodiscard]] bool is_searching() const { return set_back_to_s_.has_value(); }

 private:
  /// A row that was had: no time alone tells it from another, where a clock ran twice over it.
  struct Row {
    double time_s = 0.0;
    std::optional<std::uint64_t> print;  ///< of all its figures; absent: not known
  };
  [[nodiscard]] std::optional<double> wanted_from_s() const;
  [[nodiscard]] std::size_t first_new(std::span<const std::vector<double>> columns) const;

  std::deque<Row> had_;  ///< the last few
  std::optional<double> set_back_to_s_;
};

}  // namespace proofmass::acquire
