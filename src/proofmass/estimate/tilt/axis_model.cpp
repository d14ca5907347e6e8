#include "proofmass/estimate/tilt/axis_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include "proofmass/core/statistics.hpp"
#include "proofmass/estimate/tilt/gyroscope.hpp"
#include "proofmass/fit/minimise_smooth.hpp"

namespace proofmass::estimate {
namespace {

constexpr double prior_std = 3.0;  // of each logarithm
constexpr std::size_t most_epochs = 20000;

using Logs = std::array<double, 5>;

AxisTiltNoise noise_of(const Logs& logs) {
  return {.rate_noise_radps_rthz = std::exp(logs[0]),
          .rate_bias_walk_radps_rts = std::exp(logs[1]),
          .motion_std_rad = std::exp(logs[2]),
          .motion_time_s = std::exp(logs[3]),
          .reading_std_rad = std::exp(logs[4])};
}

AxisTiltEpochs head_of(const AxisTiltEpochs& all) {
  const std::size_t size = std::min(most_epochs, all.step_s.size());
  const auto head = [size](const std::vector<double>& values) {
    return std::vector<double>(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(size));
  };
  return {head(all.step_s), head(all.rate_radps), head(all.angle_rad)};
}

// Usual values, from the scatter of neighbouring angles.
Logs usual(const AxisTiltEpochs& epochs) {
  std::vector<double> steps;
  for (std::size_t k = 1; k < epochs.angle_rad.size(); ++k)
    steps.push_back(epochs.angle_rad[k] - epochs.angle_rad[k - 1]);
  const double scatter = std::max(1e-5, robust_std(steps).value_or(0.0));
  return {std::log(2e-3), std::log(1e-3), std::log(scatter), std::log(0.05),
          std::log(0.3 * scatter)};
}

}  // namespace

AxisTiltModel::AxisTiltModel(const AxisTiltEpochs& epochs,
                             const AxisTiltNoise& noise,
                             const AxisTiltOptions& options)
    : epochs_(epochs),
      noise_(noise),
      rate_bias_std_radps_(options.rate_bias_std_radps),
      rate_scale_std_(options.rate_scale_std) {
  Moments rates;
  for (const double rate : epochs.rate_radps) rates.add(rate);
  usual_rate_radps_ = rates.std();
}

Transition<3, 3> AxisTiltModel::transition(const Mat<3>& x, std::size_t k) const {
  const double h = epochs_.step_s[k], rate = epochs_.rate_radps[k];
  const bool known = std::isfinite(rate);
  const double phi = std::exp(-h / noise_.motion_time_s);
  Transition<3, 3> step{x, Mat<3, 3>::Identity(), Mat<3, 3>::Zero(), Mat<3>::Zero()};
  if (known) {
    step.mean(0) += h * (rate - x(1));
    step.F(0, 1) = -h;
  }
  step.mean(2) *= phi;
  step.F(2, 2) = phi;
  const double walk = square(noise_.rate_bias_walk_radps_rts);
  step.Q(0, 0) = known ? square(noise_.rate_noise_radps_rthz) * h + walk * h * h * h / 3.0 +
                             turn_variance_rad2(rate_scale_std_, square(rate), h)
                       : square(usual_rate_radps_) * h * std::max(h, unknown_turn_s);
  step.Q(0, 1) = step.Q(1, 0) = known ? -walk * h * h / 2.0 : 0.0;
  step.Q(1, 1) = walk * h;
  step.Q(2, 2) = square(noise_.motion_std_rad) * (1.0 - phi * phi);
  return step;
}

void AxisTiltModel::measure(const Mat<3>& x, std::size_t k, Readings<3, 1>& out) const {
  out.count = 0;
  const double z = epochs_.angle_rad[k];
  if (!std::isfinite(z)) return;
  out.rows[0] = {z, x(0) + x(2), square(noise_.reading_std_rad), Mat<3>(1.0, 0.0, 1.0)};
  out.count = 1;
}

FilterState<3> AxisTiltModel::start() const {
  FilterState<3> state;
  const auto first =
      std::ranges::find_if(epochs_.angle_rad, [](double angle) { return std::isfinite(angle); });
  state.x.mean(0) = first == epochs_.angle_rad.end() ? 0.0 : *first;
  // Flat prior of the angle, which the measurement itself then narrows.
  state.x.cov.diagonal() = Mat<3>(square(std::numbers::pi / std::sqrt(3.0)),
                                  square(rate_bias_std_radps_), square(noise_.motion_std_rad));
  return state;
}

double axis_log_likelihood(const AxisTiltEpochs& epochs,
                           const AxisTiltNoise& noise,
                           const AxisTiltOptions& options) {
  const AxisTiltModel model(epochs, noise, options);
  FilterState<3> state = model.start();
  double sum = 0.0;
  filter(model, {0, model.size()}, axis_gate, state,
         [&](std::size_t, const StepOf<AxisTiltModel>& step) {
           if (step.count == 0) return;
           const Update<3>& u = step.updates[0];
           const double off = std::sqrt(u.nis()), huber = axis_gate.huber;
           const double loss = off <= huber ? 0.5 * off * off : huber * (off - 0.5 * huber);
           sum -= loss + 0.5 * std::log(2.0 * std::numbers::pi * u.expected);
         });
  return sum;
}

AxisTiltNoise fit_axis_noise(const AxisTiltEpochs& all, const AxisTiltOptions& options) {
  const AxisTiltEpochs epochs = head_of(all);
  const Logs middle = usual(epochs);
  const auto value_at = [&](const Logs& logs) {
    double value = -axis_log_likelihood(epochs, noise_of(logs), options);
    for (std::size_t i = 0; i < logs.size(); ++i) {
      const double off = (logs[i] - middle[i]) / prior_std;
      value += 0.5 * off * off;
    }
    return value;
  };
  const auto function = [&](View<double> p, std::span<double> gradient) {
    Logs logs;
    std::ranges::copy(p, logs.begin());
    constexpr double h = 1e-3;
    for (std::size_t i = 0; i < gradient.size(); ++i) {
      Logs up = logs, down = logs;
      up[i] += h;
      down[i] -= h;
      gradient[i] = (value_at(up) - value_at(down)) / (2.0 * h);
    }
    return value_at(logs);
  };
  Logs start = middle;
  double lowest = std::numeric_limits<double>::infinity();
  for (const double time_s : {0.003, 0.03, 0.3}) {
    Logs trial = middle;
    trial[3] = std::log(time_s);
    const double value = value_at(trial);
    if (value >= lowest) continue;
    lowest = value;
    start = trial;
  }
  AxisTiltNoise noise = noise_of(start);
  const auto found = fit::minimise_smooth(function, std::vector<double>(start.begin(), start.end()),
                                          {.max_iterations = 60, .gradient_tolerance = 0.05});
  if (found) {
    Logs logs;
    std::ranges::copy(found->parameters, logs.begin());
    noise = noise_of(logs);
    noise.converged = found->converged;
  }
  noise.log_likelihood = axis_log_likelihood(all, noise, options);
  return noise;
}

}  // namespace proofmass::estimate
