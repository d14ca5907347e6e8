#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "proofmass/core/recording_log.hpp"

namespace proofmass::acquire {

/// Histogram of delays with bins of a tenth of an octave from a microsecond to some minutes:
/// quantiles to 7 %.
class LatencyHistogram {
 public:
  void add(double seconds);
  [[nodiscard]] std::optional<Latency> latency() const;  ///< nullopt if empty

 private:
  [[nodiscard]] double quantile(double fraction) const;

  std::array<std::size_t, 320> bins_{};
  std::size_t count_ = 0;
  double worst_s_ = 0.0;
};

}  // namespace proofmass::acquire
