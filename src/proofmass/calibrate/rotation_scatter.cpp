#include <algorithm>
#include <cmath>
#include <vector>

#include "proofmass/calibrate/rotation_results.hpp"

namespace proofmass::calibrate {
namespace {

using Eigen::Index;

// Sums of so many neighbours of one section; what is left over goes to the last of its section.
std::vector<double> joined_blocks(const Eigen::VectorXd& z,
                                  const std::vector<std::size_t>& section,
                                  std::size_t to_one) {
  std::vector<double> joined;
  for (std::size_t begin = 0; begin < section.size();) {
    std::size_t end = begin;
    while (end < section.size() && section[end] == section[begin]) ++end;
    const std::size_t whole = std::max<std::size_t>((end - begin) / to_one, 1);
    const std::size_t first = joined.size();
    joined.resize(first + whole, 0.0);
    for (std::size_t b = begin; b < end; ++b) {
      joined[first + std::min((b - begin) / to_one, whole - 1)] += z(static_cast<Index>(b));
    }
    begin = end;
  }
  return joined;
}

}  // namespace

RotationSpread RotationEstimate::spread_of(const Eigen::VectorXd& gradient, bool slow) const {
  constexpr double least_joined = 6.0, most_to_one = 3.0, one_sided_95 = 1.645;
  const Eigen::VectorXd z = blocks.scores.transpose() * gradient;
  const auto count = static_cast<double>(z.size());
  const double squares = z.squaredNorm();
  double products = 0.0;
  for (Index b = 0; b + 1 < z.size(); ++b) {
    const auto at = static_cast<std::size_t>(b);
    if (blocks.section[at] == blocks.section[at + 1]) products += z(b) * z(b + 1);
  }
  // Expected of independent blocks about their mean: −1/B.
  const double rho = squares > 0.0 ? products / squares + 1.0 / count : 0.0;
  RotationSpread spread{0.0, dof(), rho * std::sqrt(count) > one_sided_95};
  const auto lost = static_cast<double>(constraints);
  double variance = squares * count / (count - lost);
  if (spread.widened) variance *= (1.0 + std::min(rho, 0.9)) / (1.0 - std::min(rho, 0.9));
  const auto to_one =
      static_cast<std::size_t>(std::clamp(std::floor(count / least_joined), 1.0, most_to_one));
  if (slow && to_one > 1) {
    const std::vector<double> joined = joined_blocks(z, blocks.section, to_one);
    double sum = 0.0;
    for (const double x : joined) sum += x * x;
    const auto left = static_cast<double>(joined.size());
    spread.dof = left - lost;
    variance = std::max(spread.widened ? variance : 0.0, sum * left / (left - lost));
  }
  spread.std = std::sqrt(variance);
  return spread;
}

double RotationEstimate::dof() const {
  return static_cast<double>(blocks.scores.cols()) - static_cast<double>(constraints);
}

Eigen::MatrixXd RotationEstimate::covariance() const {
  const auto count = static_cast<double>(blocks.scores.cols());
  return blocks.scores * blocks.scores.transpose() *
         (count / (count - static_cast<double>(constraints)));
}

double RotationEstimate::half_width(const Eigen::VectorXd& gradient, double by_scatter) const {
  double squares = by_scatter * by_scatter, sum = 0.0;
  for (const Eigen::VectorXd& bound : bounds) {
    const double along = gradient.dot(bound);
    squares += along * along;
  }
  for (const Eigen::VectorXd& bound : shared) sum += std::abs(gradient.dot(bound));
  return std::sqrt(squares) + sum;
}

}  // namespace proofmass::calibrate
