#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "proofmass/core/statistics.hpp"
#include "proofmass/estimate/wheel/readings.hpp"

namespace proofmass::estimate {

/// What the innovations of an encoder's fixes show of their variance beyond that of the counts. All
/// fixes count: where the variance is still too small, the gate rejects most of them.
class FixScatter {
 public:
  /// explained_rad2: variance of the innovation without FixNoise.
  void add(double speed_radps, double innovation_rad, double explained_rad2) {
    const Fix fix{square(speed_radps), square(innovation_rad), explained_rad2};
    if (std::isfinite(fix.speed2 + fix.innovation2 + fix.explained)) fixes_.push_back(fix);
  }

  /// From the means at the lower speeds and at the higher, to which a wild fix adds little. At one
  /// speed all of it is constant. nullopt for too few fixes.
  [[nodiscard]] std::optional<FixNoise> noise() {
    constexpr std::size_t fewest = 40;
    constexpr double one_speed = 1.2;
    if (fixes_.size() < fewest) return std::nullopt;
    const auto middle = fixes_.begin() + static_cast<std::ptrdiff_t>(fixes_.size() / 2);
    std::ranges::nth_element(fixes_, middle, {}, &Fix::speed2);
    const Half slow = half_of({fixes_.begin(), middle}), fast = half_of({middle, fixes_.end()});
    if (fast.speed2 < one_speed * slow.speed2) {
      const Half all = half_of(fixes_);
      return FixNoise{std::max(all.variance, 0.0), 0.0};
    }
    FixNoise noise;
    noise.stamps_s2 = std::clamp((fast.variance - slow.variance) / (fast.speed2 - slow.speed2), 0.0,
                                 std::max(fast.variance, 0.0) / fast.speed2);
    noise.constant_rad2 = std::max(slow.variance - noise.stamps_s2 * slow.speed2, 0.0);
    return noise;
  }

 private:
  struct Fix {
    double speed2, innovation2, explained;
  };
  struct Half {
    double speed2, variance;
  };

  static Half half_of(std::span<const Fix> fixes) {
    constexpr double median_of_square = 0.454936;  // χ² of one degree of freedom
    constexpr double wild = 10.0;
    std::vector<double> innovation2;
    for (const Fix& fix : fixes) innovation2.push_back(fix.innovation2);
    const double most = wild * *median(innovation2) / median_of_square;
    Half half{0.0, 0.0};
    for (const Fix& fix : fixes) {
      half.speed2 += fix.speed2;
      half.variance += std::min(fix.innovation2, most) - fix.explained;
    }
    const auto count = static_cast<double>(fixes.size());
    return {half.speed2 / count, half.variance / count};
  }

  std::vector<Fix> fixes_;
};

}  // namespace proofmass::estimate
