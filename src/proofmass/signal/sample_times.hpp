#pragma once

#include <cstddef>

#include "proofmass/core/view.hpp"

namespace proofmass::signal {

/// A sample and its time: where something was seen.
struct Place {
  std::size_t sample = 0;
  double s = 0.0;  ///< since the first sample; its number where no rate is known
};

/// The times of a few consecutive samples.
struct SampleTimes {
  std::size_t first = 0;  ///< sample that stamps_s begins with
  View<double> stamps_s;  ///< empty: the samples are even
  double rate_hz = 0.0;   ///< 0: unknown

  [[nodiscard]] Place at(std::size_t k) const {
    const auto number = static_cast<double>(k);
    if (!stamps_s.empty()) return {k, stamps_s[k - first]};
    return {k, rate_hz > 0.0 ? number / rate_hz : number};
  }
};

}  // namespace proofmass::signal
