#include "proofmass/signal/spectrum/lane_fourier.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

#include "proofmass/core/vector_clones.hpp"

namespace proofmass::signal {
namespace {

/// One pass over a block of 4q elements, into four blocks of q: the frequencies 0, 1, 2, 3 modulo
/// 4.
PM_VECTOR_CLONES void pass_by_four(LaneComplex* x, const double* w, std::size_t q) {
  for (std::size_t j = 0; j < q; ++j, ++x, w += 6) {
    const LaneComplex a = x[0], b = x[q], c = x[2 * q], d = x[3 * q];
    const Lanes even_re = a.re + c.re, even_im = a.im + c.im;
    const Lanes odd_re = b.re + d.re, odd_im = b.im + d.im;
    const Lanes p_re = a.re - c.re, p_im = a.im - c.im;
    const Lanes m_re = b.im - d.im, m_im = d.re - b.re;
    const Lanes y1_re = p_re + m_re, y1_im = p_im + m_im;
    const Lanes y2_re = even_re - odd_re, y2_im = even_im - odd_im;
    const Lanes y3_re = p_re - m_re, y3_im = p_im - m_im;
    x[0].re = even_re + odd_re;
    x[0].im = even_im + odd_im;
    x[q].re = y1_re * w[0] - y1_im * w[1];
    x[q].im = y1_re * w[1] + y1_im * w[0];
    x[2 * q].re = y2_re * w[2] - y2_im * w[3];
    x[2 * q].im = y2_re * w[3] + y2_im * w[2];
    x[3 * q].re = y3_re * w[4] - y3_im * w[5];
    x[3 * q].im = y3_re * w[5] + y3_im * w[4];
  }
}

void pass_by_two(LaneComplex* x) {
  const LaneComplex a = x[0], b = x[1];
  x[0] = {a.re + b.re, a.im + b.im};
  x[1] = {a.re - b.re, a.im - b.im};
}

PM_VECTOR_CLONES void add_squares(const LaneComplex* x, LaneReal* sums, std::size_t n) {
  for (std::size_t j = 0; j < n; ++j) sums[j].value += x[j].re * x[j].re + x[j].im * x[j].im;
}

/// Depth first, so that the small blocks are processed while in the nearest cache.
void transform(LaneComplex* x, std::size_t n, const std::vector<double>* twiddles) {
  if (n == 1) return;
  if (n == 2) return pass_by_two(x);
  pass_by_four(x, twiddles->data(), n / 4);
  for (std::size_t block = 0; block < 4; ++block) transform(x + block * n / 4, n / 4, twiddles + 1);
}

/// Index of frequency k in the output of transform().
std::size_t place(std::size_t k, std::size_t n) {
  return n <= 2 ? k : (k % 4) * (n / 4) + place(k / 4, n / 4);
}

}  // namespace

LaneFourier::LaneFourier(std::size_t length) : length_(length) {
  for (std::size_t n = length; n >= 4; n /= 4) {
    std::vector<double>& pass = twiddles_.emplace_back();
    for (std::size_t j = 0; j < n / 4; ++j)
      for (std::size_t m = 1; m <= 3; ++m) {
        const double angle =
            -2.0 * std::numbers::pi * static_cast<double>(m * j) / static_cast<double>(n);
        pass.push_back(std::cos(angle));
        pass.push_back(std::sin(angle));
      }
  }
}

void LaneFourier::add_power(std::vector<LaneComplex>& x, std::vector<LaneReal>& sums) const {
  transform(x.data(), length_, twiddles_.data());
  add_squares(x.data(), sums.data(), length_);
}

std::vector<double> LaneFourier::real_power(const std::vector<LaneReal>& sums) const {
  const auto at = [&](std::size_t k) {
    const Lanes& lane = sums[place(k, length_)].value;
    double sum = 0.0;
    for (std::size_t l = 0; l < lanes; ++l) sum += lane[l];
    return sum;
  };
  std::vector<double> power(length_ / 2 + 1);
  for (std::size_t k = 0; k < power.size(); ++k)
    power[k] = 0.5 * (at(k) + at((length_ - k) % length_));
  return power;
}

PM_VECTOR_CLONES void load_segments(const SegmentBatch& batch, std::vector<LaneComplex>& x) {
  double* const out = reinterpret_cast<double*>(x.data());
  constexpr std::size_t row = 2 * lanes;
  if (batch.segments < row) std::memset(out, 0, x.size() * sizeof(LaneComplex));
  // In blocks of one cache line of each segment: sixteen whole segments in parallel would evict one
  // another.
  for (std::size_t block = 0; block < 2 * batch.half; block += lanes)
    for (std::size_t s = 0; s < batch.segments; ++s) {
      const double* const samples = batch.samples + s * batch.half + block;
      const double* const window = batch.window + block;
      const double mean = batch.mean[s], scale = batch.scale[s];
      double* const column = out + block * row + s;
      for (std::size_t i = 0; i < lanes; ++i) {
        const double x_i = (samples[i] - mean) * (window[i] * scale);
        column[i * row] = samples[i] - samples[i] == 0.0 ? x_i : 0.0;
      }
    }
}

PM_VECTOR_CLONES ValidSum valid_sum(const double* values, std::size_t n) {
  Lanes sums{}, counts{};
  for (std::size_t i = 0; i < n; i += lanes) {
    Lanes x;
    std::memcpy(&x, values + i, sizeof(x));
    const auto valid = x * 0.0 == 0.0;  // NaN and ±∞ give NaN
    sums += valid ? x : Lanes{};
    counts += valid ? Lanes{} + 1.0 : Lanes{};
  }
  ValidSum total;
  for (std::size_t l = 0; l < lanes; ++l) {
    total.sum += sums[l];
    total.count += counts[l];
  }
  return total;
}

}  // namespace proofmass::signal
