#include "proofmass/calibrate/gyroscope/rests.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "proofmass/calibrate/multi_position/pose_selection.hpp"
#include "proofmass/calibrate/slow_noise.hpp"
#include "proofmass/core/linalg.hpp"
#include "proofmass/core/units.hpp"

namespace proofmass::calibrate {
namespace {

using Eigen::Index;
using Eigen::Matrix4d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::Vector4d;
using Eigen::VectorXd;

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

// Covariance of a random walk of unit strength between the rests, about its mean in each session.
MatrixXd walk_between(const std::vector<GyroscopeRest>& rests) {
  const auto n = static_cast<Index>(rests.size());
  MatrixXd out = MatrixXd::Zero(n, n);
  for (std::size_t first = 0, end = 0; first < rests.size(); first = end) {
    std::vector<Span> spans;
    while (end < rests.size() && rests[end].session == rests[first].session)
      spans.push_back(rests[end++].span_s);
    const auto at = static_cast<Index>(first), count = static_cast<Index>(spans.size());
    if (count > 1)
      out.block(at, at, count, count) = slow_noise_covariance(
          spans, {spans.front().start, spans.back().end}, SlowNoise::random_walk);
  }
  return out;
}

// One axis: y = X p + error.
struct AxisRegression {
  MatrixXd X;
  VectorXd y, variance;
  MatrixXd common_rounding;
};

// Rests with nearly equal readings have nearly equal errors of rounding, which change with the
// force where G moves the reading over a step: as if the bias and each element of G were wrong by
// the error of a rest (per g).
MatrixXd common_rounding(const std::vector<GyroscopeRest>& rests, Index axis) {
  const auto n = static_cast<Index>(rests.size());
  MatrixXd rows(n, 4);
  for (Index k = 0; k < n; ++k) {
    const GyroscopeRest& rest = rests[static_cast<std::size_t>(k)];
    rows.row(k) << 1.0, rest.up.transpose();
    rows.row(k) *= std::sqrt(rest.rounding(axis));
  }
  return rows * rows.transpose();
}

// Logarithm of the restricted likelihood, up to a constant.
double restricted_likelihood(const AxisRegression& axis, const MatrixXd& V) {
  const PositiveInverse W = invert_positive(V);
  const PositiveInverse N = invert_positive(axis.X.transpose() * W.inverse * axis.X);
  const VectorXd r = axis.y - axis.X * (N.inverse * (axis.X.transpose() * (W.inverse * axis.y)));
  return -0.5 * (W.log_determinant + N.log_determinant + r.dot(W.inverse * r));
}

// The noise of the means and the random walk that they show.
MatrixXd covariance_of(const AxisRegression& axis, const MatrixXd& walk) {
  const MatrixXd noise = axis.common_rounding + MatrixXd(axis.variance.asDiagonal());
  const double usual = walk.diagonal().mean();
  if (!(usual > 0.0) || axis.X.rows() < axis.X.cols() + 3) return noise;
  // From a walk that is hardly visible to one that is ten thousand times the noise's variance.
  std::vector<double> strengths{0.0};
  for (double ratio = 0.1; ratio < 2e4; ratio *= 2.0)
    strengths.push_back(ratio * axis.variance.mean() / usual);
  std::vector<double> likelihood;
  for (const double strength : strengths)
    likelihood.push_back(restricted_likelihood(axis, noise + strength * walk));
  const double best = *std::ranges::max_element(likelihood);
  double sum = 0.0, mean = 0.0;
  for (std::size_t k = 0; k < strengths.size(); ++k) {
    const double prior = k == 0 ? 0.5 : 0.5 / static_cast<double>(strengths.size() - 1);
    const double weight = prior * std::exp(likelihood[k] - best);
    sum += weight;
    mean += weight * strengths[k];
  }
  return noise + mean / sum * walk;
}

AxisRegression equations_of(const GyroscopeData& data,
                            const std::vector<Vector3d>& earth,
                            const Vector3d& earth_variance,
                            Index axis,
                            Index count) {
  const auto n = static_cast<Index>(data.rests.size());
  AxisRegression out{MatrixXd(n, count), VectorXd(n), VectorXd(n),
                     common_rounding(data.rests, axis)};
  for (Index k = 0; k < n; ++k) {
    const GyroscopeRest& rest = data.rests[static_cast<std::size_t>(k)];
    Vector4d row;
    row << 1.0, rest.force;
    out.X.row(k) = row.head(count);
    out.y(k) = rest.mean(axis) - earth[static_cast<std::size_t>(k)](axis);
    out.variance(k) = std::max(rest.variance(axis) + earth_variance(axis), 1e-300);
  }
  return out;
}

}  // namespace

RestRegression regress_rests(const GyroscopeData& data,
                             const std::vector<Vector3d>& earth,
                             const Vector3d& earth_variance) {
  RestRegression out;
  out.why_no_g = why_no_g(data.rests);
  const Index count = out.why_no_g.empty() ? 4 : 1;
  const auto dof = static_cast<double>(static_cast<Index>(data.rests.size()) - count);
  const MatrixXd walk = walk_between(data.rests);
  double total = 0.0;
  for (Index axis = 0; axis < 3; ++axis) {
    const AxisRegression one = equations_of(data, earth, earth_variance, axis, count);
    // Without known noise only the ratios of the variances count.
    const MatrixXd V =
        data.noise_dof > 0.0 ? covariance_of(one, walk) : MatrixXd(one.variance.asDiagonal());
    const MatrixXd W = positive_inverse(V);
    const MatrixXd inverse = positive_inverse(one.X.transpose() * W * one.X);
    const VectorXd p = inverse * (one.X.transpose() * (W * one.y)), r = one.y - one.X * p;
    const Scatter scatter = scatter_of(r.dot(W * r), dof, data.noise_dof);
    const auto place = static_cast<std::size_t>(axis);
    out.bias(axis) = p(0);
    if (count == 4) out.G.row(axis) = p.tail(3).transpose();
    out.covariance[place].setZero();
    out.covariance[place].topLeftCorner(count, count) = scatter.factor * inverse;
    // The walk is estimated from the same residuals.
    out.dof[place] = std::min(scatter.dof, std::max(dof, 1.0));
    total += r.cwiseAbs2().dot(one.variance.cwiseInverse());
  }
  if (data.noise_dof > 0.0 && dof > 0.0)
    out.lack_of_fit = scatter_of(total, 3.0 * dof, data.noise_dof).lack_of_fit;
  return out;
}

}  // namespace proofmass::calibrate
