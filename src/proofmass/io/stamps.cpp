#include "proofmass/io/stamps.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iterator>
#include <optional>
#include <tuple>
#include <utility>

#include "proofmass/core/statistics.hpp"

namespace proofmass::io {
namespace {

/// Beyond this a stamp is a decoder's accident, in any unit: nanoseconds of 300 years are 1e19.
constexpr double largest_stamp = 1e20;

bool is_stamp(double value) {
  return std::abs(value) < largest_stamp;
}

/// The largest figure that the steps up to five medians are multiples of, if it is more
/// than 1 % of the median: then the clock was read, or written, that coarsely.
double rounding_of(const std::vector<double>& steps, double median) {
  constexpr std::size_t most = 4096;
  std::vector<double> sorted;
  for (std::size_t i = 0; i < steps.size(); i += steps.size() / most + 1)
    if (steps[i] < 5.0 * median) sorted.push_back(steps[i]);
  std::ranges::sort(sorted);
  const double noise = 1e-6 * median;
  double smallest = 0.0;
  double previous = 0.0;
  for (const double step : sorted) {
    const double rise = step - previous;
    if (rise > noise && (smallest == 0.0 || rise < smallest)) smallest = rise;
    previous = step;
  }
  if (smallest < 0.01 * median || smallest > 0.99 * median) return 0.0;
  const auto off_grid = std::ranges::count_if(sorted, [&](double step) {
    return std::abs(std::remainder(step, smallest)) > 1e-3 * median;
  });
  return static_cast<std::size_t>(off_grid) * 100 > sorted.size() ? 0.0 : smallest;
}

/// Steps from one stamp to the next, at most 65 536 of them spread over the file.
std::vector<double> sampled_steps(View<double> stamps) {
  constexpr std::size_t most = 1u << 16;
  std::vector<double> steps;
  for (std::size_t k = 0; k + 1 < stamps.size(); k += stamps.size() / most + 1)
    if (is_stamp(stamps[k]) && is_stamp(stamps[k + 1])) steps.push_back(stamps[k + 1] - stamps[k]);
  return steps;
}

/// Where sample k's stamp belongs among what follows it.
class Onlooker {
 public:
  Onlooker(View<double> stamps, double step) : stamps_(stamps), step_(step) {}

  /// Whether a stamp that is ahead of its time is alone in being so: what follows lies between the
  /// last good one and it.
  [[nodiscard]] bool leaps_alone(std::size_t k, double last) const {
    const auto next = following(k);
    const auto between = [&](double stamp) { return stamp >= last && stamp < stamps_[k]; };
    if (next.empty() || goes_on(k, next)) return false;
    if (std::ranges::count_if(next, between) * 2 > std::ssize(next)) return true;
    return next.size() >= 2 && between(next[0]) && next[1] >= next[0] &&
           (next[1] < stamps_[k] || next[1] - next[0] <= 1.5 * step_);
  }

  /// Whether a stamp below the last good one is alone in being so.
  [[nodiscard]] bool falls_alone(std::size_t k, double last) const {
    const auto next = following(k);
    return !next.empty() &&
           std::ranges::count_if(next, [&](double stamp) { return stamp >= last; }) * 2 >
               std::ssize(next);
  }

  /// Whether sample k can be the first: most of what follows comes after it and not ages later.
  [[nodiscard]] bool can_be_first(std::size_t k) const {
    const auto next = following(k);
    const auto near = [&](double stamp) {
      return stamp >= stamps_[k] && stamp - stamps_[k] < 1e4 * step_;
    };
    return next.empty() || std::ranges::count_if(next, near) * 2 > std::ssize(next);
  }

 private:
  static constexpr std::size_t window = 8;

  /// Whether the next two follow at the usual pace: a clock that was set, not an accident.
  [[nodiscard]] bool goes_on(std::size_t k, std::span<const double> next) const {
    const auto is_usual = [&](double step) { return step >= 0.0 && step < 1.5 * step_; };
    return next.size() >= 2 && is_usual(next[0] - stamps_[k]) && is_usual(next[1] - next[0]);
  }

  /// The next few stamps that are stamps.
  [[nodiscard]] std::span<const double> following(std::size_t k) const {
    std::size_t count = 0;
    for (std::size_t i = k + 1; i < stamps_.size() && i < k + 3 * window && count < window; ++i)
      if (is_stamp(stamps_[i])) next_[count++] = stamps_[i];
    return std::span(next_).first(count);
  }

  View<double> stamps_;
  double step_;
  mutable std::array<double, window> next_{};
};

/// Whether sample k's stamp, a number at all, can stand behind that of sample `last`.
bool can_follow(View<double> stamps, double step, std::size_t k, std::size_t last) {
  const Onlooker onlooker(stamps, step);
  const double rise = stamps[k] - stamps[last];
  if (rise < 0.0) return !onlooker.falls_alone(k, stamps[last]);
  const bool usual = rise <= 1.5 * step * static_cast<double>(k - last);
  return usual || !onlooker.leaps_alone(k, stamps[last]);
}

/// Samples whose stamps are to be replaced, and how many of them stepped back.
std::pair<std::vector<std::size_t>, std::size_t> find_bad(View<double> stamps, double step) {
  // If none of so many can be the first, the next that is a number has to be.
  constexpr std::size_t most_bad_at_first = 64;
  std::vector<std::size_t> bad;
  std::size_t backwards = 0;
  std::optional<std::size_t> last;
  for (std::size_t k = 0; k < stamps.size(); ++k) {
    const bool number = is_stamp(stamps[k]);
    const bool fits =
        last ? number && can_follow(stamps, step, k, *last)
             : number && (k > most_bad_at_first || Onlooker(stamps, step).can_be_first(k));
    if (fits) {
      last = k;
      continue;
    }
    if (number && last && stamps[k] < stamps[*last]) ++backwards;
    bad.push_back(k);
  }
  return {std::move(bad), backwards};
}

/// Puts the samples between good neighbours `left` and `right` (either may be missing).
class Mender {
 public:
  Mender(std::vector<double>& stamps, double step, View<double> counter)
      : stamps_(stamps), step_(step), counter_(counter) {}

  /// True if the counter said where.
  bool place(std::size_t k, std::optional<std::size_t> left, std::optional<std::size_t> right) {
    if (!left && !right) return false;
    if (!left || !right) {
      const std::size_t anchor = left ? *left : *right;
      const double rows = static_cast<double>(k) - static_cast<double>(anchor);
      stamps_[k] = stamps_[anchor] + rows * step_;
      return false;
    }
    const bool counted =
        !counter_.empty() && counter_[*left] < counter_[k] && counter_[k] < counter_[*right];
    const double fraction =
        counted ? (counter_[k] - counter_[*left]) / (counter_[*right] - counter_[*left])
                : static_cast<double>(k - *left) / static_cast<double>(*right - *left);
    stamps_[k] = std::lerp(stamps_[*left], stamps_[*right], fraction);
    return counted;
  }

 private:
  std::vector<double>& stamps_;
  double step_;
  View<double> counter_;
};

}  // namespace

StampSteps measure_steps(View<double> stamps) {
  StampSteps out;
  const std::vector<double> all = sampled_steps(stamps);
  if (all.empty()) return out;
  const auto fraction = [&](auto is_such) {
    return static_cast<double>(std::ranges::count_if(all, is_such)) /
           static_cast<double>(all.size());
  };
  out.ascending = fraction([](double step) { return step >= 0.0; });
  out.repeated = fraction([](double step) { return step == 0.0; });
  std::vector<double> up;
  std::ranges::copy_if(all, std::back_inserter(up), [](double step) { return step > 0.0; });
  if (up.empty()) return out;
  out.median = *median(up);
  out.rounding = rounding_of(up, out.median);
  Moments near;
  for (const double step : up)
    if (std::abs(step - out.median) <= 1.001 * out.rounding) near.add(step);
  out.mean_near = near.count > 0 ? near.mean : out.median;
  return out;
}

bool are_regular(View<double> stamps, double step) {
  // Without a branch, so that the compiler can take several at once.
  std::size_t odd = 0;
  for (std::size_t k = 1; k < stamps.size(); ++k) {
    const double rise = stamps[k] - stamps[k - 1];
    odd +=
        static_cast<std::size_t>(!(rise >= 0.0)) + static_cast<std::size_t>(!(rise <= 1.5 * step));
  }
  return odd == 0;
}

std::size_t unroll(std::vector<double>& stamps, double origin, double step) {
  struct Range {
    double bottom, top;
  };
  constexpr std::array<Range, 6> ranges{{{0.0, 0x1p16},
                                         {0.0, 0x1p24},
                                         {0.0, 0x1p31},
                                         {0.0, 0x1p32},
                                         {-0x1p15, 0x1p15},
                                         {-0x1p31, 0x1p31}}};
  const double near = 100.0 * step;
  std::size_t turns = 0;
  double added = 0.0;
  double last = stamps.empty() ? 0.0 : origin + stamps.front();
  for (double& stamp : stamps) {
    if (!is_stamp(stamp)) continue;
    const double reading = origin + stamp;
    if (reading < last && reading == std::trunc(reading)) {
      for (const Range& range : ranges) {
        const bool ran_over = last < range.top && range.top - last <= near &&
                              reading >= range.bottom && reading - range.bottom <= near &&
                              2.0 * near < range.top - range.bottom;
        if (!ran_over) continue;
        added += range.top - range.bottom;
        ++turns;
        break;
      }
    }
    last = reading;
    stamp += added;
  }
  return turns;
}

MendedStamps mend(std::vector<double>& stamps, double step, View<double> counter) {
  MendedStamps out;
  std::tie(out.samples, out.backwards) = find_bad(stamps, step);
  Mender mender(stamps, step, counter);
  for (std::size_t i = 0; i < out.samples.size();) {
    std::size_t end = i + 1;
    while (end < out.samples.size() && out.samples[end] == out.samples[end - 1] + 1) ++end;
    std::optional<std::size_t> left;
    std::optional<std::size_t> right;
    if (out.samples[i] > 0) left = out.samples[i] - 1;
    if (out.samples[end - 1] + 1 < stamps.size()) right = out.samples[end - 1] + 1;
    for (; i < end; ++i)
      if (mender.place(out.samples[i], left, right)) ++out.by_counter;
  }
  return out;
}

double uniform_rate_hz(View<double> stamps_s) {
  if (stamps_s.size() < 3 || !(stamps_s.back() > 0.0)) return 0.0;
  const auto fits = [&](double rate_hz) {
    for (std::size_t k = 0; k < stamps_s.size(); ++k)
      if (static_cast<double>(k) / rate_hz != stamps_s[k]) return false;
    return true;
  };
  const double rough_hz = static_cast<double>(stamps_s.size() - 1) / stamps_s.back();
  for (int digits = 1; digits <= 17; ++digits) {
    std::array<char, 32> text;
    const auto end = std::to_chars(text.data(), text.data() + text.size(), rough_hz,
                                   std::chars_format::scientific, digits);
    double rate_hz = 0.0;
    std::from_chars(text.data(), end.ptr, rate_hz);
    if (rate_hz > 0.0 && std::isfinite(rate_hz) && fits(rate_hz)) return rate_hz;
  }
  return 0.0;
}

}  // namespace proofmass::io
