#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "proofmass/core/view.hpp"
#include "proofmass/io/time/stamps.hpp"
#include "proofmass/io/time/wrap.hpp"

namespace proofmass::io {

/// Look-ahead window: the stamps after one, unwrapped.
class StampLookahead {
 public:
  /// `shift` is to be added to the stamps at k.
  StampLookahead(View<double> stamps, std::size_t k, double shift) {
    for (std::size_t i = k + 1; i < stamps.size() && i < k + StampMender::window; ++i) {
      if (!is_stamp(stamps[i])) continue;
      next_[count_++] = stamps[i] + shift;
      if (count_ == most) break;
    }
  }

  /// `from` is the stamp at k; `origin` the clock value where it is 0.
  void unroll(double from, const WrapFinder& wraps, double origin, double usual) {
    double added = 0.0;
    double last = from;
    for (std::size_t i = 0; i < count_; ++i) {
      const double reading = next_[i];
      if (reading < last)
        if (const auto wrap = wraps.find(origin + last, origin + reading, usual, std::nullopt))
          added += wraps[*wrap].range();
      last = reading;
      next_[i] += added;
    }
  }

  [[nodiscard]] std::size_t count() const { return count_; }
  /// True if the predicate holds for the majority.
  template <class Such>
  [[nodiscard]] bool most_are(Such is_such) const {
    return std::ranges::count_if(seen(), is_such) * 2 > static_cast<std::ptrdiff_t>(count_);
  }
  /// True if the next two follow `stamp` at the usual interval: the clock was set, the stamp is not
  /// an outlier.
  [[nodiscard]] bool go_on(double stamp, double usual) const {
    const auto is_usual = [&](double step) { return step >= 0.0 && step < usual; };
    return count_ >= 2 && is_usual(next_[0] - stamp) && is_usual(next_[1] - next_[0]);
  }
  /// True if a stamp that is ahead of its time is the only one: the following stamps lie between
  /// the last good one and it.
  [[nodiscard]] bool leave_behind(double stamp, double last, double usual) const {
    const auto between = [&](double next) { return next >= last && next < stamp; };
    if (count_ == 0 || go_on(stamp, usual)) return false;
    if (most_are(between)) return true;
    return count_ >= 2 && between(next_[0]) && next_[1] >= next_[0] &&
           (next_[1] < stamp || next_[1] - next_[0] <= usual);
  }

 private:
  static constexpr std::size_t most = 8;
  [[nodiscard]] std::span<const double> seen() const { return std::span(next_).first(count_); }

  std::array<double, most> next_{};
  std::size_t count_ = 0;
};

}  // namespace proofmass::io
