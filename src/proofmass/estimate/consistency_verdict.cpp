#include "proofmass/estimate/consistency_verdict.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "proofmass/core/chi_square.hpp"

namespace proofmass::estimate {
namespace {

constexpr std::size_t fewest = 20;
/// Factors on the standard deviation for which a 95 % band has a coverage of 97 % and 93 %.
constexpr double band_holds_97 = 0.9032, band_holds_93 = 1.0817;
/// Sums over stretches that are too large, or too small, by a quarter.
constexpr double too_far = 1.25;
/// Small sums matter only below this factor f: a filter on a random walk then has √((f + 1/f)/2)
/// times the optimal error, within its stated uncertainty.
constexpr double far_behind = 1.0 / 3.0;
constexpr double too_correlated = 0.2;
/// Fraction of rejected measurements that no noise explains.
constexpr double too_many_gated = 0.05;

/// P(|N(0, 1)| < x).
double share_within(double x) {
  return std::erf(x / std::numbers::sqrt2);
}

/// Mean square of N(0, 1) within ± x.
double mean_square_within(double x) {
  if (x < 1e-3) return x * x / 3.0;
  const double density = std::exp(-0.5 * x * x) / std::sqrt(2.0 * std::numbers::pi);
  return 1.0 - 2.0 * x * density / share_within(x);
}

/// True if the ratio ~ χ²(dof)/dof differs significantly from 1.
bool significant(double ratio, double dof, double level) {
  return ratio > chi_square_quantile(1.0 - 0.5 * level, dof) / dof ||
         ratio < chi_square_quantile(0.5 * level, dof) / dof;
}

/// Logarithm of the ratio of true to stated standard deviation; 0 if not significant.
double size_error(const ChannelConsistency& figures, double level) {
  const double s = *figures.std_factor;
  if (s > band_holds_97 && s < band_holds_93) return 0.0;
  // Effective number of squares of a first-order correlated series: n (1 − ρ²)/(1 + ρ²).
  const double rho2 = std::min(std::pow(figures.lag_one.value_or(0.0), 2), 0.99);
  const double dof = static_cast<double>(figures.innovations) * (1.0 - rho2) / (1.0 + rho2);
  return significant(s * s, dof, level) ? std::log(std::max(s, 1e-9)) : 0.0;
}

struct Colour {
  double log_factor = 0.0;  ///< positive: sums are too large
  bool slow = false;        ///< not visible between neighbours
  bool matters = false;
};

/// The stretches with the largest deviation of their sums, if it is significant.
Colour colour_of(const ChannelConsistency& figures, double level) {
  level /= static_cast<double>(1 + figures.stretches.size());
  Colour found;
  const double rho = figures.lag_one.value_or(0.0);
  const bool neighbours_correlate =
      std::abs(rho) > figures.lag_one_bound / 1.96 * std::sqrt(chi_square_quantile(1.0 - level, 1));
  if (neighbours_correlate && std::abs(rho) > too_correlated)
    found.log_factor = 0.5 * std::log1p(rho);
  const auto n = static_cast<double>(figures.innovations);
  for (const StretchScatter& stretch : figures.stretches) {
    const auto count = static_cast<double>(stretch.stretches);
    const double dof = count * n / (n - count), size = std::log(std::max(stretch.factor, 1e-9));
    if (std::abs(size) < std::log(too_far) || std::abs(size) < std::abs(found.log_factor)) continue;
    if (significant(stretch.factor * stretch.factor, dof, level)) found.log_factor = size;
  }
  found.matters = found.log_factor > 0.0 || found.log_factor < std::log(far_behind) ||
                  (neighbours_correlate && rho < -too_correlated);
  found.slow = found.log_factor > 0.0 && (!neighbours_correlate || rho <= 0.5 * too_correlated);
  return found;
}

/// True if |ν| > 1.96 is much rarer than the mean square implies: a few outliers dominate it.
bool few_carry_it(const ChannelConsistency& figures) {
  if (!figures.inside_95) return false;
  const double expected_outside = 1.0 - share_within(1.96 / *figures.std_factor);
  return 1.0 - *figures.inside_95 < 0.5 * expected_outside;
}

/// Sets which noise to change, with size = ln(s) and colour = ln(√V): the factor on √Q is √V s,
/// since it determines the change of the state over a stretch; the factor on √R is s.
void set_remedy(ChannelConsistency& figures, double size, const Colour& colour) {
  const double process = size + colour.log_factor;
  const auto move = [&](Remedy what, double log_factor) {
    figures.remedy = what;
    figures.remedy_factor = std::exp(log_factor);
  };
  if (size > 0.0 && few_carry_it(figures)) return move(Remedy::outliers, size);
  if (colour.log_factor == 0.0) return move(Remedy::both_noises, size);
  if (size != 0.0 && std::abs(process) < std::abs(size))
    return move(Remedy::measurement_noise, size);
  move(colour.slow ? Remedy::slow_noise : Remedy::process_noise, process);
}

}  // namespace

std::optional<double> ungated_std(double mean_square, double gate) {
  if (std::isinf(gate)) return std::sqrt(mean_square);
  constexpr double widest = 4.0;  // relative to the gate: m is then within 0.6 % of that of a
                                  // uniform distribution
  const auto seen = [&](double s) { return s * s * mean_square_within(gate / s); };
  double low = std::sqrt(mean_square), high = widest * gate;
  if (!(mean_square > 0.0)) return 0.0;
  if (seen(high) <= mean_square) return std::nullopt;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (seen(middle) < mean_square ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

void decide(ChannelConsistency& figures, double gate, std::size_t judged) {
  const std::size_t all = figures.innovations + figures.gated;
  if (all < fewest) return;
  const double left_out = static_cast<double>(figures.gated) / static_cast<double>(all);
  const double s = figures.std_factor.value_or(INFINITY);
  const double expected_out = std::isinf(gate) ? 0.0 : 1.0 - share_within(gate / s);
  if (!figures.std_factor || figures.innovations < fewest ||
      left_out - expected_out > too_many_gated) {
    figures.verdict = Verdict::overconfident;
    figures.remedy = Remedy::outliers;
    return;
  }
  // Test of magnitude, and of correlation in time.
  const double level = 0.05 / (2.0 * static_cast<double>(judged));
  const double size = size_error(figures, level);
  const Colour colour = colour_of(figures, level);
  figures.verdict = size > 0.0       ? Verdict::overconfident
                    : colour.matters ? Verdict::coloured
                    : size < 0.0     ? Verdict::cautious
                                     : Verdict::consistent;
  if (figures.verdict != Verdict::consistent) set_remedy(figures, size, colour);
}

}  // namespace proofmass::estimate
