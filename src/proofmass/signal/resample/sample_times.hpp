#pragma once

#include <cstddef>

#include "proofmass/core/view.hpp"

namespace proofmass::signal {

/// A sample and its time: the location of a finding.
struct Place {
  std::size_t sample = 0;
  double s = 0.0;  ///< seconds from the first sample; the sample number if no rate is known
};

/// The times of a few consecutive samples.
struct SampleTimes {
  std::size_t first = 0;  ///< sample of the first stamp
  View<double> stamps_s;  ///< empty: the samples are evenly spaced
  double rate_hz = 0.0;   ///< 0 if unknown

  [[nodiscard]] Place at(std::size_t k) const {
    const auto number = static_cast<double>(k);
    if (!stamps_s.empty()) return {k, stamps_s[k - first]};
    return {k, rate_hz > 0.0 ? number / rate_hz : number};
  }
};

}  // namespace proofmass::signal
