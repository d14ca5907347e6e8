#include "proofmass/characterise/runs/scatter.hpp"

#include <algorithm>
#include <array>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "proofmass/core/chi_square.hpp"
#include "proofmass/core/contract.hpp"
#include "proofmass/core/statistics.hpp"

namespace proofmass::characterise {
namespace {

// Nodes and weights of the mean over a standard normal variable, exact up to degree 13.
// M. Abramowitz, I. A. Stegun, Handbook of Mathematical Functions (1964), table 25.10.
struct Node {
  double at, weight;
};
constexpr std::array<Node, 7> normal_nodes{{{-3.750439717725742, 0.000548268855972},
                                            {-2.366759410734541, 0.030757123967586},
                                            {-1.154405394739968, 0.240123178605013},
                                            {0.0, 0.457142857142857},
                                            {1.154405394739968, 0.240123178605013},
                                            {2.366759410734541, 0.030757123967586},
                                            {3.750439717725742, 0.000548268855972}}};

// Probability of a larger sample variance if the runs differ by this variance.
double p_of(double between, double sample, double degrees, View<VarianceEstimate> within) {
  double p = 0.0;
  for (const VarianceEstimate& v : within) {
    if (!(v.value + between > 0.0)) return sample > 0.0 ? 0.0 : 1.0;
    const double relative = v.value > 0.0 ? v.std / v.value : 0.0;
    const double log_std = std::sqrt(std::log1p(relative * relative));
    for (const Node& node : normal_nodes) {
      const double total = v.value * std::exp(log_std * node.at) + between;
      p += v.weight * node.weight * chi_square_p(degrees * sample / total, degrees);
    }
  }
  return std::min(p, 1.0);
}

// The smallest variance between runs at which the p above reaches the given one.
double between_at(double p, double sample, double degrees, View<VarianceEstimate> within) {
  const auto reached = [&](double between) { return p_of(between, sample, degrees, within) >= p; };
  if (reached(0.0)) return 0.0;
  double below = 0.0, above = sample;
  while (!reached(above)) {
    below = above;
    above *= 4.0;
  }
  for (int round = 0; round < 100 && above - below > 1e-9 * above; ++round) {
    const double middle = 0.5 * (below + above);
    (reached(middle) ? above : below) = middle;
  }
  return 0.5 * (below + above);
}

}  // namespace

double mean_variance(View<VarianceEstimate> within) {
  double sum = 0.0;
  for (const VarianceEstimate& v : within) sum += v.weight * v.value;
  return sum;
}

RunScatter run_scatter(View<double> values, View<VarianceEstimate> within) {
  PM_EXPECTS(values.size() >= 3);
  const Moments m = moments(values);
  const double variance = mean_variance(within);
  const double sample = m.std() * m.std();
  const auto degrees = static_cast<double>(values.size() - 1);
  RunScatter scatter;
  scatter.mean = m.mean;
  scatter.mean_std = m.std() / std::sqrt(static_cast<double>(values.size()));
  scatter.observed_std = m.std();
  scatter.within_std = std::sqrt(variance);
  scatter.p = p_of(0.0, sample, degrees, within);
  const double lower = std::sqrt(between_at(0.025, sample, degrees, within));
  // Runs that agree better than their noise predicts do not prove that they are the same.
  const double upper = std::sqrt(between_at(0.975, std::max(sample, variance), degrees, within));
  scatter.between_std.value = std::sqrt(std::max(0.0, sample - variance));
  scatter.between_std.std = (upper - lower) / (2.0 * 1.959964);
  scatter.between_std.lower_95 = lower;
  scatter.between_std.upper_95 = upper;
  return scatter;
}

RunTrend run_trend(View<double> values) {
  PM_EXPECTS(values.size() >= 3);
  const Moments m = moments(values);
  const auto n = static_cast<double>(values.size());
  const double spread = n * (n * n - 1.0) / 12.0;
  double products = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i)
    products += (static_cast<double>(i) - 0.5 * (n - 1.0)) * (values[i] - m.mean);
  RunTrend trend;
  trend.per_run.value = products / spread;
  const double left = std::max(0.0, m.squares - products * trend.per_run.value);
  trend.per_run.std = std::sqrt(left / (n - 2.0) / spread);
  const double t = std::abs(trend.per_run.value) / trend.per_run.std;
  // An exact straight line has no scatter, and a constant neither slope nor scatter.
  if (!std::isfinite(t)) {
    trend.p = trend.per_run.value == 0.0 ? 1.0 : 0.0;
    return trend;
  }
  const boost::math::students_t distribution(n - 2.0);
  trend.p = 2.0 * boost::math::cdf(boost::math::complement(distribution, t));
  return trend;
}

}  // namespace proofmass::characterise
