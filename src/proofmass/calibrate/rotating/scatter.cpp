#include <algorithm>
#include <cmath>
#include <vector>

#include "proofmass/calibrate/rotating/results.hpp"

namespace proofmass::calibrate {
namespace {

using Eigen::Index;

// The scores of one result, block by block.
struct Blocks {
  std::vector<double> z;
  std::vector<std::size_t> section;
};

// Calls f(first, last) for the blocks of each section.
template <class F>
void for_each_section(const std::vector<std::size_t>& section, F&& f) {
  for (std::size_t begin = 0, end = 0; begin < section.size(); begin = end) {
    while (end < section.size() && section[end] == section[begin]) ++end;
    f(begin, end);
  }
}

// Sums of neighbours of one section; a remainder is added to the last of its section.
Blocks joined(const Blocks& blocks, std::size_t to_one) {
  Blocks out;
  for_each_section(blocks.section, [&](std::size_t begin, std::size_t end) {
    const std::size_t whole = std::max<std::size_t>((end - begin) / to_one, 1);
    const std::size_t first = out.z.size();
    out.z.resize(first + whole, 0.0);
    out.section.resize(first + whole, blocks.section[begin]);
    for (std::size_t b = begin; b < end; ++b)
      out.z[first + std::min((b - begin) / to_one, whole - 1)] += blocks.z[b];
  });
  return out;
}

// How many neighbours may be joined: three, six blocks being left and four of each section.
std::size_t most_to_one(const Blocks& blocks) {
  constexpr std::size_t most = 3, of_all = 6, of_each = 4;
  std::size_t to_one = std::min(most, blocks.z.size() / of_all);
  for_each_section(blocks.section, [&](std::size_t begin, std::size_t end) {
    if (end - begin < blocks.z.size()) to_one = std::min(to_one, (end - begin) / of_each);
  });
  return std::max<std::size_t>(to_one, 1);
}

struct Variance {
  double value = 0.0, dof = 1.0;
};

// Each section has a mean of its own. Degrees of freedom: B. L. Welch, Biometrika 34 (1947) 28.
Variance variance_of(const Blocks& blocks) {
  double sum = 0.0, squares_over_dof = 0.0, all = 0.0;
  for_each_section(blocks.section, [&](std::size_t begin, std::size_t end) {
    const auto count = static_cast<double>(end - begin), left = std::max(count - 1.0, 1.0);
    double squares = 0.0;
    for (std::size_t b = begin; b < end; ++b) squares += blocks.z[b] * blocks.z[b];
    const double variance = squares * count / left;
    sum += variance;
    squares_over_dof += variance * variance / left;
    all += left;
  });
  return {sum, squares_over_dof > 0.0 ? sum * sum / squares_over_dof : all};
}

// Correlation of neighbours, minus its expectation for independent blocks about their means.
double neighbours_correlation(const Blocks& blocks) {
  double squares = 0.0, products = 0.0, sections = 0.0;
  for_each_section(blocks.section, [&](std::size_t begin, std::size_t end) {
    sections += 1.0;
    for (std::size_t b = begin; b < end; ++b) {
      squares += blocks.z[b] * blocks.z[b];
      if (b + 1 < end) products += blocks.z[b] * blocks.z[b + 1];
    }
  });
  return squares > 0.0 ? products / squares + sections / static_cast<double>(blocks.z.size()) : 0.0;
}

}  // namespace

RotationSpread RotationEstimate::spread_of(const Eigen::VectorXd& gradient, bool slow) const {
  constexpr double one_sided_95 = 1.645;
  const Eigen::VectorXd z = blocks.scores.transpose() * gradient;
  const Blocks single{{z.begin(), z.end()}, blocks.section};
  Variance variance = variance_of(single);
  const double rho = neighbours_correlation(single);
  RotationSpread spread;
  spread.widened = rho * std::sqrt(static_cast<double>(z.size())) > one_sided_95;
  if (spread.widened) variance.value *= (1.0 + std::min(rho, 0.9)) / (1.0 - std::min(rho, 0.9));
  const std::size_t to_one = slow ? most_to_one(single) : 1;
  if (to_one > 1) {
    const Variance of_joined = variance_of(joined(single, to_one));
    variance.dof = of_joined.dof;
    variance.value = std::max(spread.widened ? variance.value : 0.0, of_joined.value);
  }
  spread.dof = variance.dof;
  spread.std = std::sqrt(variance.value);
  return spread;
}

double RotationEstimate::dof() const {
  double sections = 0.0;
  for_each_section(blocks.section, [&](std::size_t, std::size_t) { sections += 1.0; });
  return static_cast<double>(blocks.scores.cols()) - sections;
}

Eigen::MatrixXd RotationEstimate::covariance_of(const Eigen::MatrixXd& scores) const {
  return scores * scores.transpose() * (static_cast<double>(scores.cols()) / dof());
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
