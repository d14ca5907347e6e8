#pragma once

#include <cmath>
#include <string>

#include "proofmass/core/units.hpp"
#include "proofmass/report/noise/report.hpp"

// A synthetic analysis with known figures, for the tests of this module.
namespace proofmass::report {

inline characterise::Coefficient identified(double value, double std) {
  return {.value = value,
          .std = std,
          .lower_95 = value - 1.96 * std,
          .upper_two_sided_95 = value + 1.96 * std,
          .upper_95 = value + 1.645 * std,
          .verdict = characterise::Verdict::identified,
          .record_needed_s = 600.0};
}

inline characterise::Coefficient bounded(double upper, std::optional<double> needed_s) {
  return {.value = 0.0,
          .std = upper / 1.645,
          .lower_95 = 0.0,
          .upper_two_sided_95 = 1.2 * upper,
          .upper_95 = upper,
          .verdict = characterise::Verdict::not_observable,
          .record_needed_s = needed_s};
}

/// A curve that follows the model and a line at 0.562 Hz; 100 Hz for 10 000 s.
inline void fake_curve(characterise::NoiseAnalysis& analysis) {
  const signal::SpectralLine& line = analysis.lines.lines.front();
  for (std::size_t m = 1; m < 250'000; m = m * 5 / 4 + 1) {
    const double tau_s = static_cast<double>(m) / analysis.rate_hz;
    const double value =
        std::sqrt(analysis.model.allan_variance(tau_s) +
                  characterise::sine_allan_variance(line.amplitude, line.frequency_hz, tau_s));
    const double edf = 1.2 * analysis.duration_s / tau_s + 1.0;
    const double spread = std::sqrt(0.5 / edf);
    analysis.deviation.points.push_back({.m = m,
                                         .tau_s = tau_s,
                                         .terms = analysis.samples - 2 * m + 1,
                                         .value = value,
                                         .uncorrected = value,
                                         .lower = value / (1.0 + spread),
                                         .upper = value * (1.0 + 1.3 * spread),
                                         .edf = edf,
                                         .alpha = tau_s < 10.0 ? 0 : -1,
                                         .alpha_lag1 = std::nullopt});
  }
}

inline void fake_spectrum(characterise::NoiseAnalysis& analysis) {
  signal::Spectrum& spectrum = analysis.spectrum;
  spectrum.rate_hz = 100.0;
  spectrum.segment = 4096;
  spectrum.averaged = 487;
  spectrum.window_bandwidth_hz = 0.0366;
  spectrum.edf_per_bin = 920.0;
  const signal::SpectralLine& line = analysis.lines.lines.front();
  for (std::size_t k = 0; k <= 2048; ++k) {
    const double f = static_cast<double>(k) * 100.0 / 4096.0;
    const double away = (f - line.frequency_hz) / 0.03;
    const double ripple = 1.0 + 0.05 * std::sin(2.3 * static_cast<double>(k));
    spectrum.frequency_hz.push_back(f);
    spectrum.one_sided_psd.push_back(2.0 * analysis.model.density(std::max(f, 0.01)) * ripple +
                                     line.amplitude * line.amplitude / 0.2 *
                                         std::exp(-away * away));
    analysis.lines.in_line.push_back(std::abs(away) < 3.0);
  }
  analysis.lines.background = spectrum.one_sided_psd;
}

/// White noise of 75.2 ± 0.3 µg/√Hz, flicker of 21 ± 2 µg, no random walk above 1.2 µg/√s, and a
/// line.
inline ChannelNoise fake_channel(const std::string& name) {
  constexpr double ug = 1e-6 * standard_gravity_mps2;
  ChannelNoise channel;
  channel.name = name;
  channel.unit = *parse_unit("m/s^2");
  characterise::NoiseAnalysis& analysis = channel.analysis.emplace();
  analysis.rate_hz = 100.0;
  analysis.samples = 1'000'000;
  analysis.missing = 120;
  analysis.duration_s = 10'000.0;
  analysis.mean = 9.81;
  characterise::NoiseModelFit& model = analysis.model;
  model.rate_hz = analysis.rate_hz;
  model.duration_s = analysis.duration_s;
  model.white = identified(75.2 * ug, 0.3 * ug);
  model.flicker = identified(21.0 * ug, 2.0 * ug);
  model.random_walk = bounded(1.2 * ug, 10'800.0);
  model.quantisation = bounded(1e-6, std::nullopt);
  model.ramp = bounded(0.01 * ug, 7200.0);
  model.ordinates = 2000;
  analysis.lines.lines = {{.frequency_hz = 0.562,
                           .low_hz = 0.48,
                           .high_hz = 0.64,
                           .amplitude = 60.0 * ug,
                           .amplitude_std = 1.5 * ug,
                           .excess_db = 9.4}};
  analysis.lines.floor = {106.4 * ug, 0.5 * ug, 20.0, 40.0};
  analysis.events = {{signal::EventKind::outlier, 120'000, 120'030, 0.02, 31.0},
                     {signal::EventKind::step, 700'000, 700'000, -0.001, 12.0}};
  analysis.notes = {{Severity::warning, "an outlier at 1200 s"}};
  fake_curve(analysis);
  fake_spectrum(analysis);
  return channel;
}

inline ChannelNoise refused_channel(const std::string& name) {
  ChannelNoise channel;
  channel.name = name;
  channel.unit = *parse_unit("m/s^2");
  channel.refused = "the values do not vary";
  return channel;
}

inline NoiseReport fake_noise_report() {
  NoiseReport report;
  report.inputs = {"rest <1>.csv"};
  report.notes = {{Severity::info, "separator ','"}};
  report.channels = {fake_channel("acc_x")};
  return report;
}

}  // namespace proofmass::report
