#include "proofmass/signal/resample/sinc_kernel.hpp"

#include <numbers>

#include "proofmass/core/contract.hpp"

namespace proofmass::signal {
namespace {

constexpr double kaiser_beta = 8.0;
constexpr std::size_t entries_a_zero = 4096;

/// Modified Bessel function of order 0 by its power series, which converges for all x.
double bessel_i0(double x) {
  const double quarter = 0.25 * x * x;
  double term = 1.0;
  double sum = 1.0;
  for (double n = 1.0; term > 1e-17 * sum; n += 1.0) {
    term *= quarter / (n * n);
    sum += term;
  }
  return sum;
}

double sinc(double x) {
  const double angle = std::numbers::pi * x;
  return x == 0.0 ? 1.0 : std::sin(angle) / angle;
}

}  // namespace

SincKernel::SincKernel(double cutoff)
    : half_width_(static_cast<double>(zeros) / cutoff),
      per_sample_(static_cast<double>(entries_a_zero) * cutoff) {
  PM_EXPECTS(cutoff > 0.0 && cutoff <= 1.0);
  constexpr std::size_t count = zeros * entries_a_zero;
  table_.reserve(count + 1);
  const double full = bessel_i0(kaiser_beta);
  for (std::size_t i = 0; i < count; ++i) {
    const double x = static_cast<double>(i) / static_cast<double>(entries_a_zero);
    const double edge = x / static_cast<double>(zeros);
    const double window = bessel_i0(kaiser_beta * std::sqrt(1.0 - edge * edge)) / full;
    // Exact zeros of the sinc: samples are reproduced exactly.
    const bool is_zero = i > 0 && i % entries_a_zero == 0;
    table_.push_back(is_zero ? 0.0 : cutoff * sinc(x) * window);
  }
  table_.push_back(0.0);
}

}  // namespace proofmass::signal
