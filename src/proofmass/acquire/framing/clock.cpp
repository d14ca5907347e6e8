#include "proofmass/acquire/framing/clock.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace proofmass::acquire {
namespace {

/// In nanoseconds; nullopt beyond ±292 years.
std::optional<std::int64_t> ns_of(const Tick& tick, std::int64_t unit_ns) {
  std::int64_t whole = 0;
  if (__builtin_mul_overflow(tick.whole, unit_ns, &whole)) return std::nullopt;
  // unit_ns is at most 10^9, so the product with the fraction fits.
  const std::int64_t fraction = (tick.nano * unit_ns + ns_per_s / 2) / ns_per_s;
  std::int64_t sum = 0;
  if (__builtin_add_overflow(whole, fraction, &sum)) return std::nullopt;
  return sum;
}

}  // namespace

std::optional<Tick> tick_of(double reading) {
  if (!(std::abs(reading) < 9e18)) return std::nullopt;
  Tick tick;
  const double floor = std::floor(reading);
  tick.whole = static_cast<std::int64_t>(floor);
  tick.nano = static_cast<std::int32_t>(std::lround((reading - floor) * 1e9));
  if (tick.nano >= ns_per_s) {
    ++tick.whole;
    tick.nano = 0;
  }
  return tick;
}

DeviceClock::DeviceClock(std::int64_t unit_ns, int bits)
    : unit_ns_(unit_ns), bits_(bits), finder_(static_cast<double>(unit_ns) * 1e-9) {}

std::optional<std::int64_t> DeviceClock::place(const Tick& tick) {
  const auto ns = ns_of(tick, unit_ns_);
  if (!ns) return std::nullopt;
  const double figure = static_cast<double>(tick.whole) + tick.nano * 1e-9;
  if (started_ && figure < last_) {
    const std::int64_t range = range_ns(figure);
    if (__builtin_add_overflow(offset_ns_, range, &offset_ns_)) return std::nullopt;
    if (range > 0) ++wraps_;
  } else if (started_ && figure > last_) {
    usual_ = figure - last_;
  }
  std::int64_t placed = 0;
  if (__builtin_add_overflow(*ns, offset_ns_, &placed)) return std::nullopt;
  started_ = true;
  last_ = figure;
  return placed;
}

std::int64_t DeviceClock::range_ns(double figure) {
  const auto unit = static_cast<double>(unit_ns_);
  if (bits_ == 0) {
    const auto found = finder_.find(last_, figure, usual_, seen_);
    if (!found) return 0;
    const io::Wrap& wrap = finder_[*found];
    // Devices divide a counter of microseconds, or a slower one.
    constexpr double shortest_divided_ns = 2e12;
    if (!wrap.needs_whole && wrap.range() * unit < shortest_divided_ns) return 0;
    seen_ = found;
    return std::llround(wrap.range() * unit);
  }
  // A restart of the device decreases the clock too: it is a wrap only if the distance across the
  // wrap is short.
  if (bits_ > 32) return 0;
  const double range = std::ldexp(1.0, bits_);
  const double way = figure + range - last_;
  return way <= std::max(100.0 * usual_, range / 64.0) ? std::llround(range * unit) : 0;
}

namespace {

/// The range of a counter of unknown width that shows `low` soon after `high`; 0: none.
double range_between(double high, double low) {
  constexpr std::array<double, 4> ranges{0x1p8, 0x1p16, 0x1p24, 0x1p32};
  for (const double range : ranges)
    if (high < range && high > 0.9 * range && low >= 0.0 && low < 0.1 * range) return range;
  return 0.0;
}

}  // namespace

RowCounter::Ways RowCounter::ways_to(double count) const {
  constexpr double none = std::numeric_limits<double>::infinity();
  const double difference = count - last_;
  if (bits_ > 0) {
    const double range = std::ldexp(1.0, bits_);
    const double ahead = difference < 0.0 ? difference + range : difference;
    return {ahead, range - ahead};
  }
  const double range = range_between(std::max(count, last_), std::min(count, last_));
  const double other_way = range > 0.0 ? range - std::abs(difference) : none;
  return difference < 0.0 ? Ways{other_way, -difference} : Ways{difference, other_way};
}

CounterStep RowCounter::add(double count) {
  if (!std::isfinite(count)) {
    last_ += 1.0;
    return {};
  }
  if (!std::exchange(started_, true)) {
    last_ = count;
    return {};
  }
  constexpr double usual_most = 100.0;  // rows that are late, or lost consecutively
  constexpr double most_lost = 1e6;
  const auto [ahead, back] = ways_to(count);
  if (ahead == 0.0) return {.is_late = may_be_late_};
  if (may_be_late_ && back <= usual_most) return {.is_late = true};
  const bool began_anew = count < last_ && count <= 1.0 && ahead > usual_most;
  last_ = count;
  if (began_anew || ahead > most_lost) return {.restarted = true};
  return {.lost = static_cast<std::uint64_t>(ahead) - 1};
}

}  // namespace proofmass::acquire
