#include "proofmass/signal/events/kernels.hpp"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "proofmass/core/vector_clones.hpp"

namespace proofmass::signal {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

constexpr std::size_t lanes = 8;  // partial sums and maxima of a block

// Four at a time: vectors of eight are slow on processors without registers of that length.
constexpr std::size_t quad = 4;
using Quad [[gnu::vector_size(quad * sizeof(double))]] = double;
using QuadBits [[gnu::vector_size(quad * sizeof(double))]] = std::int64_t;
constexpr std::int64_t all_but_sign = std::numeric_limits<std::int64_t>::max();

}  // namespace

PM_VECTOR_CLONES
void copy_finite(const double* __restrict in, double* __restrict out, std::size_t n) {
  for (std::size_t k = 0; k < n; ++k) out[k] = in[k] - in[k] == 0.0 ? in[k] : nan;
}

PM_VECTOR_CLONES
void average_pairs(const double* __restrict in,
                   double* __restrict out,
                   std::size_t n,
                   std::size_t w) {
  for (std::size_t k = 0; k < n; ++k) out[k] = 0.5 * (in[k] + in[k + w]);
}

PM_VECTOR_CLONES
void tally_outliers(const double* m, std::size_t w, std::size_t blocks, Tally* out) {
  for (std::size_t b = 0; b < blocks; ++b, m += fine_block) {
    double sum[lanes], max[lanes];
    for (std::size_t first = 0; first < lanes; first += quad) {
      Quad sums{}, maxima{};
      for (std::size_t k = first; k < fine_block; k += lanes) {
        const double* at = m + k;
        Quad here, before, after, far_before, far_after, size;
        std::memcpy(&here, at, sizeof(Quad));
        std::memcpy(&before, at - w, sizeof(Quad));
        std::memcpy(&after, at + w, sizeof(Quad));
        std::memcpy(&far_before, at - 2 * w, sizeof(Quad));
        std::memcpy(&far_after, at + 2 * w, sizeof(Quad));
        const Quad output = here - 0.25 * ((far_before + before) + (after + far_after));
        QuadBits bits;
        std::memcpy(&bits, &output, sizeof(Quad));
        bits &= all_but_sign;
        std::memcpy(&size, &bits, sizeof(Quad));
        sums += size;
        maxima = size > maxima ? size : maxima;
      }
      std::memcpy(sum + first, &sums, sizeof(Quad));
      std::memcpy(max + first, &maxima, sizeof(Quad));
    }
    double total = 0.0;
    double largest = 0.0;
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      total += sum[lane];
      largest = max[lane] > largest ? max[lane] : largest;
    }
    out[b] = {total / static_cast<double>(fine_block), largest};
  }
}

PM_VECTOR_CLONES
void tally_outputs(const double* __restrict outputs, std::size_t blocks, Tally* __restrict out) {
  for (std::size_t b = 0; b < blocks; ++b, outputs += coarse_block) {
    double sum = 0.0;
    double max = 0.0;
    for (std::size_t k = 0; k < coarse_block; ++k) {
      const double size = std::abs(outputs[k]);
      sum += size;
      max = size > max ? size : max;
    }
    out[b] = {sum / static_cast<double>(coarse_block), max};
  }
}

PM_VECTOR_CLONES
void sum_blocks(const double* __restrict samples, std::size_t blocks, double* __restrict out) {
  for (std::size_t b = 0; b < blocks; ++b) {
    double sum = 0.0;
    for (std::size_t k = 0; k < base_block; ++k) sum += samples[base_block * b + k];
    out[b] = sum;
  }
}

PM_VECTOR_CLONES
void window_means(const WindowSums& in, double* __restrict out, std::size_t n) {
  const double* __restrict mean = in.mean;
  const float* __restrict share = in.share;
  const double enough = in.enough;
  const auto term = [&](std::size_t k) { return static_cast<double>(share[k]) * mean[k]; };
  const auto weight = [&](std::size_t k) { return static_cast<double>(share[k]); };
  const auto put = [&](std::size_t k, double sum, double total) {
    out[k] = total >= enough ? sum / total : nan;
  };
  if (in.width == 1) {
    for (std::size_t k = 0; k < n; ++k) put(k, 0.0 + term(k), weight(k));
  } else if (in.width == 2) {
    for (std::size_t k = 0; k < n; ++k)
      put(k, 0.0 + term(k) + term(k + 1), weight(k) + weight(k + 1));
  } else {
    for (std::size_t k = 0; k < n; ++k)
      put(k, 0.0 + term(k) + term(k + 1) + term(k + 2) + term(k + 3),
          weight(k) + weight(k + 1) + weight(k + 2) + weight(k + 3));
  }
}

PM_VECTOR_CLONES
double least_difference(View<double> series) {
  double least[lanes];
  for (double& value : least) value = std::numeric_limits<double>::infinity();
  const double* x = series.data();
  std::size_t k = 1;
  for (; k + lanes <= series.size(); k += lanes)
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const double difference = std::abs(x[k + lane] - x[k + lane - 1]);
      least[lane] = difference < least[lane] ? difference : least[lane];
    }
  double result = std::numeric_limits<double>::infinity();
  for (; k < series.size(); ++k) {
    const double difference = std::abs(x[k] - x[k - 1]);
    result = difference < result ? difference : result;
  }
  for (const double value : least) result = value < result ? value : result;
  return result;
}

}  // namespace proofmass::signal
