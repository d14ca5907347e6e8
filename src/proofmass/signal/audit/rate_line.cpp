#include "proofmass/signal/audit/rate_line.hpp"

#include <algorithm>
#include <cmath>

#include "proofmass/core/chi_square.hpp"
#include "proofmass/core/statistics.hpp"

namespace proofmass::signal {
namespace {

constexpr std::size_t most_blocks = 256;

/// Factor of the slope's standard deviation for the bias and the scatter of its variance, which is
/// estimated with Bartlett weights over `lags` lags of n residuals, evenly spaced over x in (−1,
/// 1).
///
/// - Bias: residuals have the covariance σ²(δ_ij − (1 + 3 x_i x_j)/n). In the sum over the lags,
///   with weights x², this removes the fraction 2.8 lags/n of the variance.
/// - Scatter: the weights x² reduce the number of residuals to 5n/9, and the estimate has
///   3/2 · 5n/9 / lags degrees of freedom (M. B. Priestley, Spectral Analysis and Time Series
///   (1981), 6.2.4, at zero frequency): Student's t in place of the normal distribution.
double inflation_of(std::size_t residuals, std::size_t lags) {
  const double per_lag = static_cast<double>(residuals) / static_cast<double>(lags);
  constexpr double tail = 0.975, normal = 1.959963984540054;
  return std::sqrt(per_lag / (per_lag - 2.8)) * student_t_quantile(tail, per_lag * 5.0 / 6.0) /
         normal;
}

}  // namespace

void RateLine::add_to(Block& block, const Block& more) {
  const double count = block.count + more.count;
  block.number += (more.number - block.number) * more.count / count;
  block.stamp_s += (more.stamp_s - block.stamp_s) * more.count / count;
  block.count = count;
}

void RateLine::add(double number, double stamp_s) {
  const Block one{1.0, number, stamp_s};
  if (!blocks_.empty() && blocks_.back().count < size_) return add_to(blocks_.back(), one);
  if (blocks_.size() == most_blocks) {
    for (std::size_t k = 0; k < most_blocks / 2; ++k) {
      blocks_[k] = blocks_[2 * k];
      add_to(blocks_[k], blocks_[2 * k + 1]);
    }
    blocks_.resize(most_blocks / 2);
    size_ *= 2.0;
  }
  blocks_.push_back(one);
}

std::optional<RateLine::Rate> RateLine::rate() const {
  constexpr std::size_t fewest = 16;
  if (blocks_.size() < fewest) return std::nullopt;
  double count = 0.0, number = 0.0, stamp_s = 0.0;
  for (const Block& block : blocks_) {
    count += block.count;
    number += block.count * block.number;
    stamp_s += block.count * block.stamp_s;
  }
  number /= count;
  stamp_s /= count;
  double squares = 0.0, products = 0.0;
  for (const Block& block : blocks_) {
    squares += block.count * square(block.number - number);
    products += block.count * (block.number - number) * (block.stamp_s - stamp_s);
  }
  const double step_s = products / squares;
  if (!(step_s > 0.0)) return std::nullopt;
  std::vector<double> scores;
  for (const Block& block : blocks_) {
    const double from_middle = block.number - number;
    scores.push_back(block.count * from_middle * (block.stamp_s - stamp_s - step_s * from_middle));
  }
  const std::size_t alike = std::min<std::size_t>(8, scores.size() / 8);
  double variance = 0.0;
  for (std::size_t lag = 0; lag <= alike; ++lag) {
    double sum = 0.0;
    for (std::size_t k = lag; k < scores.size(); ++k) sum += scores[k] * scores[k - lag];
    const double weight = 1.0 - static_cast<double>(lag) / static_cast<double>(alike + 1);
    variance += (lag == 0 ? 1.0 : 2.0 * weight) * sum;
  }
  const double std_s = std::sqrt(std::max(0.0, variance)) / squares;
  const double inflation = inflation_of(blocks_.size(), alike + 1);
  return Rate{1.0 / step_s, inflation * std_s / square(step_s)};
}

}  // namespace proofmass::signal
