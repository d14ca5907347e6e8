#include "proofmass/calibrate/slow_noise.hpp"

#include <cmath>
#include <numbers>

namespace proofmass::calibrate {
namespace {

// The kernel integrated twice.
double twice_integrated(double x, SlowNoise noise) {
  const double size = std::abs(x);
  if (size == 0.0) return 0.0;
  if (noise == SlowNoise::random_walk) return -size * size * size / 4.0;
  return -size * size * (0.5 * std::log(size) - 0.75) / (2.0 * std::numbers::ln2);
}

double mean_kernel(const Span& a, const Span& b, SlowNoise noise) {
  const double sum =
      twice_integrated(b.end - a.start, noise) - twice_integrated(b.end - a.end, noise) -
      twice_integrated(b.start - a.start, noise) + twice_integrated(b.start - a.end, noise);
  return sum / (a.length() * b.length());
}

}  // namespace

Eigen::MatrixXd slow_noise_covariance(View<Span> spans, const Span& whole, SlowNoise noise) {
  const auto n = static_cast<Eigen::Index>(spans.size());
  const auto span = [&](Eigen::Index k) { return spans[static_cast<std::size_t>(k)]; };
  const double all = mean_kernel(whole, whole, noise);
  Eigen::VectorXd with_all(n);
  for (Eigen::Index k = 0; k < n; ++k) with_all(k) = mean_kernel(span(k), whole, noise);
  Eigen::MatrixXd C(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j <= i; ++j)
      C(i, j) = C(j, i) = mean_kernel(span(i), span(j), noise) - with_all(i) - with_all(j) + all;
  return C;
}

}  // namespace proofmass::calibrate
