#pragma once

#include <cstddef>

#include "proofmass/characterise/allan/deviation_curve.hpp"
#include "proofmass/characterise/allan/difference_variance.hpp"
#include "proofmass/characterise/noise/cosine_ordinates.hpp"
#include "proofmass/characterise/noise_analysis.hpp"
#include "proofmass/signal/spectrum.hpp"

namespace proofmass::characterise {

/// Terms per τ after decimation of long recordings.
inline constexpr std::size_t least_decimated_overlap = 16;

/// Online noise analysis for recordings longer than memory: deviation, spectrum, lines and
/// coefficients in one pass. analyse_noise is a fold over it, after event detection.
///
/// - Statistics: only differences of the phase (adev … ohdev); the others need the whole record at
///   once, as do noise types by lag 1.
/// - Memory: ten bytes for every 128 samples and, for overlapping statistics, some hundred
///   kilobytes; without overlap (adev, hdev) up to two or three times the longest τ.
class NoiseAccumulator {
 public:
  /// expected_samples sets the length of the spectrum's segments and the spacing of terms; 0 if
  /// unknown, treated as a long record. Options as in analyse_noise; kind, exclude_events, lsb and
  /// progress are not used. noise_type lag1 is treated as model.
  explicit NoiseAccumulator(const NoiseOptions& options, std::size_t expected_samples = 0);

  /// NaN is missing.
  void add(View<double> samples);

  /// Sets the final rate, within a few per cent of that in the options: it scales frequencies,
  /// densities and times.
  void set_rate(double rate_hz);

  /// Spectrum, lines, model and deviation; samples, duration and rate. May be called at any time.
  [[nodiscard]] NoiseAnalysis finish() const;

  /// As finish(), without a deviation.
  [[nodiscard]] NoiseAnalysis finish_spectrum() const;

  /// Data of the deviation; empty for a statistic that is not a difference.
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
