#pragma once

#include <cstddef>
#include <vector>

// The Fourier transform that takes most of the time of Welch's method: eight transforms of one
// length in parallel, one in each lane of a vector register. A library transforms one series at a
// time and leaves most of the register idle: Welch's method over 7.2 million samples in segments of
// 4096 took 136 ms with Eigen's kissfft; it takes 27 ms with this by AVX-512, 60 ms by AVX2. No
// fused multiply-add: every processor gives the same digits.
namespace proofmass::signal {

inline constexpr std::size_t lanes = 8;

using Lanes [[gnu::vector_size(lanes * sizeof(double))]] = double;

// The alignment is explicit because that of a vector type differs between processors, and the
// passes are compiled for several.

/// One element of eight real series.
struct alignas(sizeof(Lanes)) LaneReal {
  Lanes value;
};

/// One element of eight complex series, or of sixteen real ones packed in pairs.
struct alignas(sizeof(Lanes)) LaneComplex {
  Lanes re, im;
};

/// Power of the discrete Fourier transform of sixteen real series of one length, a power of two.
/// Source: J. W. Cooley, J. W. Tukey, Math. Comp. 19 (1965) 297, decimation in frequency by fours.
class LaneFourier {
 public:
  explicit LaneFourier(std::size_t length);

  /// sums += |X|² for every frequency in the transform's own order and every lane; x is
  /// overwritten. Cost: 8 · 4.25 · length · log₂ length operations.
  void add_power(std::vector<LaneComplex>& x, std::vector<LaneReal>& sums) const;

  /// Σ |X[k]|² over the series, k = 0 … length/2. For two real series a and b in one complex series
  /// Z it is |A[k]|² + |B[k]|² = (|Z[k]|² + |Z[length − k]|²) / 2.
  [[nodiscard]] std::vector<double> real_power(const std::vector<LaneReal>& sums) const;

 private:
  std::size_t length_;
  /// For each pass exp(−2πi m j / n), m = 1, 2, 3, for j = 0 … n/4 − 1: real, imaginary.
  std::vector<std::vector<double>> twiddles_;
};

/// Up to sixteen overlapping segments of a series, half a segment apart.
struct SegmentBatch {
  const double* samples;
  std::size_t half;         ///< samples from one segment to the next; a multiple of 8
  const double* window;     ///< 2 · half weights
  double mean[2 * lanes];   ///< subtracted from each segment
  double scale[2 * lanes];  ///< multiplies each segment
  std::size_t segments;     ///< number of segments; the remaining slots are zero
};

/// x = scale · window · (sample − mean), missing samples as zero.
void load_segments(const SegmentBatch& batch, std::vector<LaneComplex>& x);

struct ValidSum {
  double sum = 0.0, count = 0.0;
};

/// Sum and number of the finite values; n is a multiple of 8.
[[nodiscard]] ValidSum valid_sum(const double* values, std::size_t n);

}  // namespace proofmass::signal
