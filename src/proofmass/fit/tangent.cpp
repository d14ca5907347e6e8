#include "proofmass/fit/tangent.hpp"

#include <Eigen/QR>
#include <Eigen/SVD>
#include <cmath>
#include <limits>

namespace proofmass::fit {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace

Tangent tangent_at(const Eigen::MatrixXd& J, const Eigen::VectorXd& r) {
  const Eigen::Index n = J.rows(), p = J.cols();
  Tangent tangent{Eigen::VectorXd::Zero(p), Eigen::MatrixXd::Zero(p, p), 0.0,
                  p == 0 ? 1.0 : infinity, 0};
  if (p == 0) return tangent;
  Eigen::VectorXd length = J.colwise().stableNorm();
  for (double& l : length)
    if (l == 0.0) l = 1.0;
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(J * length.cwiseInverse().asDiagonal());
  const Eigen::MatrixXd R = qr.matrixQR().topRows(p).triangularView<Eigen::Upper>();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(R, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::VectorXd& S = svd.singularValues();
  const double negligible = static_cast<double>(n) * std::numeric_limits<double>::epsilon() * S(0);
  while (tangent.rank < p && S(tangent.rank) > negligible) ++tangent.rank;
  if (tangent.rank == p) tangent.condition = S(0) / S(p - 1);

  const auto D_inverse = length.cwiseInverse().asDiagonal();
  const Eigen::MatrixXd V = D_inverse * (qr.colsPermutation() * svd.matrixV());
  const Eigen::VectorXd rotated = (qr.householderQ().transpose() * r).head(p);
  const Eigen::VectorXd seen = (svd.matrixU().transpose() * rotated).head(tangent.rank);
  const Eigen::VectorXd S_inverse = S.head(tangent.rank).cwiseInverse();
  const Eigen::MatrixXd VS = V.leftCols(tangent.rank) * S_inverse.asDiagonal();
  tangent.step = -VS * seen;
  tangent.inverse_product = VS * VS.transpose();
  tangent.along = seen.norm();
  for (Eigen::Index i = 0; i < p; ++i) {
    const double hidden = V.row(i).tail(p - tangent.rank).norm() * length(i);
    if (hidden > 1e-6) tangent.inverse_product(i, i) = infinity;
  }
  return tangent;
}

}  // namespace proofmass::fit
