#include "proofmass/calibrate/multi_position/dwell_noise.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "proofmass/core/linalg.hpp"

namespace proofmass::calibrate {
namespace {

using signal::AllanLevel;
using Levels = std::vector<AllanLevel>;

// One octave: adds differences of neighbours to the sums, stores their means at the front of
// `means`.
void halve(std::vector<double>& means, double& squares, double& pairs) {
  const std::size_t half = means.size() / 2;
  for (std::size_t k = 0; k < half; ++k) {
    const double a = means[2 * k], b = means[2 * k + 1];
    squares += 0.5 * (b - a) * (b - a);
    means[k] = 0.5 * (a + b);
  }
  pairs += static_cast<double>(half);
  means.resize(half);
}

Eigen::Vector3d shape(double m) {
  return {1.0 / m, 1.0, m};
}

// Fit of one choice of terms to the levels.
struct Strengths {
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double score = 0.0;  // −2 ln L of chi-square variables, and the price of each term
};

// Required gain in −2 ln L for a further term: the 5 % significance level. Rests are short and few,
// and spurious drift would be extrapolated to their whole length.
constexpr double price = 3.84;

// A variance from n pairs has the variance 2 σ⁴/n.
Strengths fit_strengths(const Levels& levels, const std::vector<Eigen::Index>& terms) {
  const auto count = static_cast<Eigen::Index>(terms.size());
  std::vector<double> fitted;
  fitted.reserve(levels.size());
  for (const AllanLevel& level : levels) fitted.push_back(level.variance);
  const double floor = 1e-12 * *std::ranges::max_element(fitted);
  Strengths out;
  out.score = price * static_cast<double>(count);
  Eigen::MatrixXd information;
  for (int round = 0; round < 10; ++round) {
    information = Eigen::MatrixXd::Zero(count, count);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(count);
    for (std::size_t k = 0; k < levels.size(); ++k) {
      const double size = std::max(fitted[k], floor);
      const double weight = levels[k].pairs / (2.0 * size * size);
      const Eigen::VectorXd row = shape(levels[k].samples)(terms);
      information += weight * row * row.transpose();
      right += weight * levels[k].variance * row;
    }
    out.x.setZero();
    out.x(terms) = non_negative_minimiser(information, right);
    for (std::size_t k = 0; k < levels.size(); ++k)
      fitted[k] = std::max(shape(levels[k].samples).dot(out.x), floor);
  }
  for (std::size_t k = 0; k < levels.size(); ++k)
    out.score += levels[k].pairs * (std::log(fitted[k]) + levels[k].variance / fitted[k]);
  // A term at zero is known to be absent.
  std::vector<Eigen::Index> active, in_terms;
  for (Eigen::Index k = 0; k < count; ++k) {
    const Eigen::Index term = terms[static_cast<std::size_t>(k)];
    if (!(out.x(term) > 0.0)) continue;
    active.push_back(k);
    in_terms.push_back(term);
  }
  out.covariance(in_terms, in_terms) = positive_inverse(information(active, active));
  return out;
}

// The mean over the choices by their weights exp(−score/2): uncertain drift is neither omitted nor
// taken at face value.
struct Averaged {
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  double dof = 0.0;  // 2/var(ln v) at the dwell asked for
};

Averaged averaged(const Levels& levels, double dwell) {
  const std::vector<std::vector<Eigen::Index>> choices{{0}, {0, 1}, {0, 2}, {0, 1, 2}};
  std::vector<Strengths> fits;
  for (const auto& terms : choices)
    if (terms.size() <= levels.size()) fits.push_back(fit_strengths(levels, terms));
  double best = fits.front().score, total = 0.0, mean = 0.0, square = 0.0;
  for (const Strengths& fit : fits) best = std::min(best, fit.score);
  Averaged out;
  for (const Strengths& fit : fits) {
    const double weight = std::exp(-0.5 * (fit.score - best));
    const double value = shape(dwell).dot(fit.x);
    if (!(value > 0.0)) continue;
    const double variance = shape(dwell).dot(fit.covariance * shape(dwell));
    total += weight;
    out.x += weight * fit.x;
    mean += weight * std::log(value);
    square += weight * (variance / (value * value) + std::log(value) * std::log(value));
  }
  if (total == 0.0) return out;
  out.x /= total;
  mean /= total;
  const double spread = square / total - mean * mean;
  if (spread > 0.0) out.dof = 2.0 / spread;
  return out;
}

// Variance, over all positions between two steps, of the quantisation error of a long mean: ½ Σ_k
// (exp(−2π²k²ρ²)/(πk))², for a step of 1 and normal noise of standard deviation ρ.
double undithered(double noise) {
  constexpr double pi = std::numbers::pi;
  double sum = 0.0;
  for (int k = 1; k <= 200; ++k) {
    const double term = std::exp(-2.0 * pi * pi * k * k * noise * noise) / (pi * k);
    sum += 0.5 * term * term;
    if (term < 1e-12) break;
  }
  return sum;
}

// The noise before quantisation from the variance of quantised samples, both in steps: these vary
// by the noise and by the part of 1/12 that is not common to all of them.
double noise_before_rounding(double variance) {
  double low = 0.0, high = std::sqrt(variance);
  for (int halving = 0; halving < 60; ++halving) {
    const double middle = 0.5 * (low + high);
    const double made = middle * middle + std::max(1.0 / 12.0 - undithered(middle), 0.0);
    (made < variance ? low : high) = middle;
  }
  return low;
}

// Quantisation error of the mean of a rest of any length: lsb²/12 without noise, and zero if noise
// spreads the samples over several steps. The noise is reduced by two standard deviations, since
// the error falls steeply with it.
double rounding_variance(const AllanLevel& single, double lsb) {
  if (!(lsb > 0.0)) return 0.0;
  if (single.variance == 0.0) return lsb * lsb / 12.0;
  const double least = 1.0 - 2.0 * std::sqrt(2.0 / std::max(single.pairs, 1.0));
  const double variance = std::max(least, 0.0) * single.variance / (lsb * lsb);
  return lsb * lsb * undithered(noise_before_rounding(variance));
}

}  // namespace

std::vector<AllanLevel> allan_levels(const std::vector<std::span<const double>>& rests) {
  std::vector<std::vector<double>> means;
  means.reserve(rests.size());
  for (const std::span<const double> rest : rests) {
    // Only differences are used: an offset of 33 000 counts would only cost digits.
    std::vector<double>& own = means.emplace_back(rest.begin(), rest.end());
    const double first = own.empty() ? 0.0 : own.front();
    for (double& value : own) value -= first;
  }
  Levels levels;
  for (double m = 1.0;; m *= 2.0) {
    double squares = 0.0, pairs = 0.0;
    for (std::vector<double>& own : means) halve(own, squares, pairs);
    if (pairs == 0.0) return levels;
    levels.push_back({m, squares / pairs, pairs});
  }
}

double DwellNoise::variance_of_mean(std::size_t samples) const {
  const auto m = static_cast<double>(samples);
  return white / m + flicker + random_walk * m + rounding;
}

DwellNoise fit_dwell_noise(View<AllanLevel> levels, double dwell, double lsb) {
  DwellNoise out;
  if (levels.empty()) return out;
  out.rounding = rounding_variance(levels.front(), lsb);
  const bool silent =
      std::ranges::all_of(levels, [](const AllanLevel& l) { return l.variance == 0.0; });
  if (silent) {
    // Only the quantisation is known, and exactly.
    out.dof = out.rounding > 0.0 ? levels.front().pairs : 0.0;
    return out;
  }
  const Averaged fit = averaged(Levels(levels.begin(), levels.end()), dwell);
  out.white = fit.x(0);
  out.flicker = fit.x(1);
  out.random_walk = fit.x(2);
  out.dof = fit.dof;
  return out;
}

DwellNoise fit_dwell_noise(const std::vector<std::span<const double>>& rests, double lsb) {
  const Levels levels = allan_levels(rests);
  if (levels.empty()) return {};
  std::vector<std::size_t> dwell;
  dwell.reserve(rests.size());
  for (const std::span<const double> rest : rests) dwell.push_back(rest.size());
  std::ranges::nth_element(dwell, dwell.begin() + static_cast<std::ptrdiff_t>(dwell.size() / 2));
  return fit_dwell_noise(levels, static_cast<double>(dwell[dwell.size() / 2]), lsb);
}

}  // namespace proofmass::calibrate
