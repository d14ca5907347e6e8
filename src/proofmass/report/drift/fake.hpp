#pragma once

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "proofmass/core/units.hpp"
#include "proofmass/report/drift/report.hpp"

// Synthetic analyses with known figures, for the tests of this module.
namespace proofmass::report {

inline constexpr double fake_mg = 1e-3 * standard_gravity_mps2;

inline characterise::Interval95 fake_interval(double value, double std) {
  return {value, std, value - 1.96 * std, value + 1.96 * std};
}

inline signal::WhitenessTest fake_whiteness(double scale_s, std::size_t values, double memory) {
  signal::WhitenessTest test;
  test.scale_s = scale_s;
  test.values = values;
  test.lags = static_cast<std::size_t>(std::sqrt(static_cast<double>(values)));
  test.bound = 1.96 / std::sqrt(static_cast<double>(values));
  std::mt19937_64 random(values);
  std::normal_distribution<double> draw(0.0, test.bound / 1.96);
  std::size_t inside = 0;
  for (std::size_t k = 1; k <= test.lags; ++k) {
    const double r =
        memory * std::exp(-4.0 * static_cast<double>(k) / static_cast<double>(test.lags));
    test.autocorrelation.push_back(r + draw(random));
    if (std::abs(test.autocorrelation.back()) <= test.bound) ++inside;
  }
  test.inside_bounds = static_cast<double>(inside) / static_cast<double>(test.lags);
  test.white = memory == 0.0;
  test.ljung_box_p = test.white ? 0.62 : 1e-9;
  test.periodogram_p = test.white ? 0.4 : 1e-5;
  test.runs_p = test.white ? 0.8 : 1e-4;
  return test;
}

/// Minimum and maximum of the curve plus noise with standard deviation `std`.
inline characterise::Envelope fake_envelope(const characterise::DriftCurve* curve,
                                            double duration_s,
                                            double scale_s,
                                            double std) {
  characterise::Envelope envelope;
  envelope.scale_s = scale_s;
  std::mt19937_64 random(7);
  std::normal_distribution<double> draw(0.0, std);
  constexpr int stretches = 400;
  for (int k = 0; k < stretches; ++k) {
    const double t_s = (k + 0.5) * duration_s / stretches;
    const double level = curve == nullptr ? 0.0 : curve->value(t_s);
    envelope.t_s.push_back(t_s);
    envelope.lower.push_back(level - std::abs(draw(random)));
    envelope.upper.push_back(level + std::abs(draw(random)));
  }
  return envelope;
}

/// Series of the fit: curve, envelopes, whiteness at 1, 10 and 100 s.
inline void fake_series(characterise::DriftAnalysis& analysis, double memory) {
  analysis.rate_hz = 1.0;
  analysis.samples = 7200;
  analysis.missing = 12;
  analysis.duration_s = 7200.0;
  analysis.block_s = 4.0;
  for (int k = 0; k < 1800; ++k) {
    const double ripple = 0.5 * fake_mg * std::sin(2.1 * k);
    analysis.block_mean.push_back(analysis.fit.curve.value(4.0 * k + 2.0) + ripple);
    analysis.block_bias.push_back(analysis.fit.curve.value(4.0 * k + 2.0));
  }
  analysis.residual_rms = fake_mg;
  analysis.whiteness = {fake_whiteness(1.0, 7200, 0.0), fake_whiteness(10.0, 720, 0.0),
                        fake_whiteness(100.0, 72, memory)};
  analysis.whitened = fake_whiteness(4.0, 1800, 0.0);
  analysis.data = fake_envelope(&analysis.fit.curve, 7200.0, 1.0, 1.5 * fake_mg);
  analysis.residuals = {fake_envelope(nullptr, 7200.0, 1.0, 1.5 * fake_mg),
                        fake_envelope(nullptr, 7200.0, 10.0, 0.5 * fake_mg),
                        fake_envelope(nullptr, 7200.0, 100.0, 0.2 * fake_mg)};
  analysis.outliers = {{signal::EventKind::outlier, 1200, 1203, 0.05, 20.0}};
  analysis.notes = {{Severity::warning, "an outlier at 1200 s"}};
}

inline void fake_profile(characterise::DriftFit& fit, double curvature) {
  for (double time_s = 20.0; time_s < 72'000.0; time_s *= 1.03) {
    const double away = std::log(time_s / fit.best_time_constant_s);
    fit.profile.push_back({time_s, curvature * away * away / (1.0 + 0.1 * away * away)});
  }
}

inline ChannelDrift fake_channel_of(const std::string& name) {
  ChannelDrift channel;
  channel.name = name;
  channel.file = "rest <1>.csv";
  channel.unit = *parse_unit("m/s^2");
  channel.rest = RestShare{.share = 1.0, .longest_start_s = 0.0, .longest_end_s = 7200.0};
  return channel;
}

/// A warm-up of 5.00 ± 0.10 mg with 900 ± 20 s, starting at 1.50 ± 0.05 mg, under white noise and a
/// random walk.
inline ChannelDrift fake_warm_up(const std::string& name) {
  ChannelDrift channel = fake_channel_of(name);
  characterise::DriftAnalysis& analysis = channel.analysis.emplace();
  characterise::DriftFit& fit = analysis.fit;
  fit.curve.shape = characterise::DriftShape::exponential;
  fit.curve.a2 = 1.5 * fake_mg;
  fit.curve.a1 = 5.0 * fake_mg;
  fit.curve.time_constant_s = 900.0;
  fit.curve.covariance = Eigen::Vector3d(std::pow(0.05 * fake_mg, 2), std::pow(0.1 * fake_mg, 2),
                                         std::pow(20.0 / 900.0, 2))
                             .asDiagonal();
  fit.noise.white = 1.0 * fake_mg;
  fit.noise.random_walk = 0.005 * fake_mg;
  fit.identified = true;
  fit.why = characterise::DriftReason::identified;
  fit.a2 = fake_interval(1.5 * fake_mg, 0.05 * fake_mg);
  fit.a1 = fake_interval(5.0 * fake_mg, 0.1 * fake_mg);
  fit.time_constant_s = characterise::Interval95{900.0, 20.0, 862.0, 941.0};
  fit.best_time_constant_s = 900.0;
  fit.constant_deviance = 512.0;
  fit.constant_p = 1e-110;
  fit.line_deviance = 208.0;
  fit.line_p = 2e-45;
  fit.undetected_below = 0.3 * fake_mg;
  fit.candidates = {{characterise::DriftShape::exponential, 5, 41'020.0, -81'996.0, 900.0, 0},
                    {characterise::DriftShape::line, 4, 40'916.0, -81'797.0, {}, 0},
                    {characterise::DriftShape::constant, 3, 40'764.0, -81'501.0, {}, 0}};
  fake_profile(fit, 2000.0);
  fit.end.t_s = 7200.0;
  fit.end.covariance = Eigen::MatrixXd::Zero(6, 6);
  fit.end.covariance.topLeftCorner(3, 3) = fit.curve.covariance;
  fit.end.covariance(3, 3) = std::pow(0.2 * fake_mg, 2);
  fit.block_s = 4.0;
  fake_series(analysis, 0.5);
  return channel;
}

/// Three steps of −2.0, 4.1 and 1.0 mg instead of an exponential.
inline ChannelDrift fake_steps(const std::string& name) {
  ChannelDrift channel = fake_channel_of(name);
  characterise::DriftAnalysis& analysis = channel.analysis.emplace();
  characterise::DriftFit& fit = analysis.fit;
  fit.curve.shape = characterise::DriftShape::steps;
  fit.curve.a2 = standard_gravity_mps2;
  const double size_std = 0.1 * fake_mg;
  fit.curve.steps = {{1500.0, {-2.0 * fake_mg, size_std}},
                     {3300.0, {4.1 * fake_mg, size_std}},
                     {5200.0, {1.0 * fake_mg, size_std}}};
  fit.curve.covariance = Eigen::MatrixXd::Identity(4, 4) * size_std * size_std;
  fit.noise.white = 1.0 * fake_mg;
  fit.noise.markov = 0.05 * fake_mg;
  fit.noise.markov_time_constant_s = 60.0;
  fit.why = characterise::DriftReason::steps;
  fit.reason = "three steps explain the drift better than an exponential";
  fit.a2 = fake_interval(fit.curve.a2, size_std);
  fit.best_time_constant_s = 2500.0;
  fit.constant_deviance = 6.0;
  fit.constant_p = 0.05;
  fit.line_deviance = 0.4;
  fit.line_p = 0.5;
  fit.undetected_below = 2.0 * fake_mg;
  fit.time_constant_above_s = 400.0;
  fit.candidates = {{characterise::DriftShape::steps, 10, 40'980.0, -81'880.0, {}, 3},
                    {characterise::DriftShape::constant, 3, 40'764.0, -81'501.0, {}, 0}};
  fake_profile(fit, 1.5);
  fake_series(analysis, 0.8);
  return channel;
}

inline ChannelDrift fake_refused(const std::string& name) {
  ChannelDrift channel = fake_channel_of(name);
  channel.refused = "the values do not vary";
  return channel;
}

/// −2 mg/K between 290 and 310 K; 0.3 mg more while heating than while cooling.
inline DriftTemperature fake_temperature() {
  DriftTemperature found{.channel = "temp", .model = {}, .refused = ""};
  characterise::TemperatureModel& model = found.model.emplace();
  model.verdict = characterise::Verdict::identified;
  model.notes = {"the chip warms itself"};
  model.lowest_k = 290.0;
  model.highest_k = 310.0;
  model.reference_k = 300.0;
  model.degree = 1;
  model.coefficients = {{3.0 * fake_mg, 0.1 * fake_mg}, {-2.0 * fake_mg, 0.05 * fake_mg}};
  model.covariance =
      Eigen::Vector2d(std::pow(0.1 * fake_mg, 2), std::pow(0.05 * fake_mg, 2)).asDiagonal();
  model.basis = {.reference_k = 300.0, .scale_k = 10.0, .alpha = {0.0}, .beta = {0.0}};
  model.basis_coefficients = Eigen::Vector2d(3.0 * fake_mg, -20.0 * fake_mg);
  model.basis_covariance =
      Eigen::Vector2d(std::pow(0.1 * fake_mg, 2), std::pow(0.5 * fake_mg, 2)).asDiagonal();
  model.bias_span = 40.0 * fake_mg;
  model.hysteresis = Uncertain{0.3 * fake_mg, 0.05 * fake_mg};
  model.hysteresis_significant = true;
  model.slope_upper_95 = 2.1 * fake_mg;
  model.cross_validation = {{0, 50.0, 49.0, 5.0}, {1, 1.0, 0.0, 0.0}};
  model.block_s = 30.0;
  for (int k = 0; k <= 10; ++k) {
    const double at_k = 290.0 + 2.0 * k;
    const double mean = (3.0 - 2.0 * (at_k - 300.0)) * fake_mg;
    using characterise::Sweep;
    model.points.push_back({Sweep::heating, at_k, mean + 0.15 * fake_mg, 0.8 * fake_mg, 12});
    model.points.push_back({Sweep::cooling, at_k, mean - 0.15 * fake_mg, 0.8 * fake_mg, 9});
  }
  return found;
}

inline DriftOutlook fake_outlook() {
  DriftOutlook outlook;
  outlook.forecast =
      characterise::DriftForecast{10'800.0, fake_interval(6.5 * fake_mg, 0.1 * fake_mg),
                                  fake_interval(0.002 * fake_mg, 0.05 * fake_mg)};
  return outlook;
}

/// Eight runs with a scatter of 2.1 ± 0.5 mg, without a trend or a common warm-up.
inline ChannelRuns fake_runs(const std::string& name) {
  ChannelRuns runs{.name = name, .unit = *parse_unit("m/s^2"), .set = {}, .refused = ""};
  characterise::RunSet& set = runs.set.emplace();
  for (int k = 0; k < 8; ++k) {
    const double level = 2.1 * fake_mg * std::sin(2.0 * k);
    set.runs.push_back({"run " + std::to_string(k + 1),
                        {level - 0.2 * fake_mg, 0.4 * fake_mg},
                        {level, 0.2 * fake_mg},
                        {0.1 * fake_mg, 0.5 * fake_mg}});
  }
  set.window_s = 6.0;
  set.duration_s = 60.0;
  set.turn_on = {0.1 * fake_mg,
                 0.7 * fake_mg,
                 2.14 * fake_mg,
                 0.4 * fake_mg,
                 {2.1 * fake_mg, 0.5 * fake_mg, 1.4 * fake_mg, 4.3 * fake_mg},
                 1e-12};
  set.level = {0.2 * fake_mg,
               0.7 * fake_mg,
               0.2 * fake_mg,
               0.2 * fake_mg,
               {0.0, 0.1 * fake_mg, {}, 0.3 * fake_mg},
               0.5};
  set.trend_per_run = Uncertain{0.01 * fake_mg, 0.2 * fake_mg};
  set.trend_p = 0.96;
  set.warm_up = *fake_steps(name).analysis;
  set.notes = {"run 3 is shorter than the others"};
  return runs;
}

/// x has a warm-up, a temperature curve and a forecast; y has steps; z is refused.
inline DriftReport fake_drift_report() {
  DriftReport report;
  report.inputs = {"rest <1>.csv"};
  report.notes = {{Severity::info, "separator ','"}};
  report.forecast_s = 10'800.0;
  report.channels = {fake_warm_up("acc_x"), fake_steps("acc_y"), fake_refused("acc_z")};
  report.channels[0].temperature = fake_temperature();
  report.channels[0].outlook = fake_outlook();
  report.channels[1].outlook =
      DriftOutlook{.forecast = {}, .refused = "the warm-up is not identified"};
  return report;
}

}  // namespace proofmass::report
