#include "proofmass/calibrate/gyroscope_rests.hpp"

#include <algorithm>
#include <cmath>

#include "proofmass/calibrate/pose_selection.hpp"
#include "proofmass/core/linalg.hpp"
#include "proofmass/core/units.hpp"

namespace proofmass::calibrate {
namespace {

using Eigen::Index;
using Eigen::Matrix4d;
using Eigen::Vector3d;
using Eigen::Vector4d;

// Forces within this ratio of smallest to largest spread do not determine G.
constexpr double least_spread = 0.03;

std::string why_no_g(const std::vector<GyroscopeRest>& rests) {
  if (rests.size() < 6) return "fewer than six positions at rest";
  Matrix4d N = Matrix4d::Zero();
  for (const GyroscopeRest& rest : rests) {
    Vector4d row;
    row << 1.0, rest.force / standard_gravity_mps2;
    N += row * row.transpose();
  }
  const Eigen::VectorXd spread = symmetric_eigen(N).values;
  if (std::sqrt(std::max(spread(0), 0.0)) > least_spread * std::sqrt(spread(3))) return {};
  return "the positions at rest do not turn every axis up and down";
}

}  // namespace

RestRegression regress_rests(const GyroscopeData& data,
                             const std::vector<Vector3d>& earth,
                             const Vector3d& earth_variance) {
  RestRegression out;
  out.why_no_g = why_no_g(data.rests);
  const Index count = out.why_no_g.empty() ? 4 : 1;
  double total = 0.0, total_dof = 0.0;
  for (Index axis = 0; axis < 3; ++axis) {
    const auto n = static_cast<Index>(data.rests.size());
    Eigen::MatrixXd X(n, count);
    Eigen::VectorXd y(n), weight(n);
    for (Index k = 0; k < n; ++k) {
      const GyroscopeRest& rest = data.rests[static_cast<std::size_t>(k)];
      Vector4d row;
      row << 1.0, rest.force;
      X.row(k) = row.head(count);
      y(k) = rest.mean(axis) - earth[static_cast<std::size_t>(k)](axis);
      weight(k) = 1.0 / std::max(rest.variance(axis) + earth_variance(axis), 1e-300);
    }
    const Eigen::MatrixXd inverse = positive_inverse(X.transpose() * weight.asDiagonal() * X);
    const Eigen::VectorXd p = inverse * (X.transpose() * weight.cwiseProduct(y));
    const double rss = (y - X * p).cwiseAbs2().dot(weight), dof = static_cast<double>(n - count);
    const Scatter scatter = scatter_of(rss, dof, data.noise_dof);
    const auto place = static_cast<std::size_t>(axis);
    out.bias(axis) = p(0);
    if (count == 4) out.G.row(axis) = p.tail(3).transpose();
    out.covariance[place].setZero();
    out.covariance[place].topLeftCorner(count, count) = scatter.factor * inverse;
    out.dof[place] = scatter.dof;
    total += rss;
    total_dof += dof;
  }
  if (data.noise_dof > 0.0 && total_dof > 0.0)
    out.lack_of_fit = scatter_of(total, total_dof, data.noise_dof).lack_of_fit;
  return out;
}

}  // namespace proofmass::calibrate
