#pragma once

#include <cmath>
#include <cstddef>
#include <optional>

#include "proofmass/core/view.hpp"

namespace proofmass::estimate {

struct UnmeasuredInterval {
  double from_s = 0.0, to_s = 0.0;
};

/// The first interval of more than `longest_s` without a value that is not NaN, between two that
/// are not or from the first time on.
[[nodiscard]] inline std::optional<UnmeasuredInterval> unmeasured_interval(View<double> time_s,
                                                                           View<double> values,
                                                                           double longest_s) {
  if (time_s.empty()) return std::nullopt;
  double last_s = time_s.front();
  for (std::size_t k = 0; k < time_s.size(); ++k) {
    if (std::isnan(values[k])) continue;
    if (time_s[k] - last_s > longest_s) return UnmeasuredInterval{last_s, time_s[k]};
    last_s = time_s[k];
  }
  return std::nullopt;
}

}  // namespace proofmass::estimate
