#pragma once

#include <chrono>
#include <cstdint>

namespace proofmass::acquire {

/// Holds rows back until the time they bear has come, as a device would. Deadlines are absolute, so
/// that lateness does not add up, and stand on whole milliseconds of the host's clock, so that
/// 48 000 rows a second do not wake it 48 000 times.
class Pacer {
 public:
  /// `speed` above 0: seconds of the source's time that pass in a second.
  explicit Pacer(double speed);

  /// The source's time now: rows that bear it, or an earlier one, are due. It begins at 0 with the
  /// first call of this or of wait_until().
  [[nodiscard]] std::int64_t now_ns();
  /// Sleeps until `time_ns` of the source has come, for `patience` at most, or until a signal.
  /// False: it has not come yet.
  [[nodiscard]] bool wait_until(std::int64_t time_ns, std::chrono::milliseconds patience);

 private:
  double speed_;
  std::int64_t start_ns_ = 0;  ///< of the host's clock; 0: not yet
};

}  // namespace proofmass::acquire
