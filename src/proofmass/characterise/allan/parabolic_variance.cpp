#include "proofmass/characterise/allan/parabolic_variance.hpp"

#include <algorithm>
#include <vector>

#include "proofmass/characterise/allan/difference_kernels.hpp"
#include "proofmass/characterise/allan/phase_record.hpp"
#include "proofmass/core/contract.hpp"

namespace proofmass::characterise {
namespace {

/// L[i] = Σ_{k<m} ((m−1)/2 − k) x[i+k], by
///
///     L[i+1] = L[i] + A[i] − (m+1)/2 x[i] − (m−1)/2 x[i+m],   A[i] = Σ_{k<m} x[i+k],
///
/// restarted with a new origin every m positions, so that rounding errors stay those of m
/// operations.
std::vector<double> moments_about_middle(View<double> x, std::size_t m) {
  const double middle = 0.5 * (static_cast<double>(m) - 1.0);
  std::vector<double> L(x.size() - m + 1);
  for (std::size_t begin = 0; begin < L.size(); begin += m) {
    const double origin = x[begin];
    double sum = 0.0;
    double moment = 0.0;
    for (std::size_t k = 0; k < m; ++k) {
      sum += x[begin + k] - origin;
      moment += (middle - static_cast<double>(k)) * (x[begin + k] - origin);
    }
    L[begin] = moment;
    for (std::size_t i = begin + 1; i < std::min(begin + m, L.size()); ++i) {
      const double leaving = x[i - 1] - origin;
      const double entering = x[i - 1 + m] - origin;
      moment += sum - (middle + 1.0) * leaving - middle * entering;
      sum += entering - leaving;
      L[i] = moment;
    }
  }
  return L;
}

}  // namespace

PhaseVariance parabolic_variance(View<double> phase, double tau0_s, std::size_t m) {
  PM_EXPECTS(tau0_s > 0.0 && m > 0 && 2 * m < phase.size());
  const std::vector<double> x = without_mean_rate(phase);
  const std::size_t terms = x.size() - 2 * m;
  const double tau_s = static_cast<double>(m) * tau0_s;
  const double unit = 1.0 / (tau_s * tau_s * static_cast<double>(terms));
  if (m == 1) return {0.5 * unit * squared_second_differences(x.data(), 1, terms), terms};

  const std::vector<double> L = moments_about_middle(x, m);
  double sum = 0.0;
  for (std::size_t i = 0; i < terms; ++i) sum += (L[i] - L[i + m]) * (L[i] - L[i + m]);
  const double length = static_cast<double>(m);
  return {72.0 * unit * sum / (length * length * length * length), terms};
}

}  // namespace proofmass::characterise
