#include "proofmass/signal/skew.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "proofmass/core/contract.hpp"
#include "proofmass/signal/even_grid.hpp"
#include "proofmass/signal/resample/sinc_kernel.hpp"

namespace proofmass::signal {
namespace {

constexpr std::ptrdiff_t reach = SincKernel::zeros;

/// Weights of the samples k − reach … k + reach.
std::vector<double> weights_of(double delay) {
  const SincKernel kernel(1.0);
  std::vector<double> weights;
  for (std::ptrdiff_t i = -reach; i <= reach; ++i)
    weights.push_back(kernel.at(static_cast<double>(i) + delay));
  return weights;
}

/// The channel on the even grid, delayed, and evaluated at the recorded samples.
std::vector<double> moved(View<double> values, double delay, const EvenGrid& grid) {
  const std::vector<double> even =
      delayed(on_even_grid(std::vector(values.begin(), values.end()), grid), delay);
  std::vector<double> out;
  out.reserve(values.size());
  auto hole = grid.holes.begin();
  std::size_t place = 0;
  for (std::size_t k = 0; k < values.size(); ++k, ++place) {
    if (hole != grid.holes.end() && hole->before == k) place += (hole++)->missing;
    out.push_back(even[place]);
  }
  return out;
}

}  // namespace

std::vector<double> delayed(View<double> series, double delay) {
  PM_EXPECTS(std::abs(delay) <= 1.0);
  if (delay == 0.0) return {series.begin(), series.end()};
  const std::vector<double> weights = weights_of(delay);
  const auto size = static_cast<std::ptrdiff_t>(series.size());
  const std::ptrdiff_t other = delay > 0.0 ? -1 : 1;
  std::vector<double> out(series.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::ptrdiff_t k = 0; k < size; ++k) {
    const auto value = [&](std::ptrdiff_t i) { return series[static_cast<std::size_t>(i)]; };
    // The two samples around the time; at the very end there is only one.
    const std::ptrdiff_t beside = std::clamp(k + other, std::ptrdiff_t{0}, size - 1);
    if (!std::isfinite(value(k)) || !std::isfinite(value(beside))) continue;
    double sum = 0.0;
    double total = 0.0;
    for (std::ptrdiff_t i = std::max(-reach, -k); i <= std::min(reach, size - 1 - k); ++i) {
      const double x = value(k + i);
      const double weight = weights[static_cast<std::size_t>(i + reach)];
      if (!std::isfinite(x)) continue;
      sum += weight * x;
      total += weight;
    }
    out[static_cast<std::size_t>(k)] = sum / total;
  }
  return out;
}

Result<Recording> without_skew(const Recording& recording, double between_s) {
  const double rate_hz = recording.time.rate_hz;
  if (!(rate_hz > 0.0) || !std::isfinite(between_s))
    return Error{Errc::invalid_argument, "the skew cannot be taken out: no sample rate is known"};
  const double last = between_s * rate_hz * static_cast<double>(recording.channels.size() - 1);
  if (std::abs(last) > 1.0)
    return Error{Errc::invalid_argument,
                 fmt::format("{} s between channels is too much: the last of {} would be {:.3g} "
                             "samples late, at most 1 is possible",
                             between_s, recording.channels.size(), last)};
  const auto grid = even_grid(recording.time, recording.samples());
  if (!grid) return grid.error();
  Recording out = recording;
  for (std::size_t c = 1; c < out.channels.size(); ++c) {
    const double delay = between_s * rate_hz * static_cast<double>(c);
    out.channels[c].values = moved(recording.channels[c].values, delay, *grid);
  }
  out.notes.push_back(
      {Severity::info, fmt::format("channels moved to the time of the first by {:.6g} s each, by a "
                                   "sinc of {} zeros under a Kaiser window",
                                   between_s, 2 * SincKernel::zeros)});
  return out;
}

}  // namespace proofmass::signal
