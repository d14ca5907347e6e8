#pragma once

#include <cstdint>
#include <optional>

namespace proofmass::acquire {

/// The rate at which rows come, where it is not the granted one.
struct OtherRate {
  double rate_hz = 0.0;
  double for_s = 0.0;
};

/// Notices, once, that rows come at a rate which differs from the granted one by more than 5 %:
/// three times in a row, each over five seconds and forty rows at least, and always to the same
/// side. So neither a delay nor what makes up for it counts.
class RateWatch {
 public:
  /// 0: no rate was granted, and nothing is noticed.
  explicit RateWatch(double granted_hz = 0.0) : granted_hz_(granted_hz) {}

  /// So many rows there are by now, those known to be missing too; host_s: when the last arrived.
  [[nodiscard]] std::optional<OtherRate> add(std::uint64_t rows, double host_s);

 private:
  struct Mark {
    double rows, host_s;
  };
  [[nodiscard]] static double rate_hz(const Mark& from, const Mark& to);

  double granted_hz_;
  bool is_told_ = false;
  std::optional<Mark> since_;    ///< where what is compared now begins
  std::optional<Mark> differs_;  ///< since when it has
  int times_ = 0;                ///< that it has: below 0 to the slower side
};

}  // namespace proofmass::acquire
