#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/io/table_reader.hpp"

namespace proofmass::io {

/// The time column of messages with a device stamp and the logging time of the host: the device's
/// stamp, if there is one.
class MessageClock {
 public:
  /// `stamp_ns` is the first message's; none: the host's clock is the time.
  MessageClock(std::optional<std::int64_t> stamp_ns, std::uint64_t log_ns, std::string stamp_name);

  [[nodiscard]] bool has_stamps() const { return has_stamps_; }
  /// For column 0 of the table, in nanoseconds minus the first message's.
  [[nodiscard]] DeclaredStamps declared() const;
  [[nodiscard]] const std::string& name() const { return name_; }
  /// A message's value in that column; NaN if it has none.
  [[nodiscard]] double take(std::optional<std::int64_t> stamp_ns, std::uint64_t log_ns);
  /// Drift of the host's clock relative to the device's; messages logged out of order.
  [[nodiscard]] std::vector<Note> notes() const;

 private:
  void compare(double device_s, double host_less_device_s);

  bool has_stamps_;
  std::string name_;
  std::int64_t origin_ns_ = 0;
  double first_offset_s_ = 0.0;  ///< host's clock minus the device's, at the first message
  std::uint64_t last_log_ns_ = 0;
  std::size_t backwards_ = 0;
  // Running least-squares fit of the difference against the device's time.
  double count_ = 0.0;
  double mean_t_ = 0.0;
  double mean_d_ = 0.0;
  double sum_tt_ = 0.0;
  double sum_td_ = 0.0;
  double sum_dd_ = 0.0;
};

/// Seconds and nanoseconds as nanoseconds; nullopt beyond 1970 ± 285 years.
[[nodiscard]] std::optional<std::int64_t> stamp_ns(std::int64_t seconds, std::int64_t nanoseconds);

}  // namespace proofmass::io
