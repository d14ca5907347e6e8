#include <algorithm>
#include <cmath>
#include <utility>

#include "proofmass/core/contract.hpp"
#include "proofmass/thesis/means.hpp"
#include "proofmass/thesis/static_bias.hpp"

namespace proofmass::thesis {
namespace {

constexpr double kept_rate_hz = 40.0;  // the thesis's 1 kHz, down-sampled by 25
constexpr std::size_t most_values = 500'000;

std::size_t decimation_for(double rate_hz, std::size_t samples) {
  const auto by_rate = static_cast<std::size_t>(std::max(1.0, std::floor(rate_hz / kept_rate_hz)));
  return std::max(by_rate, (samples + most_values - 1) / most_values);
}

StaticAxis decimated(const StaticAxis& raw, std::size_t by) {
  StaticAxis axis{.name = raw.name, .accel_mps2 = {}};
  const View<double> samples = raw.accel_mps2;
  axis.accel_mps2 = means_over(samples, by);
  axis.picked_mps2.reserve(axis.accel_mps2.size());
  for (std::size_t k = 0; k < axis.accel_mps2.size(); ++k)
    axis.picked_mps2.push_back(samples[k * by]);
  return axis;
}

}  // namespace

StaticRecord static_record(std::string source,
                           double rate_hz,
                           double since_switch_on_s,
                           std::vector<StaticAxis> raw) {
  PM_EXPECTS(rate_hz > 0.0);
  std::size_t longest = 0;
  for (const StaticAxis& axis : raw) longest = std::max(longest, axis.accel_mps2.size());
  const std::size_t by = decimation_for(rate_hz, longest);
  // A mean stands in the middle of its samples.
  const double middle_s = 0.5 * static_cast<double>(by - 1) / rate_hz;
  StaticRecord record{.source = std::move(source),
                      .rate_hz = rate_hz / static_cast<double>(by),
                      .decimation = by,
                      .since_switch_on_s = since_switch_on_s + middle_s,
                      .axes = {}};
  for (StaticAxis& axis : raw)
    record.axes.push_back(by == 1 ? std::move(axis) : decimated(axis, by));
  return record;
}

}  // namespace proofmass::thesis
