#include "proofmass/calibrate/multi_position/pose_design.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <vector>

#include "proofmass/calibrate/direction_words.hpp"
#include "proofmass/core/linalg.hpp"

namespace proofmass::calibrate {
namespace {

constexpr std::array<std::string_view, 9> names{"bias x",
                                                "bias y",
                                                "bias z",
                                                "scale x",
                                                "scale y",
                                                "scale z",
                                                "the angle between x and y",
                                                "the angle between x and z",
                                                "the angle between y and z"};

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t k = 0; k < words.size(); ++k) {
    if (k > 0) text += k + 1 == words.size() ? " and " : ", ";
    text += words[k];
  }
  return text;
}

bool is_near(const Eigen::Vector3d& up, View<Eigen::Vector3d> taken) {
  return std::ranges::any_of(
      taken, [&](const Eigen::Vector3d& other) { return up.dot(other) > std::cos(taken_rad); });
}

}  // namespace

std::string unresolved(const Eigen::MatrixXd& information) {
  Eigen::VectorXd length = information.diagonal().cwiseSqrt();
  length = (length.array() > 0.0).select(length, 1.0);
  const Eigen::VectorXd inverse = length.cwiseInverse();
  const Eigen::MatrixXd gram = inverse.asDiagonal() * information * inverse.asDiagonal();
  const Eigen::VectorXd weakest = symmetric_eigen(gram).vectors.col(0).cwiseAbs();
  std::vector<std::string> words;
  for (Eigen::Index k = 0; k < weakest.size(); ++k) {
    if (weakest(k) > 0.4 * weakest.maxCoeff())
      words.emplace_back(names[static_cast<std::size_t>(k)]);
  }
  if (words.size() == 1) return "do not determine " + words.front();
  return fmt::format("do not separate {}", joined(words));
}

Eigen::VectorXd errors_at_1g(const Eigen::MatrixXd& covariance, const Parameters& p) {
  Eigen::VectorXd out = covariance.diagonal().cwiseSqrt();
  out.head<3>() = out.head<3>().cwiseQuotient(p.segment<3>(3)).cwiseAbs();
  out.segment<3>(3) = out.segment<3>(3).cwiseQuotient(p.segment<3>(3)).cwiseAbs();
  return out;
}

NextPose next_pose(const Eigen::MatrixXd& information,
                   const Parameters& p,
                   double residual_variance,
                   View<Eigen::Vector3d> taken) {
  const Eigen::Index free = information.rows();
  const Eigen::MatrixXd covariance = positive_inverse(information);
  const Eigen::Matrix3d back = correction(p).inverse();
  NextPose best;
  double widest = 0.0;
  Eigen::VectorXd column;
  for (int code = 0; code < 27; ++code) {
    const Eigen::Vector3i side(code / 9 - 1, code / 3 % 3 - 1, code % 3 - 1);
    if (side.isZero()) continue;
    const Eigen::Vector3d up = side.cast<double>().normalized();
    if (is_near(up, taken)) continue;
    const NormalisedPose pose{p.head<3>() + back * up, Eigen::Matrix3d::Zero()};
    const Eigen::VectorXd j = norm_term(p, pose).gradient.head(free);
    const double variance = j.dot(covariance * j);
    // Opposite positions can be equivalent: rounding must not decide.
    if (!(variance > widest * (1.0 + 1e-9))) continue;
    widest = variance;
    best.up = up;
    best.words = laying_words(side);
    column = covariance * j;
  }
  if (column.size() == 0) return best;
  const Eigen::MatrixXd after =
      covariance - column * column.transpose() / (residual_variance + widest);
  const Eigen::VectorXd before = errors_at_1g(covariance, p);
  best.gain = 1.0 - errors_at_1g(after, p).maxCoeff() / before.maxCoeff();
  return best;
}

}  // namespace proofmass::calibrate
