#include "proofmass/acquire/recorder/latency_histogram.hpp"

#include <algorithm>
#include <cmath>

namespace proofmass::acquire {
namespace {

constexpr double least_s = 1e-6;
constexpr double bins_an_octave = 10.0;

}  // namespace

void LatencyHistogram::add(double seconds) {
  const double place = bins_an_octave * std::log2(std::max(seconds, least_s) / least_s);
  const double last = static_cast<double>(bins_.size() - 1);
  ++bins_[static_cast<std::size_t>(std::clamp(place, 0.0, last))];
  ++count_;
  worst_s_ = std::max(worst_s_, seconds);
}

double LatencyHistogram::quantile(double fraction) const {
  const double wanted = fraction * static_cast<double>(count_);
  std::size_t below = 0;
  for (std::size_t bin = 0; bin < bins_.size(); ++bin) {
    below += bins_[bin];
    if (static_cast<double>(below) < wanted) continue;
    const double upper_s = least_s * std::exp2((static_cast<double>(bin) + 1.0) / bins_an_octave);
    return std::min(upper_s, worst_s_);
  }
  return worst_s_;
}

std::optional<Latency> LatencyHistogram::latency() const {
  if (count_ == 0) return std::nullopt;
  return Latency{count_, quantile(0.5), quantile(0.99), worst_s_};
}

}  // namespace proofmass::acquire
