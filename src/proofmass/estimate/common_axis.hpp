#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "proofmass/estimate/fusion.hpp"
#include "proofmass/estimate/fusion_model.hpp"

// The filter behind fuse_axis(), one size for each number of sensors.
namespace proofmass::estimate {

/// Sensors chosen for one filter; their number is that of its template.
using Chosen = std::vector<const AxisSensor*>;

inline BiasStep bias_step_of(const AxisSensor& sensor, double dt_s) {
  if (sensor.bias_time_constant_s)
    return bias_step({dt_s, *sensor.bias_time_constant_s, sensor.bias_psd_m2ps5});
  return random_walk_step({dt_s, sensor.bias_psd_m2ps5});
}

/// The readings of one filter as kalman.hpp takes them, states and equations as in
/// common_axis_model().
template <int S>
class CommonAxis {
 public:
  static constexpr int states = 3 + S, moving = states, channels = S + 2;
  using State = Mat<states>;

  CommonAxis(const std::vector<double>& time_s, const Chosen& sensors, const FusionOptions& options)
      : time_s_(time_s),
        sensors_(sensors),
        jerk_psd_(options.jerk_psd_m2ps5),
        velocity_at_(time_s.size(), nullptr),
        position_at_(time_s.size(), nullptr) {
    for (const AxisReading& reading : options.velocities_mps)
      velocity_at_[reading.sample] = &reading;
    for (const AxisReading& reading : options.positions_m) position_at_[reading.sample] = &reading;
  }

  [[nodiscard]] std::size_t size() const { return time_s_.size(); }

  [[nodiscard]] Transition<states, states> transition(const State& x, std::size_t k) const {
    const double dt_s = time_s_[k] - time_s_[k - 1];
    std::array<BiasStep, static_cast<std::size_t>(S)> biases;
    Mat<S> levels;
    for (int i = 0; i < S; ++i) {
      biases[static_cast<std::size_t>(i)] = bias_step_of(sensor(i), dt_s);
      levels(i) = sensor(i).bias_mps2;
    }
    const auto model = common_axis_model<S>({dt_s, jerk_psd_, 1.0}, biases, Mat<S + 2>::Ones());
    return {model.F * x + model.B * levels, model.F, model.Q, State::Zero()};
  }

  void measure(const State& x, std::size_t k, Readings<states, channels>& out) const {
    out.count = 0;
    const auto add = [&](double value, double variance, State h) {
      out.rows[static_cast<std::size_t>(out.count++)] = {value, h.dot(x), variance, h};
    };
    for (int i = 0; i < S; ++i) {
      const double value = sensor(i).accel_mps2[k];
      if (std::isnan(value)) continue;
      State h = State::Unit(pva::accel_mps2);
      h(3 + i) = 1.0;
      add(value, sensor(i).accel_variance_m2ps4, h);
    }
    if (const AxisReading* v = velocity_at_[k])
      add(v->value, v->std * v->std, State::Unit(pva::velocity_mps));
    if (const AxisReading* p = position_at_[k])
      add(p->value, p->std * p->std, State::Unit(pva::position_m));
  }

  void reopen(Gaussian<states>&) const {}

 private:
  [[nodiscard]] const AxisSensor& sensor(int i) const {
    return *sensors_[static_cast<std::size_t>(i)];
  }

  const std::vector<double>& time_s_;
  const Chosen& sensors_;
  double jerk_psd_;
  std::vector<const AxisReading*> velocity_at_, position_at_;
};

template <int S>
Gaussian<3 + S> axis_prior(const Chosen& sensors, const FusionOptions& options) {
  Gaussian<3 + S> prior;
  const auto set = [&](int i, const Uncertain& known) {
    prior.mean(i) = known.value;
    prior.cov(i, i) = known.std * known.std;
  };
  set(pva::position_m, options.position_m);
  set(pva::velocity_mps, options.velocity_mps);
  set(pva::accel_mps2, options.accel_mps2);
  for (int i = 0; i < S; ++i) {
    const AxisSensor& sensor = *sensors[static_cast<std::size_t>(i)];
    set(3 + i, {sensor.bias_mps2, sensor.bias_std_mps2});
  }
  return prior;
}

namespace fusion_detail {

inline double root(double variance) {
  return std::sqrt(std::max(variance, 0.0));
}

template <int N>
void set_entry(const Mat<N>& mean, const Mat<3>& variance, std::size_t k, AxisMotion& out) {
  out.position_m[k] = mean(0);
  out.velocity_mps[k] = mean(1);
  out.accel_mps2[k] = mean(2);
  out.position_std_m[k] = root(variance(0));
  out.velocity_std_mps[k] = root(variance(1));
  out.accel_std_mps2[k] = root(variance(2));
}

inline AxisMotion of_size(std::size_t size) {
  const std::vector<double> zeros(size, 0.0);
  return {zeros, zeros, zeros, zeros, zeros, zeros};
}

template <int N, int M>
void score(const Step<N, N, M>& step, AxisEstimate& out) {
  for (int i = 0; i < step.count; ++i) {
    const Update<N>& update = step.updates[static_cast<std::size_t>(i)];
    out.log_likelihood -= 0.5 * (std::log(2.0 * std::numbers::pi * update.expected) + update.nis());
    out.nis += update.nis();
    ++out.readings;
  }
}

}  // namespace fusion_detail

/// One filter and smoother of S sensors, with what fuse_axis() reports of it.
template <int S>
AxisEstimate estimate_axis(const std::vector<double>& time_s,
                           const Chosen& sensors,
                           const FusionOptions& options) {
  constexpr int N = 3 + S;
  const CommonAxis<S> axis(time_s, sensors, options);
  AxisEstimate out;
  out.filtered = out.smoothed = fusion_detail::of_size(time_s.size());
  using StepHere = Step<N, N, S + 2>;
  Gaussian<N> last;
  smooth(
      axis, FilterState<N>{axis_prior<S>(sensors, options)}, Gate{},
      [&](std::size_t k, const StepHere& step) {
        fusion_detail::set_entry<N>(
            step.filtered.mean, step.filtered.cov.diagonal().template head<3>(), k, out.filtered);
        fusion_detail::score(step, out);
        last = step.filtered;
      },
      [&](std::size_t k, const StepHere& step, const Hindsight<N>& later) {
        const Mat<N> mean = later.mean(step.filtered);
        fusion_detail::set_entry<N>(mean, later.template cov<3>(step.filtered).diagonal(), k,
                                    out.smoothed);
      });
  for (int i = 3; i < N; ++i)
    out.bias_mps2.push_back({last.mean(i), fusion_detail::root(last.cov(i, i))});
  if (out.readings > 0) out.nis /= static_cast<double>(out.readings);
  return out;
}

extern template AxisEstimate estimate_axis<1>(const std::vector<double>&,
                                              const Chosen&,
                                              const FusionOptions&);
extern template AxisEstimate estimate_axis<2>(const std::vector<double>&,
                                              const Chosen&,
                                              const FusionOptions&);
extern template AxisEstimate estimate_axis<3>(const std::vector<double>&,
                                              const Chosen&,
                                              const FusionOptions&);
extern template AxisEstimate estimate_axis<4>(const std::vector<double>&,
                                              const Chosen&,
                                              const FusionOptions&);

}  // namespace proofmass::estimate
