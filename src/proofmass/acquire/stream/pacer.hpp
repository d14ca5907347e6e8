#pragma once

#include <chrono>
#include <cstdint>

namespace proofmass::acquire {

/// Delays rows until their time, as a device would. Deadlines are absolute, so that delays do not
/// accumulate, and rounded to whole milliseconds of the host's clock, so that 48 000 rows a second
/// do not cause 48 000 wake-ups.
class Pacer {
 public:
  /// `speed` above 0: seconds of the source's time per second.
  explicit Pacer(double speed);

  /// The source's current time: rows with this time or an earlier one are due. It starts at 0 with
  /// the first call of this or of wait_until().
  [[nodiscard]] std::int64_t now_ns();
  /// Sleeps until `time_ns` of the source, for at most `patience`, or until a signal. False: not
  /// reached yet.
  [[nodiscard]] bool wait_until(std::int64_t time_ns, std::chrono::milliseconds patience);

 private:
  double speed_;
  std::int64_t start_ns_ = 0;  ///< on the host's clock; 0: not started
};

}  // namespace proofmass::acquire
