#include "proofmass/thesis/gain/readings.hpp"

#include <cmath>
#include <complex>
#include <utility>

#include "proofmass/core/contract.hpp"
#include "proofmass/core/random.hpp"
#include "proofmass/estimate/filter/linear_gaussian.hpp"
#include "proofmass/estimate/motion_models.hpp"

namespace proofmass::thesis {
namespace {

using estimate::Epoch;
using estimate::GainStudyOptions;

double true_accel_mps2(SimulatedAxis axis, double t_s) {
  return axis == SimulatedAxis::x ? std::sin(t_s) : std::cos(t_s);
}

double rms(const std::vector<double>& values, const std::vector<double>& truth) {
  double sum = 0.0;
  for (std::size_t k = 0; k < truth.size(); ++k)
    sum += (values[k] - truth[k]) * (values[k] - truth[k]);
  return std::sqrt(sum / static_cast<double>(truth.size()));
}

// Mean and standard deviation, one value after the other (Welford).
struct Scatter {
  double mean = 0.0, sum = 0.0;
  std::size_t count = 0;

  void add(double value) {
    const double off = value - mean;
    mean += off / static_cast<double>(++count);
    sum += off * (value - mean);
  }
  [[nodiscard]] Uncertain found() const {
    return {.value = mean, .std = std::sqrt(sum / static_cast<double>(count - 1))};
  }
};

}  // namespace

SimulatedReadings simulate_readings(const GainStudyOptions& options,
                                    SimulatedAxis axis,
                                    std::uint64_t seed,
                                    std::size_t set) {
  Random noise(seed, axis == SimulatedAxis::x ? "gain study, x" : "gain study, y", set);
  const double noise_mps2 = std::sqrt(options.accel_variance_m2ps4);
  const auto steps =
      static_cast<std::size_t>(std::floor(options.duration_s / options.step_s + 1e-9));
  SimulatedReadings out;
  std::vector<Epoch<1>> epochs(steps + 1);
  for (std::size_t k = 0; k <= steps; ++k) {
    const double t_s = static_cast<double>(k) * options.step_s;
    out.time_s.push_back(t_s);
    out.truth_mps2.push_back(true_accel_mps2(axis, t_s));
    out.reading_mps2.push_back(out.truth_mps2.back() + noise_mps2 * noise.normal());
    epochs[k].dt_s = options.step_s;
    epochs[k].z(0) = out.reading_mps2.back();
  }
  const auto series = estimate::LinearSeries<3, 1>::make(std::move(epochs), [&](double dt_s) {
    return estimate::pva_model({.dt_s = dt_s,
                                .jerk_psd_m2ps5 = options.jerk_psd_m2ps5,
                                .accel_variance_m2ps4 = options.accel_variance_m2ps4});
  });
  PM_EXPECTS(series.has_value());
  const estimate::Gaussian<3> start{
      .mean = estimate::Mat<3>::Zero(),
      .cov = estimate::Mat<3, 3>::Identity() * options.prior_variance};
  const auto run = estimate::smooth_linear(*series, start);
  for (const auto& step : run.steps) {
    out.filtered_mps2.push_back(step.filtered.mean(estimate::pva::accel_mps2));
    out.smoothed_mps2.push_back(step.smoothed.mean(estimate::pva::accel_mps2));
  }
  return out;
}

ReadingErrors reading_errors(const GainStudyOptions& options,
                             SimulatedAxis axis,
                             std::uint64_t seed,
                             std::size_t sets) {
  PM_EXPECTS(sets >= 2);
  Scatter reading, filtered, smoothed;
  for (std::size_t set = 0; set < sets; ++set) {
    const SimulatedReadings one = simulate_readings(options, axis, seed, set);
    reading.add(rms(one.reading_mps2, one.truth_mps2));
    filtered.add(rms(one.filtered_mps2, one.truth_mps2));
    smoothed.add(rms(one.smoothed_mps2, one.truth_mps2));
  }
  return {.reading = reading.found(), .filtered = filtered.found(), .smoothed = smoothed.found()};
}

FilterResponse filter_response(const estimate::GainStudy& study, double omega_radps) {
  const double k = study.limit[2], step_s = study.options.step_s;
  PM_EXPECTS(k > 0.0 && k < 1.0);
  const std::complex<double> H = k / (1.0 - (1.0 - k) * std::polar(1.0, -omega_radps * step_s));
  return {.amplitude = std::abs(H),
          .delay_s = -std::arg(H) / omega_radps,
          .time_constant_s = -step_s / std::log1p(-k)};
}

}  // namespace proofmass::thesis
