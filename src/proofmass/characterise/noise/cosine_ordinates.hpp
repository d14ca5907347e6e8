#pragma once

#include <complex>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "proofmass/core/state_bytes.hpp"
#include "proofmass/core/view.hpp"

namespace proofmass::characterise {

/// A deterministic slow change a cos(2π f t) + b sin(2π f t), t from the first sample on.
struct SlowWave {
  double frequency_hz = 0.0, cosine = 0.0, sine = 0.0;
  [[nodiscard]] double at(double time_s) const;
};

/// Basis vector of a cosine-transform coefficient: index k in a stretch of n blocks.
struct CosineVector {
  std::size_t k = 0, n = 0;  ///< k = 0: none
  double start_s = 0.0, step_s = 0.0;

  /// Its products with cos(2π f t), real part, and sin(2π f t), imaginary part; f far below
  /// 1/step_s.
  [[nodiscard]] std::complex<double> of_wave(double frequency_hz) const;
};

/// One coefficient of a cosine transform: a normal variable whose variance is the density there.
struct CosineOrdinate {
  double frequency_hz = 0.0;
  double amplitude = 0.0;  ///< its square is a two-sided density, unit²/Hz
  double of_ramp = 0.0;    ///< amplitude of a ramp of 1 unit/s
  CosineVector vector = {};
};

/// The slow part of a series as block means, accumulated in one pass: blocks of one sample for a
/// short series, of up to 128 samples for a long one.
class BlockMeans {
 public:
  explicit BlockMeans(double rate_hz) : rate_hz_(rate_hz) {}

  /// A part of a series of `total` samples, with `first` before it: its blocks are those of the
  /// whole, and those at its ends are continued by append().
  BlockMeans(double rate_hz, std::size_t first, std::size_t total);

  /// NaN is missing.
  void add(View<double> samples);

  /// Adds the part that follows.
  void append(const BlockMeans& part);

  /// Fails where the state read is not that of such a part with `samples` samples.
  void exchange(StateBytes& bytes, std::size_t samples);

  /// Sets the final rate.
  void set_rate(double rate_hz) { rate_hz_ = rate_hz; }

  [[nodiscard]] std::size_t block() const { return block_; }

  /// Mean of each complete block, NaN if more than half of it is missing.
  [[nodiscard]] std::vector<double> means() const;

  /// Cosine transforms of the stretches between long gaps, frequency above zero, ascending within
  /// each stretch. The upper limit is half the rate or, for blocks longer than a sample, a quarter
  /// of the blocks' rate, where aliasing becomes significant. A short gap is filled with the mean
  /// of as many neighbours on each side, and the densities are corrected for it.
  ///
  /// The type II transform diagonalises a random walk about any level, and white noise, exactly
  /// (its vectors are those of the second difference with free ends), and any stationary noise
  /// approximately: no window and no leakage, down to the lowest frequency in the stretch. Source:
  /// G. Strang, The discrete cosine transform, SIAM Review 41 (1999) 135; N. Ahmed, T. Natarajan,
  /// K. R. Rao, IEEE Trans. Computers C-23 (1974) 90, on the Markov-1 process. `wave` is subtracted
  /// first. Cost: O(N log N) in the blocks.
  [[nodiscard]] std::vector<CosineOrdinate> ordinates(const SlowWave& wave = {}) const;

  static constexpr std::size_t longest_block = 128;

 private:
  void close_block();
  void halve();

  double rate_hz_;
  std::size_t block_ = 1;
  std::vector<double> sums_;
  std::vector<std::uint16_t> counts_;  ///< valid samples in each block
  double sum_ = 0.0;                   ///< of the current block
  std::size_t valid_ = 0, taken_ = 0;
  std::size_t before_ = 0;  ///< samples of the first block that are before this part
  bool is_part_ = false;    ///< the length of the blocks is final
};

}  // namespace proofmass::characterise
