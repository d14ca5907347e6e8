#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "proofmass/core/state_bytes.hpp"
#include "proofmass/core/statistics.hpp"
#include "proofmass/core/view.hpp"
#include "proofmass/signal/spectral_lines.hpp"

namespace proofmass::characterise {

/// Whether the noise of a recording is constant from beginning to end.
struct Stationarity {
  bool tested = false;     ///< false: too short for any test
  bool stationary = true;  ///< also true if the change is significant but below `relevant_change`
  double p = 1.0;          ///< p-value over all tests together
  /// The most significant test: differences of means over averaging_s, or the line at line_hz.
  double averaging_s = 0.0;
  std::optional<double> line_hz;
  /// Its level in equal parts of the recording, over the mean: 1.0, 1.0, 2.1, 2.0.
  std::vector<double> relative_level;
};

/// Smaller rms changes of the level are not considered relevant.
inline constexpr double relevant_change = 0.01;

/// Means over equal spans of a series of unknown length, online: 128 to 256 spans, whose length
/// doubles when there are more. NaN is missing.
class EqualSpans {
 public:
  EqualSpans() = default;
  /// A part of a series, with `first` values before it, in spans of fixed length: those of the
  /// whole, the first and the last of which append() completes.
  EqualSpans(std::size_t first, std::size_t length);

  void add(double value) { add(View<double>(&value, 1)); }
  void add(View<double> values);
  /// Adds the part that follows.
  void append(const EqualSpans& part);
  /// The spans of a whole series, which were of fixed length, as if they had grown with it.
  void grow();
  /// Fails if the state read does not describe `values` values after `first` others.
  void exchange(StateBytes& bytes, std::size_t first, std::size_t values);
  /// Merges neighbouring spans.
  void halve();
  /// Means of the complete spans; NaN for one without values.
  [[nodiscard]] std::vector<double> means() const;
  [[nodiscard]] std::size_t length() const { return length_; }
  [[nodiscard]] std::size_t count() const { return sums_.size(); }

 private:
  static constexpr std::size_t most = 256;

  std::vector<double> sums_, counts_;
  std::size_t length_ = 1;
  std::size_t taken_ = 0;  ///< values in the last span; 0: it is complete
  bool is_fixed_ = false;
};

/// Online test of the variance for changes over time, at every octave of averaging times.
///
/// - d_k are the differences of neighbouring non-overlapping means over m samples, m = 1, 2, 4 …
///   (Haar wavelet coefficients: independent in white noise and in a random walk, nearly so in
///   between). Where lines do not contribute, the roots √|d_k| are nearly normal.
/// - They are averaged over 128 to 256 equal spans of the recording, fewer if neighbouring spans
///   correlate: a span is as long as eight correlation lengths of the d_k, 2 Σ ρ².
/// - An analysis of variance compares 2, 4, 8, 16 and 32 equal parts of the recording. Its
///   reference is the scatter of the spans within the parts, which includes heavy tails, rounding
///   and correlation.
/// - All probabilities are multiplied by the number of tests (Bonferroni); below 0.005 the noise is
///   not stationary.
///
/// Source: D. B. Percival, A. T. Walden, Wavelet Methods for Time Series Analysis (2000), sections
/// 8.6 and 9.6 (wavelet variance, homogeneity of variance); H. Levene, Robust tests for equality of
/// variances, in: Contributions to Probability and Statistics (1960), for the analysis of variance
/// of absolute values. NaN is missing. Cost: O(N). Memory: up to 100 kB an octave.
class StationarityTest {
 public:
  /// One level over the recording, in spans.
  struct Band {
    double averaging_s = 0.0;
    std::optional<double> line_hz;
    std::vector<double> spans;
  };

  StationarityTest() = default;
  /// A part of a series of `total` samples, with `first` before it.
  StationarityTest(std::size_t first, std::size_t total);

  void add(View<double> samples);

  /// Adds the part that follows.
  void append(const StationarityTest& part);

  /// Fails where the state read is not that of such a part.
  void exchange(StateBytes& bytes);

  [[nodiscard]] std::size_t samples() const { return samples_; }

  [[nodiscard]] std::vector<Band> bands(double rate_hz,
                                        const std::vector<signal::SpectralLine>& lines) const;

  /// The lines themselves are not tested: that needs the whole series.
  [[nodiscard]] Stationarity finish(double rate_hz,
                                    const std::vector<signal::SpectralLine>& lines) const;

 private:
  struct Octave {
    std::optional<double> first_of_pair;
    std::size_t coefficients = 0;
    EqualSpans roots;
    double squares = 0.0;           ///< Σ d², where finite
    std::size_t finite = 0;         ///< number of these
    std::vector<double> beginning;  ///< of the differences, for their correlation

    bool wants_head = false;  ///< the partner of the first mean is before this part
    std::optional<double> head;
    std::size_t room = 0;  ///< of `beginning`

    /// `means`: those of the pairs that these values complete. `buffer` is overwritten.
    void add(View<double> values, std::vector<double>& means, std::vector<double>& buffer);
    void append(const Octave& part);
    /// means: of the octave in this part.
    void exchange(StateBytes& bytes, std::size_t first_pair, std::size_t means);
  };

  [[nodiscard]] Octave new_octave() const;

  std::vector<Octave> octaves_;
  std::size_t samples_ = 0;
  std::size_t first_ = 0, total_ = 0;  ///< total_ = 0: not a part
};

/// The test of a whole series, plus the amplitude of every line: of the roots of the Fourier
/// coefficients of blocks at its frequency.
[[nodiscard]] Stationarity test_stationarity(const StationarityTest& differences,
                                             View<double> series,
                                             double rate_hz,
                                             const std::vector<signal::SpectralLine>& lines);

}  // namespace proofmass::characterise
