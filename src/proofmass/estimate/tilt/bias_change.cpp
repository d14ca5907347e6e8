#include "proofmass/estimate/tilt/bias_change.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>

#include "proofmass/core/statistics.hpp"

namespace proofmass::estimate {
namespace {

// Without a stated stability: a bias almost never returns exactly to its previous value.
constexpr double prior_of_none = 0.1, prior_of_stated = 0.9;
constexpr double least_change_mps2 = 0.2e-3 * standard_gravity_mps2;
constexpr double most_change_mps2 = 60e-3 * standard_gravity_mps2;
// Without a calibration.
constexpr double usual_bias_mps2 = 10e-3 * standard_gravity_mps2, log_spread = 1.0;
constexpr std::size_t most_rests = 16;

// Standard deviations of the biases, or of their change, with their weights.
struct Size {
  double std_mps2, weight;
};
using Sizes = std::array<Size, 32>;

// The usual change, then a grid even in the logarithm.
Sizes sizes_of_change(std::optional<double> stability_mps2) {
  Sizes sizes{};
  const double usual = stability_mps2 ? prior_of_stated : prior_of_none;
  sizes[0] = {stability_mps2.value_or(0.0), usual};
  const auto others = static_cast<double>(sizes.size() - 1);
  const double apart = std::log(most_change_mps2 / least_change_mps2) / (others - 1.0);
  for (std::size_t k = 1; k < sizes.size(); ++k)
    sizes[k] = {least_change_mps2 * std::exp(apart * static_cast<double>(k - 1)),
                (1.0 - usual) / others};
  return sizes;
}

// Log-normal: three standard deviations on either side of the median.
Sizes uncalibrated_sizes() {
  Sizes sizes{};
  double sum = 0.0;
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    const double off = 6.0 * static_cast<double>(k) / static_cast<double>(sizes.size() - 1) - 3.0;
    sizes[k] = {usual_bias_mps2 * std::exp(log_spread * off), std::exp(-0.5 * off * off)};
    sum += sizes[k].weight;
  }
  for (Size& size : sizes) size.weight /= sum;
  return sizes;
}

std::vector<const TiltRest*> some_of(const std::vector<TiltRest>& rests) {
  std::vector<const TiltRest*> some;
  const std::size_t count = std::min(rests.size(), most_rests);
  for (std::size_t i = 0; i < count; ++i) {
    const TiltRest& rest = rests[i * rests.size() / count];
    if (rest.norm_mps2) some.push_back(&rest);
  }
  return some;
}

double log_likelihood(const Eigen::VectorXd& off, const Eigen::MatrixXd& cov) {
  const Eigen::LLT<Eigen::MatrixXd> root(cov);
  const Eigen::VectorXd white = root.matrixL().solve(off);
  return -0.5 * white.squaredNorm() -
         Eigen::MatrixXd(root.matrixL()).diagonal().array().log().sum();
}

// Half width of the central 95 % of a zero-mean mixture of normal distributions.
double half_width(const Sizes& sizes, double known_variance) {
  double low = 0.0, high = 0.0;
  for (const Size& size : sizes)
    high = std::max(high, 3.0 * std::sqrt(known_variance + square(size.std_mps2)));
  for (int round = 0; round < 60; ++round) {
    const double middle = 0.5 * (low + high);
    double outside = 0.0;
    for (const Size& size : sizes)
      outside +=
          size.weight * std::erfc(middle / (std::numbers::sqrt2 *
                                            std::sqrt(known_variance + square(size.std_mps2))));
    (outside > 0.05 ? low : high) = middle;
  }
  return high;
}

struct Posterior {
  Sizes sizes;
  double one_axis_m2ps4 = 0.0;  ///< variance due to the calibration, mean over the rests
  /// Such that ± 1.96 of it, with that variance, is the 95 % interval of the mixture.
  [[nodiscard]] double std_mps2() const {
    const double wanted = square(half_width(sizes, one_axis_m2ps4) / 1.959964);
    return std::sqrt(std::max(0.0, wanted - one_axis_m2ps4));
  }
};

Posterior posterior_of(Sizes sizes,
                       const std::vector<TiltRest>& rests,
                       const ForceSpread& spread,
                       const Uncertain& gravity_mps2) {
  const std::vector<const TiltRest*> some = some_of(rests);
  if (some.empty()) return {sizes};
  const auto count = static_cast<Eigen::Index>(some.size());
  Eigen::MatrixXd up(count, 3), noise = Eigen::MatrixXd::Zero(count, count);
  Eigen::VectorXd off(count);
  Mat<3, 3> calibration = Mat<3, 3>::Zero();
  for (Eigen::Index i = 0; i < count; ++i) {
    const TiltRest& rest = *some[static_cast<std::size_t>(i)];
    const Mat<3> u = rest.force_mps2.normalized();
    const Mat<3, 3> own = spread.calibration(rest.force_mps2);
    up.row(i) = u.transpose();
    off(i) = rest.norm_mps2->value - gravity_mps2.value;
    noise(i, i) = std::max(1e-12, square(rest.norm_mps2->std) - u.dot(own * u));
    calibration += own / static_cast<double>(count);
  }
  const Eigen::MatrixXd known = up * calibration * up.transpose() + noise +
                                square(gravity_mps2.std) * Eigen::MatrixXd::Ones(count, count);
  double best = -std::numeric_limits<double>::infinity(), sum = 0.0;
  std::array<double, std::tuple_size_v<Sizes>> logs{};
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    logs[k] = log_likelihood(off, known + square(sizes[k].std_mps2) * up * up.transpose());
    best = std::max(best, logs[k]);
  }
  for (std::size_t k = 0; k < sizes.size(); ++k) sum += sizes[k].weight *= std::exp(logs[k] - best);
  for (Size& size : sizes) size.weight /= sum;
  return {sizes, calibration.trace() / 3.0};
}

}  // namespace

BiasChange bias_change(const std::vector<TiltRest>& rests,
                       const ForceSpread& spread,
                       const Uncertain& gravity_mps2,
                       std::optional<double> stability_mps2) {
  const Sizes prior = sizes_of_change(stability_mps2);
  const double odds_before = (1.0 - prior[0].weight) / prior[0].weight;
  const Posterior found = posterior_of(prior, rests, spread, gravity_mps2);
  const double usual = found.sizes[0].weight, other = 1.0 - usual;
  return {other / (other + odds_before * usual), found.std_mps2()};
}

double uncalibrated_bias_std_mps2(const std::vector<TiltRest>& rests,
                                  const ForceSpread& spread,
                                  const Uncertain& gravity_mps2) {
  return posterior_of(uncalibrated_sizes(), rests, spread, gravity_mps2).std_mps2();
}

}  // namespace proofmass::estimate
