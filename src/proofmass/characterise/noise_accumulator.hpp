#pragma once

#include <cstddef>

#include "proofmass/characterise/deviation_curve.hpp"
#include "proofmass/characterise/difference_variance.hpp"
#include "proofmass/characterise/low_band.hpp"
#include "proofmass/characterise/noise_analysis.hpp"
#include "proofmass/signal/spectrum.hpp"

namespace proofmass::characterise {

/// Terms to a τ that decimation leaves in long recordings.
inline constexpr std::size_t least_decimated_overlap = 16;

/// A noise analysis of samples as they come, for recordings longer than memory: deviation,
/// spectrum, lines and coefficients in one pass. analyse_noise is a fold over it, with the events
/// found before. Of the statistics those that are differences of the phase (adev … ohdev); the
/// others need the whole record at once, and so do noise types by lag 1. Memory: ten bytes for
/// every 128 samples and, of overlapping statistics, some hundred kilobytes; without overlap (adev,
/// hdev) up to two or three times the longest τ.
class NoiseAccumulator {
 public:
  /// expected_samples sets the length of the spectrum's segments and how densely terms start; 0 if
  /// not known, which is as for a long record. Options as of analyse_noise, of which kind,
  /// exclude_events, lsb and progress are not read.
  /// noise_type lag1 is taken as model.
  explicit NoiseAccumulator(const NoiseOptions& options, std::size_t expected_samples = 0);

  /// NaN is missing.
  void add(View<double> samples);

  /// The rate as it is known at the end, within a few per cent of that in the options: it scales
  /// frequencies, densities and times.
  void set_rate(double rate_hz);

  /// Spectrum, lines, model and deviation; samples, duration and rate. May be asked at any time.
  [[nodiscard]] NoiseAnalysis finish() const;

  /// The same without a deviation.
  [[nodiscard]] NoiseAnalysis finish_spectrum() const;

  /// What the deviation is made of; nothing, of a statistic that is no difference.
  [[nodiscard]] CurveVariances variances() const;

 private:
  NoiseOptions options_;
  std::size_t samples_ = 0;
  std::size_t least_overlap_;
  std::vector<std::size_t> factors_;
  DifferenceVariances differences_;
  signal::SpectrumAccumulator spectrum_;
  BlockMeans slow_;
};

}  // namespace proofmass::characterise
