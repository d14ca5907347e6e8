#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace proofmass::acquire {

/// Read position in a group of phyphox's buffers, by its time buffer, in seconds.
///
/// The phone returns the values above a threshold of time, up to a digit in the eighth place, in
/// which it also writes the times. Therefore a small overlap is requested, and the known part is
/// identified by the last rows received.
/// Source: phyphox-android, RemoteServer.java, parseBufferRequest.
class PhyphoxCursor {
 public:
  /// New rows: from first up to but excluding end.
  struct Range {
    std::size_t first = 0, end = 0;
    friend bool operator==(const Range&, const Range&) = default;
  };

  /// Request for the time buffer: "full", or a threshold.
  [[nodiscard]] std::string threshold() const;
  /// Determines the new rows of the response to the threshold and marks them as received. The
  /// columns are equally long, the times first.
  [[nodiscard]] Range take(std::span<const std::vector<double>> columns);

  /// Rows up to this time are ignored.
  void start_behind(double last_s);
  /// No received row is on the phone any more.
  void start_anew() { *this = {}; }
  /// The time buffer now ends here: further back than the received rows means that the clock was
  /// set back.
  void see_end(double end_s);
  /// True if the request reaches far back, to find where a clock was set back.
  [[nodiscard]] bool is_searching() const { return set_back_to_s_.has_value(); }

 private:
  /// A received row; time alone does not identify it if the clock passed the same time twice.
  struct Row {
    double time_s = 0.0;
    std::optional<std::uint64_t> print;  ///< hash of all its values; absent: unknown
  };
  [[nodiscard]] std::optional<double> wanted_from_s() const;
  [[nodiscard]] std::size_t first_new(std::span<const std::vector<double>> columns) const;

  std::deque<Row> had_;  ///< the last few
  std::optional<double> set_back_to_s_;
};

}  // namespace proofmass::acquire
