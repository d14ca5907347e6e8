#include "proofmass/thesis/static/bias_tracks.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "proofmass/estimate/models/bias_models.hpp"
#include "proofmass/sensor/noise_conversions.hpp"
#include "proofmass/thesis/means.hpp"

namespace proofmass::thesis {
namespace {

using characterise::DriftAnalysis;
using estimate::LinearModel;
using estimate::LinearRun;
using Bias = estimate::LinearSeries<1, 1, 1>;
using LinearStep = estimate::LinearStep<1, 1>;
// So long that a filter before the converter leaves the noise of neighbours independent.
constexpr double ours_s = 1.0;

using Epochs = std::vector<estimate::Epoch<1, 1>>;

/// Readings of one axis, evenly spaced, and the truth beside them where it is known.
struct Readings {
  double start_s, dt_s;
  std::vector<double> accel_mps2, true_bias_mps2;
  [[nodiscard]] double t_s(std::size_t k) const { return start_s + static_cast<double>(k) * dt_s; }
  [[nodiscard]] std::size_t size() const { return accel_mps2.size(); }
};

Readings means_of(const StaticRecord& record, const StaticAxis& axis, std::size_t by) {
  const double dt_s = 1.0 / record.rate_hz;
  return {.start_s = record.since_switch_on_s + 0.5 * static_cast<double>(by - 1) * dt_s,
          .dt_s = static_cast<double>(by) * dt_s,
          .accel_mps2 = means_over(axis.accel_mps2, by),
          .true_bias_mps2 = means_over(axis.true_bias_mps2, by)};
}

/// The bias at one epoch.
struct Estimate {
  double mps2, variance_m2ps4;
};

template <class At>
BiasTrack track_of(const Readings& readings, At&& at) {
  constexpr std::size_t most_points = 1800;
  const std::size_t stride = readings.size() / most_points + 1;
  BiasTrack track;
  double squares = 0.0, inside = 0.0, count = 0.0;
  for (std::size_t k = 0; k < readings.size(); ++k) {
    const Estimate now = at(k);
    const double std = std::sqrt(now.variance_m2ps4);
    if (k % stride == 0) {
      track.t_s.push_back(readings.t_s(k));
      track.value_mps2.push_back(now.mps2);
      track.std_mps2.push_back(std);
    }
    track.last_mps2 = {now.mps2, std};
    if (readings.true_bias_mps2.empty()) continue;
    const double error = now.mps2 - readings.true_bias_mps2[k];
    if (!std::isfinite(error) || !std::isfinite(std)) continue;
    squares += error * error;
    inside += std::abs(error) <= 1.96 * std ? 1.0 : 0.0;
    count += 1.0;
  }
  if (count > 0.0) {
    track.rms_error_mps2 = std::sqrt(squares / count);
    track.inside_95 = inside / count;
  }
  return track;
}

BiasTrack raw_track(const Readings& readings) {
  BiasTrack track =
      track_of(readings, [&](std::size_t k) { return Estimate{readings.accel_mps2[k], 0.0}; });
  track.inside_95.reset();
  return track;
}

// Innovations larger than modelled indicate additional noise: the variances are scaled accordingly.
// Source: R. T. Birge, Phys. Rev. 40 (1932) 207.
BiasTrack track_of(const Readings& readings,
                   const LinearRun<1, 1>& run,
                   estimate::PackedGaussian<1> LinearStep::* which) {
  const double nis = run.readings > 0 ? run.nis / static_cast<double>(run.readings) : 0.0;
  const double widened = std::max(1.0, nis);
  BiasTrack track = track_of(readings, [&](std::size_t k) {
    const estimate::PackedGaussian<1>& x = run.steps[k].*which;
    return Estimate{x.mean(0), widened * x.cov(0, 0)};
  });
  track.mean_nis = nis;
  return track;
}

template <class Input>
Epochs epochs_of(const Readings& readings, Input&& input) {
  Epochs epochs(readings.size());
  for (std::size_t k = 0; k < epochs.size(); ++k) {
    const double z = readings.accel_mps2[k];
    epochs[k].dt_s = k == 0 ? 0.0 : readings.dt_s;
    epochs[k].z(0) = std::isfinite(z) ? z : std::nan("");
    epochs[k].u(0) = k == 0 ? 0.0 : input(k);
  }
  return epochs;
}

double variance_about(const Readings& readings, const sensor::WarmUp& curve) {
  double squares = 0.0, count = 0.0;
  for (std::size_t k = 0; k < readings.size(); ++k) {
    const double residual = readings.accel_mps2[k] - sensor::bias_at(curve, readings.t_s(k)).value;
    if (!std::isfinite(residual)) continue;
    squares += residual * residual;
    count += 1.0;
  }
  return squares / count;
}

BiasTrack track_by_thesis(const Readings& readings, const PlainFit& fit) {
  const sensor::WarmUp curve{.a1_mps2 = fit.a1_mps2.value,
                             .a2_mps2 = fit.a2_mps2.value,
                             .time_constant_s = fit.time_constant_s.value};
  const double variance = variance_about(readings, curve);
  auto model = estimate::bias_model({.bias = {.dt_s = readings.dt_s,
                                              .time_constant_s = curve.time_constant_s,
                                              .bias_psd_m2ps5 = 0.0},
                                     .accel_variance_m2ps4 = variance});
  model.Q(0, 0) = variance;
  const auto series = Bias::make(epochs_of(readings, [&](auto) { return curve.settled_mps2(); }),
                                 [&](double) { return model; });
  if (!series) return {};
  auto start = estimate::bias_prior(curve, readings.t_s(0));
  start.cov(0, 0) = variance;
  return track_of(readings, filter_linear(*series, start), &LinearStep::filtered);
}

/// Two-sided density of the white noise that drives all drift, over short times.
double bias_walk_psd_m2ps5(const characterise::DriftNoise& noise, double duration_s) {
  double psd = noise.random_walk * noise.random_walk + noise.markov * noise.markov;
  if (noise.flicker > 0.0) {
    // The Markov process that approximates flicker at times a tenth of the record.
    psd += sensor::markov_of_flicker({noise.flicker, 0.1 * duration_s}).psd_m2ps5;
  }
  return psd;
}

/// Ours: the measurements about a curve, with a random-walk bias.
Result<LinearRun<1, 1>> run_beside(const Readings& readings, const DriftAnalysis& drift) {
  const characterise::DriftCurve& curve = drift.fit.curve;
  const double white = drift.fit.noise.white;
  LinearModel<1, 1, 1> model;
  model.F.setOnes();
  model.H.setOnes();
  model.B.setOnes();
  model.Q(0, 0) = bias_walk_psd_m2ps5(drift.fit.noise, drift.duration_s) * readings.dt_s;
  model.R(0) = white > 0.0 ? white * white / readings.dt_s
                           : drift.residual_rms * drift.residual_rms;  // white noise was not seen
  const auto moved = [&](std::size_t k) {
    return curve.value(readings.t_s(k)) - curve.value(readings.t_s(k - 1));
  };
  const auto series = Bias::make(epochs_of(readings, moved), [&](double) { return model; });
  if (!series) return series.error();
  return smooth_linear(*series, estimate::Start<1>::diffuse());
}

}  // namespace

BiasTracks bias_tracks(const StaticRecord& record,
                       const StaticAxis& axis,
                       const DriftAnalysis& drift,
                       const std::optional<PlainFit>& plain) {
  const Readings readings = means_of(record, axis, 1);
  BiasTracks tracks;
  tracks.raw = raw_track(readings);
  if (plain) tracks.thesis = track_by_thesis(readings, *plain);
  const auto by = static_cast<std::size_t>(std::max(1.0, std::round(ours_s * record.rate_hz)));
  const Readings slower = means_of(record, axis, by);
  if (const auto run = run_beside(slower, drift)) {
    tracks.filtered = track_of(slower, *run, &LinearStep::filtered);
    tracks.smoothed = track_of(slower, *run, &LinearStep::smoothed);
  }
  return tracks;
}

}  // namespace proofmass::thesis
