#include "proofmass/characterise/stationarity.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <numbers>

#include "proofmass/characterise/noise_model.hpp"
#include "proofmass/core/chi_square.hpp"
#include "proofmass/core/statistics.hpp"

namespace proofmass::characterise {
namespace {

constexpr std::size_t most_spans = 128;
constexpr std::size_t fewest_coefficients = 32, fewest_spans_of_part = 4;
constexpr std::array<std::size_t, 5> partitions{2, 4, 8, 16, 32};
constexpr std::size_t longest_line_block = 4096;
constexpr double significant_p = 0.005;

// Correlation of neighbours among the spans, about the mean of four; −1/4 of independent ones.
double neighbour_correlation(const std::vector<double>& spans) {
  double products = 0.0, squares = 0.0;
  for (std::size_t s = 0; s + 4 <= spans.size(); s += 4) {
    const double mean = 0.25 * (spans[s] + spans[s + 1] + spans[s + 2] + spans[s + 3]);
    if (std::isnan(mean)) continue;
    for (std::size_t k = s; k < s + 4; ++k) squares += square(spans[k] - mean);
    for (std::size_t k = s; k < s + 3; ++k) products += (spans[k] - mean) * (spans[k + 1] - mean);
  }
  return squares > 0.0 ? products / squares : 0.0;
}

// Means over equal spans of time of coefficients in order, NaN where one has none.
std::vector<double> means_over(std::size_t spans, const std::vector<double>& coefficients) {
  std::vector<double> sums(spans, 0.0), counts(spans, 0.0);
  for (std::size_t k = 0; k < coefficients.size(); ++k) {
    if (std::isnan(coefficients[k])) continue;
    const std::size_t span = k * spans / coefficients.size();
    sums[span] += coefficients[k];
    counts[span] += 1.0;
  }
  for (std::size_t s = 0; s < spans; ++s) sums[s] /= counts[s];
  return sums;
}

// As many spans as are independent: noise far slower than the samples, behind a filter of several
// poles, is correlated from one short span to the next.
std::vector<double> span_means(const std::vector<double>& coefficients) {
  constexpr double uncorrelated = 0.0;
  std::size_t spans = std::min(most_spans, coefficients.size());
  std::vector<double> means = means_over(spans, coefficients);
  while (spans > 2 * fewest_spans_of_part && neighbour_correlation(means) > uncorrelated) {
    spans /= 2;
    means = means_over(spans, coefficients);
  }
  return means;
}

// One level over the recording.
struct Band {
  double averaging_s = 0.0;
  std::optional<double> line_hz;
  std::vector<double> spans;
};

struct Parts {
  double p = 1.0;
  double change = 0.0;  // of the level, relative, root mean square beyond the scatter
  std::vector<double> means;
};

std::optional<Parts> compare_parts(const std::vector<double>& spans, std::size_t count) {
  if (spans.size() < fewest_spans_of_part * count) return std::nullopt;
  std::vector<Moments> parts(count);
  Moments all;
  for (std::size_t s = 0; s < spans.size(); ++s) {
    parts[s * count / spans.size()].add(spans[s]);
    all.add(spans[s]);
  }
  double within = 0.0, between = 0.0;
  for (const Moments& part : parts) {
    if (part.count < 2) return std::nullopt;
    within += part.squares;
    between += static_cast<double>(part.count) * square(part.mean - all.mean);
  }
  const auto dof_between = static_cast<double>(count - 1);
  const auto dof_within = static_cast<double>(all.count - count);
  if (!(within > 0.0) || !(all.mean > 0.0)) return std::nullopt;
  between /= dof_between;
  within /= dof_within;
  Parts found;
  found.p = fisher_f_p(between / within, dof_between, dof_within);
  const double each = static_cast<double>(all.count) / static_cast<double>(count);
  // A root of a level changes by half as much as the level.
  found.change = 2.0 * std::sqrt(std::max(0.0, between - within) / each) / all.mean;
  for (const Moments& part : parts) found.means.push_back(square(part.mean / all.mean));
  return found;
}

// Half the mean square of the differences that these are the roots of: their Allan variance.
double allan_variance_of(const std::vector<double>& roots) {
  Moments squares;
  for (const double root : roots) squares.add(square(square(root)));
  return 0.5 * squares.mean;
}

// A sine beats with the differences' own steps: where lines have a good part in the variance, they
// are tested in its place.
bool belongs_to_lines(double tau_s,
                      double allan_variance,
                      const std::vector<signal::SpectralLine>& lines) {
  constexpr double good_part = 0.1;
  double of_lines = 0.0;
  for (const signal::SpectralLine& line : lines)
    of_lines += sine_allan_variance(line.amplitude, line.frequency_hz, tau_s);
  return of_lines > good_part * allan_variance;
}

// The roots of neighbouring means' differences; the means of m are those of m/2 in pairs.
std::vector<Band> difference_bands(View<double> series,
                                   double rate_hz,
                                   const std::vector<signal::SpectralLine>& lines) {
  std::vector<Band> bands;
  std::vector<double> means(series.begin(), series.end());
  for (double m = 1.0; means.size() / 2 >= fewest_coefficients; m *= 2.0) {
    std::vector<double> roots(means.size() / 2);
    for (std::size_t k = 0; k < roots.size(); ++k) {
      const double one = means[2 * k], other = means[2 * k + 1];
      roots[k] = std::sqrt(std::abs(other - one));
      means[k] = 0.5 * (one + other);
    }
    means.resize(roots.size());
    if (!belongs_to_lines(m / rate_hz, allan_variance_of(roots), lines))
      bands.push_back({m / rate_hz, std::nullopt, span_means(roots)});
  }
  return bands;
}

// The root of the Hann-windowed Fourier coefficient of each block at the line's frequency.
std::optional<Band> line_band(View<double> series, double rate_hz, double line_hz) {
  constexpr double fewest_cycles = 4.0;
  const std::size_t length = std::min(longest_line_block, series.size() / (most_spans / 2));
  const auto n = static_cast<double>(length);
  if (line_hz * n / rate_hz < fewest_cycles) return std::nullopt;
  std::vector<std::complex<double>> wave(length);
  for (std::size_t k = 0; k < length; ++k) {
    const double at = static_cast<double>(k) + 0.5;
    const double window = square(std::sin(std::numbers::pi * at / n));
    wave[k] = std::polar(window, -2.0 * std::numbers::pi * line_hz / rate_hz * at);
  }
  std::vector<double> roots;
  for (std::size_t from = 0; from + length <= series.size(); from += length) {
    const View<double> block = series.subspan(from, length);
    const Moments moments = proofmass::moments(block);
    std::complex<double> sum = 0.0;
    for (std::size_t k = 0; k < length; ++k) sum += wave[k] * (block[k] - moments.mean);
    roots.push_back(moments.nonfinite > 0 ? no_value : std::sqrt(std::abs(sum)));
  }
  return Band{0.0, line_hz, span_means(roots)};
}

}  // namespace

Stationarity test_stationarity(View<double> series,
                               double rate_hz,
                               const std::vector<signal::SpectralLine>& lines) {
  std::vector<Band> bands = difference_bands(series, rate_hz, lines);
  for (const signal::SpectralLine& line : lines)
    if (auto band = line_band(series, rate_hz, line.frequency_hz))
      bands.push_back(std::move(*band));
  Stationarity result;
  double tests = 0.0, change = 0.0;
  for (const Band& band : bands) {
    for (const std::size_t count : partitions) {
      auto parts = compare_parts(band.spans, count);
      if (!parts) continue;
      tests += 1.0;
      if (result.tested && parts->p >= result.p) continue;
      result = {true, true, parts->p, band.averaging_s, band.line_hz, std::move(parts->means)};
      change = parts->change;
    }
  }
  result.p = std::min(1.0, tests * result.p);
  result.stationary = result.p >= significant_p || change < relevant_change;
  return result;
}

}  // namespace proofmass::characterise
