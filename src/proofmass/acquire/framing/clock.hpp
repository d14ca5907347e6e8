#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "proofmass/acquire/source.hpp"
#include "proofmass/io/time/wrap.hpp"

namespace proofmass::acquire {

/// A clock value, exact: whole + nano · 1e-9 of its unit.
struct Tick {
  std::int64_t whole = 0;
  std::int32_t nano = 0;  ///< 0 … 999 999 999
};
/// Rounded to a billionth of the unit; nullopt for NaN and values beyond 63 bits.
[[nodiscard]] std::optional<Tick> tick_of(double reading);

/// Unwraps a device's clock: micros() wraps after 71.6 min.
class DeviceClock {
 public:
  /// `bits` is the width at which it wraps; 0: detected when it wraps.
  DeviceClock(std::int64_t unit_ns, int bits);

  /// Nanoseconds of the device's clock, of any origin; decreases only if the device's clock
  /// decreases without a wrap. nullopt for an invalid value.
  [[nodiscard]] std::optional<std::int64_t> place(const Tick& tick);
  /// The device restarted: what follows is not a wrap.
  void forget() { started_ = false; }
  /// Number of wraps so far.
  [[nodiscard]] std::size_t wraps() const { return wraps_; }

 private:
  /// The range of the wrap of a clock that decreased from `last_`, in ns; 0: no wrap.
  [[nodiscard]] std::int64_t range_ns(double figure);

  std::int64_t unit_ns_;
  int bits_;
  io::WrapFinder finder_;
  std::optional<std::size_t> seen_{};
  bool started_ = false;
  double last_ = 0.0, usual_ = 0.0;  ///< in the clock's unit
  std::int64_t offset_ns_ = 0;       ///< sum of all wraps
  std::size_t wraps_ = 0;
};

/// Interpretation of the next value of a row counter.
struct CounterStep {
  std::uint64_t lost = 0;  ///< rows missing before this row
  bool is_late = false;    ///< the row precedes the last one, or repeats it
  bool restarted = false;  ///< the count restarted: the number of missing rows is unknown
};

class RowCounter {
 public:
  /// `bits`: the width at which it wraps; 0: 8, 16, 24 or 32, detected when it wraps. In datagrams
  /// rows may arrive late.
  RowCounter(int bits, bool may_be_late) : bits_(bits), may_be_late_(may_be_late) {}
  [[nodiscard]] CounterStep add(double count);
  /// The device restarted: the next count gives no information on missing rows.
  void forget() { started_ = false; }

 private:
  /// Rows from the last to this one, forwards and backwards; infinite if impossible.
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
