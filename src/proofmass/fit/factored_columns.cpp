#include "proofmass/fit/factored_columns.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "proofmass/core/contract.hpp"

namespace proofmass::fit {
namespace {

using Index = Eigen::Index;

constexpr double negligible = 1e-12;

}  // namespace

FactoredColumns factored(const Eigen::MatrixXd& A, Eigen::VectorXd length) {
  for (double& l : length)
    if (l == 0.0) l = 1.0;
  const auto D_inverse = length.cwiseInverse().asDiagonal();
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(A * D_inverse);
  const Index most = std::min(A.rows(), A.cols());
  Index rank = 0;
  while (rank < most && std::abs(qr.matrixQR()(rank, rank)) > negligible) ++rank;
  Eigen::MatrixXd R_inverse = Eigen::MatrixXd::Zero(A.cols(), rank);
  R_inverse.topRows(rank).setIdentity();
  qr.matrixQR()
      .topLeftCorner(rank, rank)
      .triangularView<Eigen::Upper>()
      .solveInPlace(R_inverse.topRows(rank));
  return {.Q = qr.householderQ() * Eigen::MatrixXd::Identity(A.rows(), rank),
          .R_inverse = D_inverse * (qr.colsPermutation() * R_inverse),
          .inverse_product = {},
          .length = std::move(length)};
}

std::shared_ptr<const FactoredColumns> factor_columns(const Eigen::Ref<const Eigen::MatrixXd>& A) {
  PM_EXPECTS(A.allFinite());
  auto columns = std::make_shared<FactoredColumns>(factored(A, A.colwise().stableNorm()));
  columns->inverse_product = columns->R_inverse * columns->R_inverse.transpose();
  return columns;
}

}  // namespace proofmass::fit
