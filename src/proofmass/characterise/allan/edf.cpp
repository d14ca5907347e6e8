#include "proofmass/characterise/allan/edf.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <vector>

#include "proofmass/core/contract.hpp"

namespace proofmass::characterise {
namespace {

/// s_w is ± |t|^p, times ln|t| where α is odd.
struct PowerLaw {
  explicit PowerLaw(int alpha)
      : power(3 - alpha),
        sign(alpha == 0 || alpha == 1 || alpha == -3 || alpha == -4 ? 1.0 : -1.0),
        logarithmic(alpha % 2 != 0) {}
  int power;
  double sign;
  bool logarithmic;
};

/// |t|^p, p ≥ 0.
double power_of(double t, int p) {
  double result = 1.0;
  for (; p > 0; --p) result *= t;
  return result;
}

/// The derivative of even order n of s_w, at t > 0.
double derivative_of_s_w(const PowerLaw& law, double t, int n) {
  double factor = 1.0;    // d^n t^p = factor t^(p−n)
  double log_part = 0.0;  // d^n (t^p ln t) = (factor ln t + log_part) t^(p−n)
  for (int i = 0; i < n; ++i) {
    log_part = log_part * (law.power - i) + factor;
    factor *= law.power - i;
  }
  const double coefficient = law.logarithmic ? factor * std::log(t) + log_part : factor;
  return law.sign * coefficient * std::pow(t, law.power - n);
}

double s_w(const PowerLaw& law, double t) {
  t = std::abs(t);
  if (t == 0.0) return 0.0;
  return law.sign * power_of(t, law.power) * (law.logarithmic ? std::log(t) : 1.0);
}

double s_x(const PowerLaw& law, double t, double F) {
  t = std::abs(t);
  if (t * F < 100.0)
    return F * F * (2.0 * s_w(law, t) - s_w(law, t - 1.0 / F) - s_w(law, t + 1.0 / F));
  // The three terms would cancel: the series of their difference in 1/F instead.
  return -derivative_of_s_w(law, t, 2) - derivative_of_s_w(law, t, 4) / (12.0 * F * F);
}

/// ψ(k + 1/2) for k ≥ 0, by its series in 1/k.
/// Source: M. Abramowitz, I. A. Stegun, Handbook of Mathematical Functions (1964), 6.3.5
/// and 6.3.18.
double digamma_above_half(double k) {
  double steps = 0.0;
  for (; k < 12.0; k += 1.0) steps += 1.0 / (k + 0.5);
  const double u = 1.0 / (k * k);
  return std::log(k) + u * (1.0 / 24.0 - u * (7.0 / 960.0 - u * 31.0 / 8064.0)) - steps;
}

/// s_x, up to a factor, for the spectrum (2 sin(π f τ0))^−order from sample to sample, m samples to
/// a unit of t.
double s_x_sampled(int order, double t, double m) {
  t = std::abs(t);
  if (order == 0) return t * m < 0.25 ? 1.0 : 0.0;
  const bool odd = order % 2 != 0;
  double product = odd ? digamma_above_half(t * m) : t;
  for (int i = 1; 2 * i <= (odd ? order - 1 : order - 2); ++i) {
    const double root = (odd ? i - 0.5 : i) / m;
    product *= t * t - root * root;
  }
  return product;
}

/// s_x of one power law for these parameters.
struct PhaseCovariance {
  PhaseCovariance(const EdfCase& known, int alpha)
      : law(alpha),
        order(2 - alpha),
        m(static_cast<double>(known.m)),
        sampled(known.sampled),
        modified(known.modified) {}

  double operator()(double t) const {
    if (!sampled) return s_x(law, t, modified ? 1.0 : m);
    if (!modified) return s_x_sampled(order, t, m);
    const auto s_w = [&](double u) { return s_x_sampled(order + 2, u, m); };
    return 2.0 * s_w(t) - s_w(t - 1.0) - s_w(t + 1.0);
  }

  PowerLaw law;
  int order;
  double m;
  bool sampled, modified;
};

/// s_z for differences of order d.
double s_z(const PhaseCovariance& s_x_at, double t, int d) {
  double weight = 1.0;  // C(2d, d+k), from k = d down to 0
  double sum = 0.0;
  for (int k = d; k > 0; --k) {
    const double sign = k % 2 == 0 ? 1.0 : -1.0;
    sum += sign * weight * (s_x_at(t - k) + s_x_at(t + k));
    weight *= static_cast<double>(d + k) / (d - k + 1);
  }
  return sum + weight * s_x_at(t);
}

/// The number of terms, and of those that start within one τ.
struct Overlap {
  double terms;    ///< M
  double per_tau;  ///< S
};

/// 1 / Σ_{|j|≤J} (1 − |j|/M) ρ(j/S)² / M, the last pair by half.
template <class Correlation>
double edf_of(const Overlap& overlap, int d, Correlation correlation) {
  const auto [M, S] = overlap;
  const double J = std::min(M, std::ceil((d + 1) * S));
  const auto term = [&](double j) {
    const double rho = correlation(j / S);
    return (1.0 - j / M) * rho * rho;
  };
  double sum = 1.0 + term(J);
  for (double j = 1.0; j < J;) {
    // ρ has kinks at whole τ. Away from them it is smooth, and one lag represents its neighbours.
    const double tau_before = std::floor(j / S);
    const double to_kink = std::min(j - tau_before * S, (tau_before + 1.0) * S - j);
    const double block = std::min(1.0 + std::floor(to_kink / 16.0), J - j);
    sum += 2.0 * block * term(j + 0.5 * (block - 1.0));
    j += block;
  }
  return M / sum;
}

Overlap overlap_of(const EdfCase& known) {
  PM_EXPECTS(known.m >= 1 && known.stride >= 1 && known.d >= 1);
  const std::size_t order = static_cast<std::size_t>(known.d) + (known.modified ? 1 : 0);
  const std::size_t length = known.m * order + (known.modified ? 0 : 1);
  PM_EXPECTS(known.phase_points >= length);
  const std::size_t terms = 1 + (known.phase_points - length) / known.stride;
  return {static_cast<double>(terms),
          static_cast<double>(known.m) / static_cast<double>(known.stride)};
}

bool converges(int alpha, int d) {
  return alpha <= 2 && alpha >= -4 && alpha > 1 - 2 * d;
}

double total_edf(int alpha, double relative_tau) {
  constexpr std::array<double, 3> b = {1.50, 1.17, 0.93};  // α = 0, −1, −2
  constexpr std::array<double, 3> c = {0.0, 0.22, 0.36};
  const auto i = static_cast<std::size_t>(-std::min(alpha, 0));
  return b[i] / relative_tau - c[i];
}

double modified_total_edf(int alpha, double relative_tau) {
  constexpr std::array<double, 5> b = {1.90, 1.20, 1.10, 0.85, 0.75};  // α = 2 … −2
  constexpr std::array<double, 5> c = {2.10, 1.40, 1.20, 0.50, 0.31};
  const auto i = static_cast<std::size_t>(2 - alpha);
  return b[i] / relative_tau - c[i];
}

double hadamard_total_edf(int alpha, double relative_tau) {
  constexpr std::array<double, 5> b0 = {0.559, 0.868, 0.938, 0.974, 1.276};  // α = 0 … −4
  constexpr std::array<double, 5> b1 = {1.004, 1.140, 1.696, 2.554, 3.149};
  const auto i = static_cast<std::size_t>(-alpha);
  return 1.0 / (relative_tau * (b0[i] + b1[i] * relative_tau));
}

/// N phase points, r = 0.75 m.
double theo1_edf(int alpha, double N, double r) {
  switch (alpha) {
    case 2:
      return 0.86 * (N + 1.0) * (N - 4.0 / 3.0 * r) / (N - r) * (r / (r + 1.14));
    case 1:
      return (4.798 * N * N - 6.374 * N * r + 12.387 * r) / (std::sqrt(r + 36.6) * (N - r)) *
             (r / (r + 0.3));
    case 0:
      return ((4.1 * N + 0.8) / r - (3.1 * N + 6.5) / N) *
             (r * std::sqrt(r) / (r * std::sqrt(r) + 5.2));
    case -1:
      return (2.0 * N * N - 1.3 * N * r - 3.5 * r) / (N * r) * (r * r * r / (r * r * r + 2.3));
    default: {
      const double n = 4.4 * N - 1.0;
      return (4.4 * N - 2.0) / (2.9 * r) * (n * n - 8.6 * r * n + 11.4 * r * r) /
             ((4.4 * N - 3.0) * (4.4 * N - 3.0));
    }
  }
}

/// The autocorrelation of the weights of a parabolic-variance term on 2m phases, at lags 0 … 2m −
/// 1.
std::vector<double> parabolic_kernel(std::size_t m) {
  std::vector<double> weights(2 * m);
  for (std::size_t k = 0; k < m; ++k) {
    weights[k] = 0.5 * static_cast<double>(m - 1) - static_cast<double>(k);
    weights[k + m] = -weights[k];
  }
  std::vector<double> kernel(2 * m);
  for (std::size_t lag = 0; lag < 2 * m; ++lag)
    kernel[lag] = std::inner_product(weights.begin() + static_cast<std::ptrdiff_t>(lag),
                                     weights.end(), weights.begin(), 0.0);
  return kernel;
}

double parabolic_edf(int alpha, std::size_t m, std::size_t phase_points) {
  PM_EXPECTS(phase_points > 2 * m);
  if (m == 1) return greenhall_riley_edf({.alpha = alpha, .m = 1, .phase_points = phase_points});
  // Coarser sampling hardly changes ρ(t) beyond some dozens per τ.
  const std::size_t points_per_tau = std::min<std::size_t>(m, 48);
  const auto F = static_cast<double>(points_per_tau);
  const double scale = F / static_cast<double>(m);
  const Overlap overlap{
      std::max(1.0, std::floor(static_cast<double>(phase_points - 2 * m) * scale)), F};
  const std::vector<double> kernel = parabolic_kernel(points_per_tau);
  const auto reach = static_cast<int>(kernel.size());
  const PowerLaw law(alpha);
  std::vector<double> phase_covariance(5 * points_per_tau + 2);
  for (std::size_t lag = 0; lag < phase_covariance.size(); ++lag)
    phase_covariance[lag] = s_x(law, static_cast<double>(lag) / F, F);
  const auto covariance = [&](double t) {
    const auto lag = static_cast<int>(std::lround(t * F));
    double sum = 0.0;
    for (int k = 1 - reach; k < reach; ++k)
      sum += kernel[static_cast<std::size_t>(std::abs(k))] *
             phase_covariance[static_cast<std::size_t>(std::abs(lag + k))];
    return sum;
  };
  const double variance = covariance(0.0);
  return edf_of(overlap, 2, [&](double t) { return covariance(t) / variance; });
}

/// The differences squared by a statistic that does nothing else.
EdfCase differences_of(Statistic statistic, std::size_t m, std::size_t phase_points) {
  const bool plain = statistic == Statistic::adev || statistic == Statistic::hdev;
  return {.d = statistic == Statistic::hdev || statistic == Statistic::ohdev ? 3 : 2,
          .m = m,
          .phase_points = phase_points,
          .stride = plain ? m : 1,
          .modified = statistic == Statistic::mdev || statistic == Statistic::tdev};
}

/// The statistic whose edf is substituted outside the fit of a total one; otherwise itself.
Statistic stand_in(Statistic statistic, int alpha, std::size_t m) {
  switch (statistic) {
    case Statistic::totdev:
      return m == 1 ? Statistic::oadev : statistic;
    case Statistic::mtotdev:
    case Statistic::ttotdev:
      return m < 10 ? Statistic::mdev : statistic;
    case Statistic::htotdev:
      if (alpha <= 0 && m >= 16) return statistic;
      return alpha < -2 || m == 1 ? Statistic::ohdev : Statistic::oadev;
    default:
      return statistic;
  }
}

}  // namespace

double greenhall_riley_edf(const EdfCase& known) {
  PM_EXPECTS(converges(known.alpha, known.d));
  AlphaShares shares{};
  shares[static_cast<std::size_t>(2 - known.alpha)] = 1.0;
  return mixed_edf(known, shares);
}

double mixed_edf(const EdfCase& known, const AlphaShares& shares) {
  struct Part {
    PhaseCovariance covariance;
    double weight;  // share / s_z(0)
  };
  const Overlap overlap = overlap_of(known);
  const double total = std::accumulate(shares.begin(), shares.end(), 0.0);
  PM_EXPECTS(total > 0.0);
  std::vector<Part> parts;
  for (int alpha = 2; alpha >= -4; --alpha) {
    const double share = shares[static_cast<std::size_t>(2 - alpha)] / total;
    if (share == 0.0) continue;
    PM_EXPECTS(share > 0.0 && converges(alpha, known.d));
    const PhaseCovariance covariance(known, alpha);
    parts.push_back({covariance, share / s_z(covariance, 0.0, known.d)});
  }
  return edf_of(overlap, known.d, [&](double t) {
    double rho = 0.0;
    for (const Part& part : parts) rho += part.weight * s_z(part.covariance, t, known.d);
    return rho;
  });
}

int lowest_alpha(Statistic statistic) {
  const bool hadamard = statistic == Statistic::hdev || statistic == Statistic::ohdev ||
                        statistic == Statistic::htotdev;
  return hadamard ? -4 : -2;
}

double edf(Statistic statistic, int alpha, std::size_t m, std::size_t phase_points) {
  PM_EXPECTS(alpha <= 2 && alpha >= lowest_alpha(statistic));
  PM_EXPECTS(m >= 1 && phase_points > m);
  const auto N = static_cast<double>(phase_points);
  const double relative_tau = static_cast<double>(m) / N;
  statistic = stand_in(statistic, alpha, m);
  switch (statistic) {
    case Statistic::totdev:
      return std::max(1.0, total_edf(alpha, relative_tau));
    case Statistic::mtotdev:
    case Statistic::ttotdev:
      return std::max(1.0, modified_total_edf(alpha, relative_tau));
    case Statistic::htotdev:
      return std::max(1.0, hadamard_total_edf(alpha, relative_tau));
    case Statistic::theo1:
      return std::max(1.0, theo1_edf(alpha, N, 0.75 * static_cast<double>(m)));
    case Statistic::pdev:
      return parabolic_edf(alpha, m, phase_points);
    default: {
      EdfCase known = differences_of(statistic, m, phase_points);
      known.alpha = alpha;
      return greenhall_riley_edf(known);
    }
  }
}

}  // namespace proofmass::characterise
