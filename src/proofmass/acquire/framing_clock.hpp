#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "proofmass/acquire/source.hpp"
#include "proofmass/io/wrap.hpp"

namespace proofmass::acquire {

/// A clock's reading, exact: whole + nano · 1e-9 of its unit.
struct Tick {
  std::int64_t whole = 0;
  std::int32_t nano = 0;  ///< 0 … 999 999 999
};
/// Rounded to a milliardth of the unit; nullopt for NaN and beyond what 63 bits hold.
[[nodiscard]] std::optional<Tick> tick_of(double reading);

/// Unwraps a device's clock: micros() runs over after 71.6 min.
class DeviceClock {
 public:
  /// `bits` is the width at which it runs over; 0: found when it does.
  DeviceClock(std::int64_t unit_ns, int bits);

  /// Nanoseconds of the device, whatever its origin: back only where the device's go back for
  /// another reason than running over. nullopt for a reading that no clock has.
  [[nodiscard]] std::optional<std::int64_t> place(const Tick& tick);
  /// The device began anew: what follows has not run over.
  void forget() { started_ = false; }
  /// How often it ran over until now.
  [[nodiscard]] std::size_t wraps() const { return wraps_; }

 private:
  /// What a clock that fell from `last_` has run over by, in ns; 0: it did not run over.
  [[nodiscard]] std::int64_t range_ns(double figure);

  std::int64_t unit_ns_;
  int bits_;
  io::WrapFinder finder_;
  std::optional<std::size_t> seen_{};
  bool started_ = false;
  double last_ = 0.0, usual_ = 0.0;  ///< in its unit
  std::int64_t offset_ns_ = 0;       ///< of all that it ran over
  std::size_t wraps_ = 0;
};

/// What a column that counts rows says of the next row.
struct CounterStep {
  std::uint64_t lost = 0;  ///< rows that are missing before it
  bool is_late = false;    ///< it belongs before the one that came last, or is that again
  bool restarted = false;  ///< the count began anew: nobody knows what is missing
};

class RowCounter {
 public:
  /// `bits`: the width at which it runs over; 0: 8, 16, 24 or 32, found when it does. In datagrams
  /// rows may come late.
  RowCounter(int bits, bool may_be_late) : bits_(bits), may_be_late_(may_be_late) {}
  [[nodiscard]] CounterStep add(double count);
  /// The device began anew: the next count says nothing of what is missing.
  void forget() { started_ = false; }

 private:
  /// Rows from the last to this, forwards and backwards; infinite where there is no such way.
  struct Ways {
    double ahead, back;
  };
  [[nodiscard]] Ways ways_to(double count) const;

  int bits_;
  bool may_be_late_;
  bool started_ = false;
  double last_ = 0.0;
};

}  // namespace proofmass::acquire
