#pragma once

#include <cstdint>
#include <optional>

namespace proofmass::acquire {

/// The actual rate of the rows, if it differs from the granted one.
struct OtherRate {
  double rate_hz = 0.0;
  double for_s = 0.0;
};

/// Detects, once, that the row rate differs from the granted one by more than 5 %: three
/// consecutive times, each over at least five seconds and forty rows, and always in the same
/// direction. A delay and its compensation therefore do not count.
class RateWatch {
 public:
  /// 0: no rate was granted, and nothing is detected.
  explicit RateWatch(double granted_hz = 0.0) : granted_hz_(granted_hz) {}

  /// rows: number of rows so far, including those known to be missing; host_s: arrival of the last.
  [[nodiscard]] std::optional<OtherRate> add(std::uint64_t rows, double host_s);

 private:
  struct Mark {
    double rows, host_s;
  };
  [[nodiscard]] static double rate_hz(const Mark& from, const Mark& to);

  double granted_hz_;
  bool is_reported_ = false;
  std::optional<Mark> since_;    ///< start of the current comparison
  std::optional<Mark> differs_;  ///< start of the difference
  int times_ = 0;                ///< number of consecutive differences: negative if slower
};

}  // namespace proofmass::acquire
