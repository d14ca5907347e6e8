#include "proofmass/signal/rounding.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "proofmass/core/chi_square.hpp"
#include "proofmass/core/statistics.hpp"

namespace proofmass::signal {
namespace {

// Dither: causes of transitions between the codes of a converter.
struct Dither {
  double noise = 0.0;  ///< variance of its Gaussian part, steps²
  double sine = 0.0;   ///< amplitude of an additional sine, in steps
};

// From variance and fourth moment, corrected for quantisation (Sheppard): a sine of amplitude A has
// the fourth cumulant −3 A⁴/8, noise none. A sine counts if it is significant.
Dither dither_of(const std::vector<double>& values, double step) {
  const Moments all = moments(values);
  const double raw = square(all.std() / step), variance = std::max(0.0, raw - 1.0 / 12.0);
  double fourth = 0.0;
  for (const double value : values) fourth += square(square((value - all.mean) / step));
  const auto count = static_cast<double>(all.count);
  const double cumulant = fourth / count - raw / 2.0 + 7.0 / 240.0 - 3.0 * square(variance);
  Dither out{.noise = variance};
  if (cumulant > -2.0 * std::sqrt(24.0 / count) * square(variance)) return out;
  out.sine = std::pow(-8.0 / 3.0 * cumulant, 0.25);
  out.noise = std::max(0.0, variance - square(out.sine) / 2.0);
  return out;
}

// Between two codes: in steps, and the probit of the share of values below, with its weight.
struct Border {
  double at = 0.0, probit = 0.0, weight = 0.0;
};

std::vector<Border> borders_of(const std::vector<double>& ascending, double step) {
  std::vector<Border> borders;
  const auto count = static_cast<double>(ascending.size());
  for (std::size_t k = 1; k < ascending.size(); ++k) {
    if (ascending[k] < ascending[k - 1] + 0.5 * step) continue;
    const double below = static_cast<double>(k) / count, probit = normal_quantile(below);
    const double density = std::exp(-0.5 * square(probit)) / std::sqrt(2.0 * std::numbers::pi);
    borders.push_back({0.5 * (ascending[k - 1] + ascending[k]) / step, probit,
                       count * square(density) / (below * (1.0 - below))});
  }
  return borders;
}

// Standard deviation of Gaussian noise in steps, less two of its own, from the codes alone: the
// probits are linear in the border, with the slope 1/σ. (The variance of values of two or three
// codes depends on their position more than on the noise.) 0 for a single border.
double noise_of_codes(const std::vector<double>& ascending, double step) {
  const std::vector<Border> borders = borders_of(ascending, step);
  double weights = 0.0, mean = 0.0;
  for (const Border& border : borders) {
    weights += border.weight;
    mean += border.weight * border.at;
  }
  mean /= weights;
  double squares = 0.0, products = 0.0;
  for (const Border& border : borders) {
    squares += border.weight * square(border.at - mean);
    products += border.weight * (border.at - mean) * border.probit;
  }
  if (borders.size() < 2 || !(products > 0.0)) return 0.0;
  return 1.0 / (products / squares + 2.0 / std::sqrt(squares));
}

}  // namespace

double rounding_variance(std::vector<double> values, double step) {
  if (!(step > 0.0) || values.empty()) return 0.0;
  const double hidden = step * step / 12.0;
  Dither dither = dither_of(values, step);
  std::ranges::sort(values);
  // If nearly all values have two codes, noise far below the step may cross their border.
  constexpr double nearly_all = 0.998;
  std::size_t most = 0;
  for (std::size_t first = 0, end = 0; first < values.size(); ++first) {
    while (end < values.size() && values[end] < values[first] + 1.5 * step) ++end;
    most = std::max(most, end - first);
  }
  const bool two_codes =
      static_cast<double>(most) >= nearly_all * static_cast<double>(values.size());
  if (two_codes || dither.noise + dither.sine <= 0.0) return hidden;
  constexpr double enough = 1.0;  // steps²: nothing is left of the error
  if (dither.sine == 0.0 && dither.noise < enough)
    dither.noise = std::min(dither.noise, square(noise_of_codes(values, step)));
  constexpr double pi = std::numbers::pi;
  const double left = std::min(1.0, 1.0 / (pi * pi * dither.sine));
  return std::min(hidden, square(step / pi) / 2.0 * left * std::exp(-4.0 * pi * pi * dither.noise));
}

}  // namespace proofmass::signal
