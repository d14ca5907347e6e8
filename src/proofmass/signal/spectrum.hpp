#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/core/state_bytes.hpp"
#include "proofmass/core/view.hpp"

namespace proofmass::signal {

struct SpectrumOptions {
  double rate_hz;              ///< sampling rate, positive
  std::size_t segment = 4096;  ///< samples per segment: a power of two, at least 16
};

/// A power spectrum averaged over segments. It integrates to the variance: a sine of amplitude A
/// contributes Σ one_sided_psd · rate_hz / segment = A²/2.
struct Spectrum {
  double rate_hz = 0.0;
  std::size_t segment = 0;            ///< samples per segment: fewer for a short series
  std::size_t averaged = 0;           ///< number of segments averaged
  double window_bandwidth_hz = 0.0;   ///< equivalent noise bandwidth of the window
  std::vector<double> frequency_hz;   ///< 0 … rate/2, segment/2 + 1 bins
  std::vector<double> one_sided_psd;  ///< unit²/Hz; the bins at 0 and rate/2 are not doubled
  double edf_per_bin = 0.0;  ///< equivalent degrees of freedom of a bin; half at 0 and rate/2
};

/// Power spectrum of a uniformly sampled series that arrives in blocks, by Welch's method: Hann
/// window w, segments of L samples that overlap by half, the mean of each removed,
///
///     S[k] = 2/(rate K) Σ |Σ w[n] (x[n] − mean) exp(−2πi k n / L)|² / Σ w[n]²
///
/// over K segments. Samples that are not finite are missing: they count as zero, and the sums for
/// the mean and for w² are over the others, which preserves the level of white noise. A segment
/// whose valid samples hold less than half of Σ w² is skipped. The degrees of freedom of a bin are
/// 2K / (1 + 2 (K − 1) ρ / K), ρ = (Σ w[n] w[n + L/2] / Σ w²)² = 1/36: 1.89 per segment.
///
/// Source: P. D. Welch, IEEE Trans. AU 15 (1967) 70; D. B. Percival, A. T. Walden, Spectral
/// Analysis for Physical Applications (1993), section 6.17.
///
/// A part of a longer series can be accumulated by itself: its segments are those of the whole, and
/// the samples at its ends are kept for the segments that reach beyond it.
///
/// The result does not depend on how the series is divided into calls of add(), to the last digit.
/// Cost: O(N log L), about 3 ns per sample; holds 35 L doubles.
class SpectrumAccumulator {
 public:
  /// first: number of samples of the whole series before this part.
  explicit SpectrumAccumulator(SpectrumOptions options, std::size_t first = 0);
  SpectrumAccumulator(SpectrumAccumulator&&) noexcept;
  SpectrumAccumulator& operator=(SpectrumAccumulator&&) noexcept;
  ~SpectrumAccumulator();

  void add(View<double> samples);

  /// Adds the part that follows: made with the same options, its `first` where this one ends.
  void append(const SpectrumAccumulator& part);

  /// Fails where the state read is not that of `samples` samples with these options and `first`.
  void exchange(StateBytes& bytes, std::size_t samples);

  /// The spectrum of the samples added. If they are fewer than one segment, the segment is the
  /// largest power of two that fits; if there is no valid segment, averaged is 0 and there are no
  /// bins.
  [[nodiscard]] Spectrum finish() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The spectrum of a whole series; see SpectrumAccumulator.
/// Errors: invalid_argument (options), too_few_samples (fewer than 16, or no segment that is half
/// valid).
[[nodiscard]] Result<Spectrum> welch(View<double> series, const SpectrumOptions& options);

}  // namespace proofmass::signal
