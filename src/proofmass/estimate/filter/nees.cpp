#include "proofmass/estimate/filter/nees.hpp"

#include <cmath>

#include "proofmass/core/contract.hpp"
#include "proofmass/core/linalg.hpp"

namespace proofmass::estimate {

double normalised_error_squared(const Eigen::VectorXd& error, const Eigen::MatrixXd& cov) {
  PM_EXPECTS(cov.rows() == error.size() && cov.cols() == error.size());
  return error.dot(positive_inverse(cov) * error);
}

Bounds mean_nees_95(std::size_t runs, std::size_t states) {
  PM_EXPECTS(runs > 0 && states > 0);
  const auto n = static_cast<double>(states);
  const Bounds each = mean_chi_square_95(runs * states);
  return {n * each.lower, n * each.upper};
}

Bounds share_inside_95(std::size_t runs, double p) {
  PM_EXPECTS(runs > 0 && p > 0.0 && p < 1.0);
  const auto n = static_cast<double>(runs);
  Bounds bounds{0.0, 1.0};
  double below = 0.0;  // P(fewer than k)
  for (std::size_t k = 0; k <= runs; ++k) {
    const auto i = static_cast<double>(k);
    const double chance =
        std::exp(std::lgamma(n + 1.0) - std::lgamma(i + 1.0) - std::lgamma(n - i + 1.0) +
                 i * std::log(p) + (n - i) * std::log1p(-p));
    if (below <= 0.025) bounds.lower = i / n;
    below += chance;
    if (below >= 0.975) {
      bounds.upper = i / n;
      break;
    }
  }
  return bounds;
}

void NeesTally::add(const Eigen::VectorXd& error, const Eigen::MatrixXd& cov) {
  const auto size = static_cast<std::size_t>(error.size());
  PM_EXPECTS(runs == 0 || size == states);
  states = size;
  ++runs;
  sum += normalised_error_squared(error, cov);
  for (Eigen::Index i = 0; i < error.size(); ++i)
    if (std::abs(error(i)) <= 1.96 * std::sqrt(cov(i, i))) ++entries_inside_95;
}

}  // namespace proofmass::estimate
