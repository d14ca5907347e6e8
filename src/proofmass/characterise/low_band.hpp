#pragma once

#include <complex>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "proofmass/core/view.hpp"

namespace proofmass::characterise {

/// A deterministic slow change a cos(2π f t) + b sin(2π f t), t from the first sample on.
struct SlowWave {
  double frequency_hz = 0.0, cosine = 0.0, sine = 0.0;
  [[nodiscard]] double at(double time_s) const;
};

/// The vector that a coefficient of the cosine transform belongs to: number k of a stretch of n
/// blocks.
struct CosineVector {
  std::size_t k = 0, n = 0;  ///< k = 0: none
  double start_s = 0.0, step_s = 0.0;

  /// The coefficients of cos(2π f t), as real part, and of sin(2π f t), as imaginary part; f far
  /// below 1/step_s.
  [[nodiscard]] std::complex<double> of_wave(double frequency_hz) const;
};

/// One coefficient of a cosine transform: a normal variable whose variance is the density there.
struct CosineOrdinate {
  double frequency_hz = 0.0;
  double amplitude = 0.0;  ///< its square is a two-sided density, unit²/Hz
  double of_ramp = 0.0;    ///< amplitude that a ramp of 1 unit/s has
  CosineVector vector = {};
};

/// The slow part of a series as means over blocks, gathered in one pass: blocks of one sample while
/// the series is short, of up to 128 samples once it is long.
class BlockMeans {
 public:
  explicit BlockMeans(double rate_hz) : rate_hz_(rate_hz) {}

  /// NaN is missing.
  void add(View<double> samples);

  /// The rate as it is known at the end.
  void set_rate(double rate_hz) { rate_hz_ = rate_hz; }

  [[nodiscard]] std::size_t block() const { return block_; }

  /// Mean of each complete block, NaN where more than half of it is missing.
  [[nodiscard]] std::vector<double> means() const;

  /// The cosine transforms of the stretches between long gaps, frequency above zero, ascending
  /// within each stretch, up to half the rate or, of blocks longer than a sample, to a quarter of
  /// the blocks' rate, where their aliases end. A short gap is filled with the mean of its
  /// neighbours and the densities made up for it.
  ///
  /// The transform of type II turns a random walk about any level exactly, and white noise, into
  /// independent coefficients (its vectors are those of the second difference with free ends), and
  /// nearly so any stationary noise: no window and no leakage, down to the lowest frequency
  /// that the stretch holds.
  /// Source: G. Strang, The discrete cosine transform, SIAM Review 41 (1999) 135; N. Ahmed,
  /// T. Natarajan, K. R. Rao, IEEE Trans. Computers C-23 (1974) 90, on the Markov-1 process.
  /// `wave` is taken out before. Cost: O(N log N) in the blocks.
  [[nodiscard]] std::vector<CosineOrdinate> ordinates(const SlowWave& wave = {}) const;

  static constexpr std::size_t longest_block = 128;

 private:
  void close_block();
  void halve();

  double rate_hz_;
  std::size_t block_ = 1;
  std::vector<double> sums_;
  std::vector<std::uint16_t> counts_;  ///< of valid samples, each block
  double sum_ = 0.0;                   ///< of the block under way
  std::size_t valid_ = 0, taken_ = 0;
};

}  // namespace proofmass::characterise
