#include "proofmass/io/time/counter_clock.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace proofmass::io {
namespace {

/// Larger increments are not lost rows but decoding errors.
constexpr double longest_step = 1e6;

bool is_count(double value) {
  return std::abs(value) < 1e15 && value == std::trunc(value);
}

/// Increment from `last` to `next`; nullopt if the counter restarted, or is invalid.
std::optional<double> step_between(double last, double next) {
  if (!is_count(next)) return std::nullopt;
  const double step = next - last;
  if (step >= 1.0 && step < longest_step) return step;
  constexpr std::array<double, 4> ranges{0x1p8, 0x1p16, 0x1p24, 0x1p32};
  for (const double range : ranges) {
    const double way = step + range;
    // Up to a tenth of the range may be missing at a wrap.
    if (last < range && next >= 0.0 && way >= 1.0 && way < std::min(0.1 * range, longest_step))
      return way;
  }
  return std::nullopt;
}

}  // namespace

bool counts_samples(View<double> counter) {
  if (counter.size() < 2 || !is_count(counter.front())) return false;
  std::size_t ones = 0;
  for (std::size_t k = 1; k < counter.size(); ++k) {
    const auto step = step_between(counter[k - 1], counter[k]);
    if (!step) return false;
    if (*step == 1.0) ++ones;
  }
  return ones * 10 >= (counter.size() - 1) * 9;
}

void CounterClock::place(View<double> counter, std::span<double> times_s) {
  for (std::size_t k = 0; k < counter.size(); ++k) {
    if (started_) {
      const auto step = step_between(last_, counter[k]);
      total_ += step.value_or(1.0);
      lost_ += static_cast<std::size_t>(step.value_or(1.0)) - 1;
      if (!step && is_count(counter[k])) ++restarts_;
      last_ = is_count(counter[k]) ? counter[k] : last_ + 1.0;
    } else {
      last_ = is_count(counter[k]) ? counter[k] : 0.0;
      started_ = true;
    }
    times_s[k] = total_ / rate_hz_;
  }
}

}  // namespace proofmass::io
