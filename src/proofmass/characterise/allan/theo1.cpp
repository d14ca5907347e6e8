#include "proofmass/characterise/allan/theo1.hpp"

#include <array>
#include <numeric>
#include <vector>

#include "proofmass/characterise/allan/phase_record.hpp"
#include "proofmass/core/contract.hpp"
#include "proofmass/core/vector_clones.hpp"

namespace proofmass::characterise {
namespace {

/// Σ (ends − x[l] − y[−l])² w[l] over l = 0 … n − 1, compiled for the vector units of several
/// processors: the hot loop of a curve.
PM_VECTOR_CLONES
double weighted_squares(
    const double* x, const double* y, const double* w, double ends, std::ptrdiff_t n) {
  // Parallel sums, so that additions do not wait for each other.
  constexpr std::ptrdiff_t lanes = 16;
  std::array<double, lanes> sums{};
  std::ptrdiff_t l = 0;
  for (; l + lanes <= n; l += lanes) {
    for (std::ptrdiff_t k = 0; k < lanes; ++k) {
      const double z = (ends - x[l + k]) - y[-l - k];
      sums[static_cast<std::size_t>(k)] += z * z * w[l + k];
    }
  }
  for (; l < n; ++l) {
    const double z = (ends - x[l]) - y[-l];
    sums[0] += z * z * w[l];
  }
  return std::accumulate(sums.begin(), sums.end(), 0.0);
}

}  // namespace

PhaseVariance theo1(View<double> phase, double tau0_s, std::size_t m) {
  PM_EXPECTS(tau0_s > 0.0 && m > 0 && m % 2 == 0 && m < phase.size());
  const std::vector<double> x = without_mean_rate(phase);
  const std::size_t half = m / 2;
  std::vector<double> weights(half);
  for (std::size_t l = 0; l < half; ++l) weights[l] = 1.0 / static_cast<double>(l + 1);

  const std::size_t stride = affordable_stride(x.size(), m);
  std::size_t starts = 0;
  double sum = 0.0;
  for (std::size_t i = 0; i + m < x.size(); i += stride, ++starts)
    sum += weighted_squares(&x[i + 1], &x[i + m - 1], weights.data(), x[i] + x[i + m],
                            static_cast<std::ptrdiff_t>(half));
  const double span_s = static_cast<double>(m) * tau0_s;
  return {sum / (0.75 * span_s * span_s * static_cast<double>(starts)), starts * half};
}

}  // namespace proofmass::characterise
