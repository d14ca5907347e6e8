#include "proofmass/characterise/allan/deviation_bias.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "proofmass/core/contract.hpp"

namespace proofmass::characterise {
namespace {

double total_bias(int alpha, double tau_per_T) {
  if (alpha == -1) return 1.0 - tau_per_T / (3.0 * std::numbers::ln2);
  if (alpha == -2) return 1.0 - 0.75 * tau_per_T;
  // 2 m of the differences extend beyond the ends, where a point counts twice: for white phase
  // noise their variance is 10 instead of 6.
  if (alpha == 2) return 1.0 + 4.0 / 3.0 * tau_per_T;
  if (alpha == 1) return 1.0 + 0.87 * tau_per_T;
  return 1.0;
}

double modified_total_bias(int alpha) {
  constexpr std::array<double, 5> bias = {0.94, 0.83, 0.73, 0.70, 0.69};  // α = 2 … −2
  return alpha < -2 ? 1.0 : bias[static_cast<std::size_t>(2 - alpha)];
}

double hadamard_total_bias(int alpha, std::size_t m) {
  constexpr std::array<double, 5> bias = {0.995, 0.851, 0.771, 0.717, 0.679};  // α = 0 … −4
  // At m = 1 the statistic is the overlapping Hadamard variance itself.
  if (m == 1) return 1.0;
  if (alpha == 2) return 1.385 - 0.28 / static_cast<double>(m);
  if (alpha == 1) return 1.25 - 0.25 / static_cast<double>(m);
  return bias[static_cast<std::size_t>(-alpha)];
}

// For white phase noise each of the m/2 terms has the variance 4/(m/2 − δ), the first 6/(m/2).
double theo1_bias_of_white_phase(std::size_t m) {
  double sum = 1.0 / static_cast<double>(m);
  for (std::size_t k = 1; k <= m / 2; ++k) sum += 1.0 / static_cast<double>(k);
  return sum;
}

double theo1_bias(int alpha, std::size_t m) {
  struct Fit {
    double a, b, c;
  };
  constexpr std::array<Fit, 4> fits = {{{0.14, 0.82, 0.30},  // α = 1
                                        {1.0, 0.0, 0.0},
                                        {1.87, -1.05, 0.79},
                                        {2.70, -1.53, 0.85}}};  // α = −2
  if (alpha < -2) return 1.0;
  if (alpha == 2) return theo1_bias_of_white_phase(m);
  const Fit& fit = fits[static_cast<std::size_t>(1 - alpha)];
  return 1.0 / (fit.a + fit.b / std::pow(static_cast<double>(m), fit.c));
}

}  // namespace

double variance_bias(Statistic statistic, int alpha, std::size_t m, std::size_t phase_points) {
  PM_EXPECTS(alpha >= -4 && alpha <= 2 && m >= 1 && m < phase_points);
  switch (statistic) {
    case Statistic::totdev:
      return total_bias(alpha, static_cast<double>(m) / static_cast<double>(phase_points - 1));
    case Statistic::mtotdev:
    case Statistic::ttotdev:
      return modified_total_bias(alpha);
    case Statistic::htotdev:
      return hadamard_total_bias(alpha, m);
    case Statistic::theo1:
      return theo1_bias(alpha, m);
    default:
      return 1.0;
  }
}

std::string bias_correction(Statistic statistic) {
  switch (statistic) {
    case Statistic::totdev:
      return "corrected for what reflecting the ends takes from the total variance in flicker and "
             "random-walk noise, up to three quarters of the share of the record that the "
             "averaging time is (NIST SP 1065), and adds in quantisation noise, up to 4/3 of it "
             "(computed)";
    case Statistic::mtotdev:
    case Statistic::ttotdev:
      return "corrected by the constant share of the modified Allan variance that the modified "
             "total variance reads, 0.69 to 0.94 by noise type (NIST SP 1065)";
    case Statistic::htotdev:
      return "corrected by the constant share of the Hadamard variance that the Hadamard total "
             "variance reads, 0.679 to 0.995 by noise type (NIST SP 1065), of quantisation noise "
             "1.1 "
             "to 1.4 (computed)";
    case Statistic::theo1:
      return "corrected to the Allan variance at 0.75 of the stride by noise type (NIST SP 1065)";
    default:
      return {};
  }
}

}  // namespace proofmass::characterise
