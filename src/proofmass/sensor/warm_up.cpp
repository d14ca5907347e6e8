#include "proofmass/sensor/warm_up.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "proofmass/core/contract.hpp"

namespace proofmass::sensor {
namespace {

using Gradient = std::array<double, 3>;  // with respect to a1, a2, T

Uncertain with_std(double value, const Gradient& gradient, const WarmUp& warm_up) {
  double variance = 0.0;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      variance += gradient[i] * warm_up.covariance[i][j] * gradient[j];
  return {value, std::sqrt(std::max(0.0, variance))};
}

bool has_figures(const DriftModel& drift, std::size_t axis) {
  return drift.a1[axis] || drift.a2[axis] || drift.time_constant[axis];
}

Error incomplete(std::string_view key, std::size_t axis, std::string_view what) {
  return {Errc::invalid_argument, fmt::format("drift.{} of axis {}: {}", key, "xyz"[axis], what)};
}

double variance_of(const std::optional<Figure>& figure) {
  const double std = figure->std_si().value_or(0.0);
  return std * std;
}

/// One channel without its departure; an error if it is not an acceleration.
Result<std::vector<double>> without(const WarmUp& gone,
                                    const Channel& channel,
                                    const TimeBase& time,
                                    double since_switch_on_s) {
  if (channel.unit.quantity != Quantity::acceleration)
    return Error{
        Errc::invalid_argument,
        fmt::format("channel {} is not an acceleration: calibrate it before its warm-up is "
                    "corrected",
                    channel.name)};
  std::vector<double> values = channel.values.copy();
  for (std::size_t k = 0; k < values.size(); ++k) {
    const double since_s = since_switch_on_s + time.at(k);
    values[k] =
        channel.unit.si(values[k]) + gone.a1_mps2 * std::exp(-since_s / gone.time_constant_s);
  }
  return values;
}

}  // namespace

Result<WarmUp> warm_up_of(const DriftModel& drift, std::size_t axis) {
  PM_EXPECTS(axis < 3);
  const auto &a1 = drift.a1[axis], &a2 = drift.a2[axis], &T = drift.time_constant[axis];
  if (!a1) return incomplete("a1", axis, "is missing");
  if (!a2) return incomplete("a2", axis, "is missing");
  if (!T) return incomplete("T", axis, "is missing");
  if (!(T->si() > 0.0)) return incomplete("T", axis, "must be positive");
  WarmUp warm_up{a1->si(), a2->si(), T->si(), {}};
  warm_up.covariance[0][0] = variance_of(a1);
  warm_up.covariance[1][1] = variance_of(a2);
  warm_up.covariance[2][2] = variance_of(T);
  return warm_up;
}

Uncertain bias_at(const WarmUp& warm_up, double since_switch_on_s) {
  return mean_bias(warm_up, {since_switch_on_s, since_switch_on_s});
}

Uncertain mean_bias(const WarmUp& warm_up, const OnTime& stretch) {
  PM_EXPECTS(stretch.from_s >= 0.0 && stretch.from_s <= stretch.to_s);
  const double T = warm_up.time_constant_s, s = stretch.from_s / T;
  const double h = (stretch.to_s - stretch.from_s) / T;
  // 1/h ∫ e^(−s−x) dx = e^(−s) q, q = (1 − e^(−h))/h, which is 1 where h is 0
  const double q = h > 0.0 ? -std::expm1(-h) / h : 1.0;
  const double left = std::exp(-s) * q;
  const double risen = h > 0.0 ? 1.0 - left : -std::expm1(-s);
  const double left_by_T = std::exp(-s) * (s * q + q - std::exp(-h)) / T;
  const double a1 = warm_up.a1_mps2;
  return with_std(warm_up.a2_mps2 + a1 * risen, {risen, 1.0, -a1 * left_by_T}, warm_up);
}

SettlingStep settling_step(const SettlingOptions& options) {
  PM_EXPECTS(options.dt_s >= 0.0 && options.time_constant_s > 0.0);
  const double settled = -std::expm1(-options.dt_s / options.time_constant_s);
  return {1.0 - settled, settled};
}

WarmUpStep warm_up_step(const WarmUp& warm_up, double dt_s) {
  const SettlingStep step = settling_step({dt_s, warm_up.time_constant_s});
  return {step.phi, step.settled * warm_up.settled_mps2()};
}

WarmUp departure(const WarmUp& warm_up) {
  WarmUp gone = warm_up;
  gone.a2_mps2 = -warm_up.a1_mps2;
  gone.covariance[1] = warm_up.covariance[0];
  for (double& entry : gone.covariance[1]) entry = -entry;
  for (std::size_t i = 0; i < 3; ++i) gone.covariance[i][1] = gone.covariance[1][i];
  gone.covariance[1][1] = warm_up.covariance[0][0];
  return gone;
}

Status remove_warm_up(const DriftModel& drift,
                      const Triad& triad,
                      const WarmUpOptions& options,
                      Recording& recording) {
  PM_EXPECTS(options.since_switch_on_s >= 0.0);
  if (recording.time.source == TimeSource::none)
    return Error{Errc::invalid_argument, "a warm-up needs the time of the samples"};
  std::vector<std::pair<std::size_t, std::vector<double>>> corrected;
  std::string left_alone;
  const std::array channels{triad.x, triad.y, triad.z};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!channels[axis]) continue;
    const Channel& channel = recording.channels[*channels[axis]];
    if (!has_figures(drift, axis)) {
      left_alone += (left_alone.empty() ? "" : ", ") + channel.name;
      continue;
    }
    const Result<WarmUp> warm_up = warm_up_of(drift, axis);
    if (!warm_up) return warm_up.error();
    auto values = without(*warm_up, channel, recording.time, options.since_switch_on_s);
    if (!values) return values.error();
    corrected.emplace_back(*channels[axis], std::move(values).value());
  }
  if (corrected.empty())
    return Error{Errc::invalid_argument, "the sensor file has no drift.a1, a2, T of these axes"};
  if (!left_alone.empty())
    recording.notes.push_back({Severity::info, "the sensor file has no warm-up of " + left_alone +
                                                   ": any warm-up remains in the data"});
  for (auto& [index, values] : corrected) {
    recording.channels[index].values = std::move(values);
    recording.channels[index].unit = {Quantity::acceleration, 1.0, 0.0, "m/s^2"};
  }
  return Done{};
}

bool has_warm_up(const DriftModel& drift) {
  return has_figures(drift, 0) || has_figures(drift, 1) || has_figures(drift, 2);
}

}  // namespace proofmass::sensor
