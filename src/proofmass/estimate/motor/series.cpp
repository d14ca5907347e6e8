#include "proofmass/estimate/motor/series.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "proofmass/core/statistics.hpp"

namespace proofmass::estimate::motor {
namespace {

constexpr double window_s = 0.1;         // of the parabola
constexpr double least_share = 0.01;     // rest below this share of the top speed
constexpr double noise_factor = 4.0;     // and below this many standard deviations

// Slope of the parabola through ± half samples; shorter at the ends.
std::vector<double> slopes(const std::vector<double>& y, double step_s, std::size_t half) {
  const std::size_t n = y.size();
  std::vector<double> out(n, 0.0);
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t h = std::min({half, std::max<std::size_t>(k, 1), n - 1 - k > 0 ? n - 1 - k : 1});
    double sum = 0.0, squares = 0.0;
    for (std::size_t j = 1; j <= h; ++j) {
      const double up = y[std::min(k + j, n - 1)], down = y[k >= j ? k - j : 0];
      const double span = static_cast<double>(std::min(k + j, n - 1) - (k >= j ? k - j : 0));
      sum += static_cast<double>(j) * (up - down) * (2.0 * static_cast<double>(j) / span);
      squares += 2.0 * static_cast<double>(j * j);
    }
    out[k] = sum / (squares * step_s);
  }
  return out;
}

std::vector<double> means(const std::vector<double>& y, std::size_t half) {
  std::vector<double> out;
  for (std::size_t k = 0; k < y.size(); ++k) {
    const std::size_t h = std::min({half, k, y.size() - 1 - k});
    double sum = 0.0;
    for (std::size_t j = k - h; j <= k + h; ++j) sum += y[j];
    out.push_back(sum / static_cast<double>(2 * h + 1));
  }
  return out;
}

}  // namespace

double sample_noise(const std::vector<double>& values) {
  std::vector<double> thirds;
  for (std::size_t k = 3; k < values.size(); ++k)
    thirds.push_back(values[k] - 3.0 * values[k - 1] + 3.0 * values[k - 2] - values[k - 3]);
  return robust_std(thirds).value_or(0.0) / std::sqrt(20.0);
}

void set_motion(const Series& series,
                std::vector<double> angle_rad,
                std::vector<double> speed_radps,
                std::size_t margin,
                Regimes& regimes) {
  const std::size_t n = series.size();
  regimes.angle_rad = std::move(angle_rad);
  regimes.speed_radps = std::move(speed_radps);
  regimes.accel_radps2 = slopes(regimes.speed_radps, series.step_s, 2);
  regimes.rests.assign(n, 0);
  for (std::size_t k = 0; k + 1 < n; ++k) {
    const double a = regimes.speed_radps[k], b = regimes.speed_radps[k + 1];
    const bool slow = std::min(std::abs(a), std::abs(b)) < regimes.rest_radps;
    if (!slow && a * b > 0.0) continue;
    for (std::size_t j = k > margin ? k - margin : 0; j <= std::min(k + margin, n - 1); ++j)
      regimes.rests[j] = 1;
  }
}

void contact_by_direction(const Series& series, double margin_s, Regimes& regimes) {
  const std::size_t n = series.size();
  const auto margin = static_cast<std::size_t>(std::ceil(margin_s / series.step_s));
  regimes.contact.assign(n, 0);
  std::size_t since = margin;
  for (std::size_t k = 0; k < n; ++k) {
    since = regimes.rests[k] != 0 ? 0 : since + 1;
    if (since < margin) continue;
    regimes.contact[k] = regimes.speed_radps[k] > 0.0 ? std::int8_t{1} : std::int8_t{-1};
  }
}

Regimes first_regimes(const Series& series) {
  Regimes regimes;
  const auto half = std::max<std::size_t>(
      2, static_cast<std::size_t>(std::lround(0.5 * window_s / series.step_s)));
  std::vector<double> speed = slopes(series.angle_rad, series.step_s, half);
  double squares = 0.0;
  for (std::size_t j = 1; j <= half; ++j) squares += 2.0 * static_cast<double>(j * j);
  regimes.speed_std_radps = sample_noise(series.angle_rad) / (series.step_s * std::sqrt(squares));
  double top = 0.0;
  for (const double w : speed) top = std::max(top, std::abs(w));
  regimes.rest_radps = std::max(noise_factor * regimes.speed_std_radps, least_share * top);
  set_motion(series, means(series.angle_rad, half), std::move(speed), half, regimes);
  contact_by_direction(series, window_s, regimes);
  regimes.current_sign.assign(series.size(), 0.0);
  double largest = 0.0;
  for (const double i : series.current_a) largest = std::max(largest, std::abs(i));
  if (largest > 0.0)
    for (std::size_t k = 0; k < series.size(); ++k)
      regimes.current_sign[k] = std::tanh(series.current_a[k] / (0.02 * largest));
  return regimes;
}

}  // namespace proofmass::estimate::motor
