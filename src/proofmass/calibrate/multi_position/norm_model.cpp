#include "proofmass/calibrate/multi_position/norm_model.hpp"

#include <algorithm>

#include "proofmass/core/linalg.hpp"

namespace proofmass::calibrate {

Parameters ReadingScale::slope() const {
  Parameters slope;
  slope << half, half / gravity_mps2, Eigen::Vector3d::Ones();
  return slope;
}

Parameters ReadingScale::to_reading(const Parameters& normalised) const {
  Parameters p = slope().cwiseProduct(normalised);
  p.head<3>() += center;
  return p;
}

Parameters ReadingScale::to_normalised(const Parameters& reading) const {
  Parameters p = reading;
  p.head<3>() -= center;
  return p.cwiseQuotient(slope());
}

Eigen::Vector3d ReadingScale::normalised(const Eigen::Vector3d& reading) const {
  return (reading - center).cwiseQuotient(half);
}

std::optional<ReadingScale> reading_scale(View<Pose> poses, double gravity_mps2) {
  Eigen::Vector3d low = poses.front().mean, high = low;
  for (const Pose& pose : poses) {
    low = low.cwiseMin(pose.mean);
    high = high.cwiseMax(pose.mean);
  }
  // Halves first: the sum of two values may overflow.
  const Eigen::Vector3d center = low / 2.0 + high / 2.0;
  Eigen::Vector3d half = high / 2.0 - low / 2.0;
  if (!(half.maxCoeff() > 0.0)) return std::nullopt;
  // An axis with constant output does not determine its own range.
  half = (half.array() > 1e-3 * half.maxCoeff()).select(half, half.maxCoeff());
  return ReadingScale{center, half, gravity_mps2};
}

std::vector<NormalisedPose> normalise(View<Pose> poses, const ReadingScale& scale) {
  const Eigen::Vector3d inverse = scale.half.cwiseInverse();
  std::vector<NormalisedPose> out;
  out.reserve(poses.size());
  for (const Pose& pose : poses) {
    out.push_back({(pose.mean - scale.center).cwiseProduct(inverse),
                   inverse.asDiagonal() * pose.mean_covariance * inverse.asDiagonal()});
  }
  return out;
}

Weighable weighable(View<Pose> poses, double noise_dof) {
  Weighable out{{poses.begin(), poses.end()}, noise_dof};
  const bool known = noise_dof > 0.0 && std::ranges::all_of(poses, [](const Pose& pose) {
                       return pose.mean_covariance.diagonal().minCoeff() > 0.0;
                     });
  if (known) return out;
  out.noise_dof = 0.0;
  const std::optional<ReadingScale> scale = reading_scale(poses, 1.0);
  const double unit = scale ? 1e-3 * scale->half.maxCoeff() : 1.0;
  for (Pose& pose : out.poses) pose.mean_covariance = unit * unit * Eigen::Matrix3d::Identity();
  return out;
}

NormData norm_data(const Weighable& weighed,
                   const ReadingScale& scale,
                   const MultiPositionOptions& options) {
  NormData data{.poses = normalise(weighed.poses, scale)};
  if (weighed.noise_dof == 0.0) return data;
  const auto n = static_cast<Eigen::Index>(weighed.poses.size());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double half = scale.half(static_cast<Eigen::Index>(axis));
    if (options.between[axis].rows() == n)
      data.between[axis] = options.between[axis] / (half * half);
  }
  return data;
}

Eigen::Matrix3d correction(const Parameters& p) {
  Eigen::Matrix3d T = Eigen::Matrix3d::Identity();
  T(0, 1) = -p(6);
  T(0, 2) = p(7);
  T(1, 2) = -p(8);
  return T * p.segment<3>(3).cwiseInverse().asDiagonal();
}

NormTerm norm_term(const Parameters& p, const NormalisedPose& pose) {
  const Eigen::Matrix3d M = correction(p);
  const Eigen::Vector3d w = (pose.u - p.head<3>()).cwiseQuotient(p.segment<3>(3));
  NormTerm term;
  term.force = M * (pose.u - p.head<3>());
  const double norm = term.force.norm();
  term.residual = norm - 1.0;
  const Eigen::Vector3d n = term.force / norm;
  const Eigen::RowVector3d nM = n.transpose() * M;
  // ∂f/∂scale_k is column k of M times −(u − b)_k / scale_k.
  term.gradient << -nM, -nM.cwiseProduct(w.transpose()), -n.x() * w.y(), n.x() * w.z(),
      -n.y() * w.z();
  term.variance = nM * pose.covariance * nM.transpose();
  return term;
}

double ResidualWeights::operator()(Eigen::Index i, Eigen::Index j) const {
  if (dense.size() > 0) return dense(i, j);
  return i == j ? diagonal(i) : 0.0;
}

Eigen::MatrixXd ResidualWeights::times(const Eigen::MatrixXd& rows) const {
  if (dense.size() > 0) return dense * rows;
  return diagonal.asDiagonal() * rows;
}

ResidualWeights residual_weights(const NormData& data,
                                 const std::vector<NormTerm>& terms,
                                 const std::vector<bool>& used) {
  const auto n = static_cast<Eigen::Index>(terms.size());
  ResidualWeights out{Eigen::VectorXd::Zero(n), {}};
  std::vector<Eigen::Index> rows;
  for (std::size_t k = 0; k < terms.size(); ++k) {
    if (!used[k]) continue;
    rows.push_back(static_cast<Eigen::Index>(k));
    out.diagonal(rows.back()) = 1.0 / terms[k].variance;
  }
  if (data.independent()) return out;
  Eigen::MatrixXd C = Eigen::MatrixXd::Zero(n, n);
  for (const Eigen::Index i : rows) {
    const NormTerm& one = terms[static_cast<std::size_t>(i)];
    C(i, i) = one.variance;
    for (const Eigen::Index j : rows) {
      if (j >= i) break;
      const NormTerm& other = terms[static_cast<std::size_t>(j)];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto column = static_cast<Eigen::Index>(axis);
        C(i, j) += one.gradient(column) * other.gradient(column) * data.between[axis](i, j);
      }
      C(j, i) = C(i, j);
    }
  }
  out.dense = Eigen::MatrixXd::Zero(n, n);
  out.dense(rows, rows) = positive_inverse(C(rows, rows));
  out.diagonal = out.dense.diagonal();
  return out;
}

}  // namespace proofmass::calibrate
