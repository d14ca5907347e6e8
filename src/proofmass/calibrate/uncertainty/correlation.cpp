#include "proofmass/calibrate/uncertainty/correlation.hpp"

#include <fmt/format.h>

#include "proofmass/core/linalg.hpp"

namespace proofmass::calibrate {

Status check_correlation(const Eigen::MatrixXd& correlation, std::size_t count) {
  if (correlation.size() == 0) return Done{};
  const Error wrong{Errc::invalid_argument,
                    fmt::format("expected a correlation matrix of {} by {}: symmetric, 1 on the "
                                "diagonal, and without a combination of negative variance",
                                count, count)};
  const auto n = static_cast<Eigen::Index>(count);
  if (correlation.rows() != n || correlation.cols() != n || !correlation.allFinite()) return wrong;
  constexpr double rounding = 1e-9;
  if ((correlation - correlation.transpose()).cwiseAbs().maxCoeff() > rounding) return wrong;
  if ((correlation.diagonal().array() - 1.0).abs().maxCoeff() > rounding) return wrong;
  if (symmetric_eigen(correlation).values(0) < -rounding) return wrong;
  return Done{};
}

Eigen::MatrixXd root_of(const Eigen::MatrixXd& covariance) {
  const SymmetricEigen parts = symmetric_eigen(covariance);
  return parts.vectors * parts.values.cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

}  // namespace proofmass::calibrate
