#pragma once

#include <cstddef>

#include "proofmass/characterise/allan/deviation_curve.hpp"
#include "proofmass/characterise/allan/difference_variance.hpp"
#include "proofmass/characterise/noise/cosine_ordinates.hpp"
#include "proofmass/characterise/noise_analysis.hpp"
#include "proofmass/signal/spectrum.hpp"

namespace proofmass::characterise {

/// Number of samples up to which every term of a deviation is used; beyond, sixteen or more per τ.
inline constexpr std::size_t decimate_above = std::size_t{1} << 20;

/// Terms per τ after decimation of long recordings.
inline constexpr std::size_t least_decimated_overlap = 16;

/// Where a part of a series lies in the whole.
struct PartPlace {
  std::size_t first = 0;   ///< samples before it
  std::size_t origin = 0;  ///< samples before the first valid one of the whole
  std::size_t total =
      0;  ///< samples of the whole, of which only the number of binary digits counts
};

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

  /// A part of a longer series, which append() joins to others. The overlap is that of a long
  /// record, and its segments have the length that the options state.
  NoiseAccumulator(const NoiseOptions& options, const PartPlace& place);

  /// NaN is missing.
  void add(View<double> samples);

  /// Adds the part that follows.
  void append(NoiseAccumulator part);

  /// Fails where the state read is not that of such a part.
  void exchange(StateBytes& bytes);

  [[nodiscard]] std::size_t samples() const { return samples_; }

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
