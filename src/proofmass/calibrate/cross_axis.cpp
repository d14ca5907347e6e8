#include "proofmass/calibrate/cross_axis.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "proofmass/core/chi_square.hpp"
#include "proofmass/core/linalg.hpp"

namespace proofmass::calibrate {
namespace {

double normal_cdf(double z) {
  return 0.5 * std::erfc(-z / std::numbers::sqrt2);
}

// Two independent normal variables.
struct Normal2 {
  double mean[2], std[2];

  // Probability that the norm of both is less than `length`: Simpson's rule over the first, x =
  // length sin t, the second integrated exactly.
  [[nodiscard]] double shorter_than(double length) const {
    const int steps = std[1] > 0.2 * std[0] ? 100 : 2000;  // the narrower, the sharper its edges
    const double h = std::numbers::pi / steps;
    double sum = 0.0;
    for (int k = 0; k <= steps; ++k) {
      const double t = -std::numbers::pi / 2.0 + h * k;
      const double z = (length * std::sin(t) - mean[0]) / std[0], half = length * std::cos(t);
      const double second =
          normal_cdf((half - mean[1]) / std[1]) - normal_cdf((-half - mean[1]) / std[1]);
      const double weight = k == 0 || k == steps ? 1.0 : k % 2 == 1 ? 4.0 : 2.0;
      sum += weight * std::exp(-0.5 * z * z) * second * half;
    }
    return sum * h / 3.0 / (std[0] * std::sqrt(2.0 * std::numbers::pi));
  }
};

// The length exceeded with probability 0.05, which is below `high`: by the Illinois variant of
// regula falsi.
double root_95(const Normal2& normal, double high) {
  constexpr int most = 100;
  constexpr double exact = 1e-10;
  double low = 0.0, below = -0.95, above = 0.05;
  int side = 0;
  for (int k = 0; k < most && high - low > exact * high; ++k) {
    const double at = low - below * (high - low) / (above - below);
    const double f = normal.shorter_than(at) - 0.95;
    if (std::abs(f) < exact) return at;
    if (f < 0.0) {
      low = at;
      below = f;
      if (side < 0) above *= 0.5;
      side = -1;
    } else {
      high = at;
      above = f;
      if (side > 0) below *= 0.5;
      side = 1;
    }
  }
  return high;
}

// The length exceeded with probability 0.05. The wider variable comes first, where Simpson's rule
// has to resolve it.
double length_quantile_95(Normal2 normal) {
  if (normal.std[0] < normal.std[1]) {
    std::swap(normal.std[0], normal.std[1]);
    std::swap(normal.mean[0], normal.mean[1]);
  }
  const double size = std::hypot(normal.mean[0], normal.mean[1]);
  if (!(normal.std[0] > 1e-4 * size)) return size + 1.645 * normal.std[0];
  normal.std[1] = std::max(normal.std[1], 1e-3 * normal.std[0]);
  return root_95(normal, size + 6.0 * normal.std[0]);
}

// p-value of a squared length in units of its standard deviation: Hotelling's T² in two dimensions.
double chance_of(double squared, double dof) {
  if (dof <= 0.0) return std::exp(-0.5 * squared);
  if (dof <= 1.0) return 1.0;
  return fisher_f_p(squared * (dof - 1.0) / (2.0 * dof), 2.0, dof - 1.0);
}

}  // namespace

Result<CrossAxis> cross_axis_sensitivity(const Eigen::Vector2d& ratio,
                                         const Eigen::Matrix2d& covariance,
                                         double dof) {
  if (!ratio.allFinite() || !covariance.allFinite() || !std::isfinite(dof)) {
    return Error{Errc::not_finite, "cross-axis sensitivity: a figure is not finite"};
  }
  const SymmetricEigen eigen = symmetric_eigen(covariance);
  const double largest = eigen.values(1);
  if (eigen.values(0) < -1e-9 * std::abs(largest)) {
    return Error{Errc::invalid_argument, "cross-axis sensitivity: a variance is below zero"};
  }
  const Eigen::Vector2d mean = eigen.vectors.transpose() * ratio;
  const Eigen::Vector2d std = eigen.values.cwiseMax(0.0).cwiseSqrt();
  CrossAxis result;
  const double size = ratio.norm();
  double squared = 0.0;
  for (int k = 0; k < 2; ++k) {
    const double least = std::max(std(k), 1e-9 * std(1));
    squared += least > 0.0 ? (mean(k) / least) * (mean(k) / least) : 0.0;
  }
  const bool exact = !(largest > 0.0);
  result.p = exact ? (size > 0.0 ? 0.0 : 1.0) : chance_of(squared, dof);
  const double wider =
      dof > 0.0 ? student_t_quantile(0.95, dof) / student_t_quantile(0.95, 1e9) : 1.0;
  result.upper_95 =
      exact ? size : length_quantile_95({{mean(0), mean(1)}, {wider * std(0), wider * std(1)}});
  constexpr double significant = 0.01;
  if (result.p < significant) {
    const Eigen::Vector2d e = ratio / size;
    const double along = e.dot(covariance * e);
    const double across = std::max(covariance.trace() - along, 0.0);
    result.value = Uncertain{size - across / (2.0 * size), std::sqrt(std::max(along, 0.0))};
  } else {
    result.reason = fmt::format(
        "the cross-axis sensitivity is not distinguishable from zero (p = {:.2g}): it is below "
        "{:.3g} with "
        "95 % confidence",
        result.p, result.upper_95);
  }
  return result;
}

Result<std::array<CrossAxis, 3>> cross_axis_sensitivities(
    const Eigen::Matrix3d& sensitivity, const Eigen::Matrix<double, 9, 9>& covariance, double dof) {
  std::array<CrossAxis, 3> all;
  for (int axis = 0; axis < 3; ++axis) {
    const int across[2] = {axis == 0 ? 1 : 0, axis == 2 ? 1 : 2};
    const double along = sensitivity(axis, axis);
    if (!(std::abs(along) > 0.0)) {
      return Error{Errc::not_observable,
                   fmt::format("axis {} has no sensitivity along itself", "xyz"[axis])};
    }
    // r = (S_a, S_b)/S_x: derivatives by S_x and by each.
    Eigen::Matrix<double, 2, 9> J = Eigen::Matrix<double, 2, 9>::Zero();
    Eigen::Vector2d ratio;
    for (int k = 0; k < 2; ++k) {
      ratio(k) = sensitivity(axis, across[k]) / along;
      J(k, 3 * axis + across[k]) = 1.0 / along;
      J(k, 3 * axis + axis) = -ratio(k) / along;
    }
    const auto one = cross_axis_sensitivity(ratio, J * covariance * J.transpose(), dof);
    if (!one) return one.error().at(fmt::format("axis {}", "xyz"[axis]));
    all[static_cast<std::size_t>(axis)] = *one;
  }
  return all;
}

}  // namespace proofmass::calibrate
