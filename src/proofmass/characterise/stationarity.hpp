#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "proofmass/core/statistics.hpp"
#include "proofmass/core/view.hpp"
#include "proofmass/signal/spectral_lines.hpp"

namespace proofmass::characterise {

/// Whether the noise of a recording is the same from its beginning to its end.
struct Stationarity {
  bool tested = false;     ///< false: too short for any of the tests
  bool stationary = true;  ///< also where the change is real but below `relevant_change`
  double p = 1.0;          ///< that stationary noise departs as far, over all tests together
  /// The test that departs most: differences of means over averaging_s, or the line at line_hz.
  double averaging_s = 0.0;
  std::optional<double> line_hz;
  /// Level there in equal parts of the recording, over its mean: 1.0, 1.0, 2.1, 2.0.
  std::vector<double> relative_level;
};

/// Changes of the level by less, root mean square, are no reason to call the noise another.
inline constexpr double relevant_change = 0.01;

/// Means over equal spans of a series of unknown length, as it comes: 128 to 256 spans, each twice
/// as long as soon as there are more. NaN is missing.
class EqualSpans {
 public:
  void add(double value);
  /// Neighbours taken together.
  void halve();
  /// Of the spans that are complete; NaN where one has no values.
  [[nodiscard]] std::vector<double> means() const;
  [[nodiscard]] std::size_t length() const { return length_; }
  [[nodiscard]] std::size_t count() const { return sums_.size(); }

 private:
  static constexpr std::size_t most = 256;

  std::vector<double> sums_, counts_;
  std::size_t length_ = 1;
  std::size_t taken_ = 0;  ///< values of the last span; 0: it is complete
};

/// Tests the variance at every octave of averaging times for changes over time, of samples as they
/// come.
///
/// With d_k the differences of neighbouring means over m samples, not overlapping, m = 1, 2, 4 …
/// (Haar wavelet coefficients: independent of one another in white noise and in a random walk,
/// nearly so between) where lines have no part in them, the roots √|d_k| are nearly normal. They
/// are averaged over 128 to 256 equal spans of the recording, fewer where neighbouring spans
/// correlate: a span is as long as eight correlation lengths of the d_k, 2 Σ ρ². An analysis of
/// variance compares 2, 4, 8, 16 and 32 equal parts of the recording. The scatter of the spans
/// within the parts is the yardstick: heavy tails, rounding and correlation are in it. All
/// probabilities are multiplied by the number of tests (Bonferroni); below 0.005 the noise is not
/// stationary.
///
/// Source: D. B. Percival, A. T. Walden, Wavelet Methods for Time Series Analysis (2000), sections
/// 8.6 and 9.6 (wavelet variance, homogeneity of variance); H. Levene, Robust tests for equality of
/// variances, in: Contributions to Probability and Statistics (1960), for the analysis of variance
/// of absolute values.
/// NaN is missing. Cost: O(N). Memory: up to 100 kB an octave.
class StationarityTest {
 public:
  /// One level over the recording, in spans.
  struct Band {
    double averaging_s = 0.0;
    std::optional<double> line_hz;
    std::vector<double> spans;
  };

  void add(View<double> samples);

  [[nodiscard]] std::vector<Band> bands(double rate_hz,
                                        const std::vector<signal::SpectralLine>& lines) const;

  /// The lines themselves are not tested: that takes the whole series.
  [[nodiscard]] Stationarity finish(double rate_hz,
                                    const std::vector<signal::SpectralLine>& lines) const;

 private:
  struct Octave {
    std::optional<double> first_of_pair;
    std::size_t coefficients = 0;
    EqualSpans roots;
    Moments squares;
    std::vector<double> beginning;  ///< of the differences: how they correlate

    [[nodiscard]] std::optional<double> add(double value);
  };

  std::vector<Octave> octaves_;
};

/// The same of a whole series, and of the amplitude of every line: of the roots of the Fourier
/// coefficients of blocks at its frequency.
[[nodiscard]] Stationarity test_stationarity(View<double> series,
                                             double rate_hz,
                                             const std::vector<signal::SpectralLine>& lines);

}  // namespace proofmass::characterise
