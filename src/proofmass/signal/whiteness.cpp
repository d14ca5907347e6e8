#include "proofmass/signal/whiteness.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "proofmass/core/chi_square.hpp"
#include "proofmass/signal/spectrum/cumulative_periodogram.hpp"
#include "proofmass/signal/spectrum/lagged_products.hpp"

namespace proofmass::signal {
namespace {

constexpr std::size_t fewest_blocks = 20, fewest_blocks_of_a_scale = 30, most_lags = 1000;
constexpr double joint_level = 0.05, tests = 3.0;

ValidSum finite_sum(View<double> values) {
  const std::size_t whole = values.size() / lanes * lanes;
  ValidSum total = valid_sum(values.data(), whole);
  for (const double x : values.subspan(whole))
    if (std::isfinite(x)) {
      total.sum += x;
      total.count += 1.0;
    }
  return total;
}

std::vector<double> block_means(View<double> samples, std::size_t length) {
  std::vector<double> means(samples.size() / length);
  for (std::size_t block = 0; block < means.size(); ++block) {
    const ValidSum valid = finite_sum(samples.subspan(block * length, length));
    means[block] = 2.0 * valid.count > static_cast<double>(length)
                       ? valid.sum / valid.count
                       : std::numeric_limits<double>::quiet_NaN();
  }
  return means;
}

/// r of autocorrelation(), from lag 0.
std::vector<double> normalised(const LaggedProducts& products, std::size_t values) {
  const auto& [sums, pairs] = products;
  std::vector<double> r(sums.size(), 0.0);
  for (std::size_t k = 0; k < r.size(); ++k)
    if (pairs[k] > 0.0) {
      const double taper = 1.0 - static_cast<double>(k) / static_cast<double>(values);
      r[k] = taper * (sums[k] / pairs[k]) / (sums[0] / pairs[0]);
    }
  return r;
}

std::size_t lags_for(std::size_t values) {
  const auto root = static_cast<std::size_t>(std::sqrt(static_cast<double>(values)));
  return std::min(root, most_lags);
}

/// The autocorrelation, its bounds and Q. `length` includes the missing values.
void test_autocorrelation(const LaggedProducts& products,
                          std::size_t length,
                          std::size_t fitted_parameters,
                          WhitenessTest& test) {
  const std::vector<double> r = normalised(products, length);
  test.autocorrelation.assign(r.begin() + 1, r.end());
  const double present = products.pairs[0];
  double weighted = 0.0, inverse_taper = 0.0;
  for (std::size_t k = 1; k <= test.lags; ++k) {
    const double taper = 1.0 - static_cast<double>(k) / static_cast<double>(length);
    weighted += products.pairs[k] * std::pow(r[k] / taper, 2);
    inverse_taper += products.pairs[k] / taper;
  }
  // With gaps r scatters by 1/√pairs, and there are fewer pairs than values.
  test.bound = 1.96 / std::sqrt(inverse_taper / static_cast<double>(test.lags));
  const auto inside = std::ranges::count_if(
      test.autocorrelation, [&](double value) { return std::abs(value) <= test.bound; });
  test.inside_bounds = static_cast<double>(inside) / static_cast<double>(test.lags);
  test.ljung_box = (present + 2.0) / present * weighted;
  test.ljung_box_p =
      chi_square_p(test.ljung_box, static_cast<double>(test.lags - fitted_parameters));
}

/// The lower median, found among the values of its bin: a partial sort of a full copy takes several
/// times as long. Bins extend to four standard deviations on either side.
double lower_median(View<double> values, double mean, double std) {
  constexpr std::size_t bins = 4096;
  const auto bin = [=](double x) {
    const double place = ((x - mean) / std + 4.0) / 8.0 * bins;
    return static_cast<std::size_t>(std::clamp(place, 0.0, bins - 1.0));
  };
  std::vector<std::size_t> counts(bins, 0);
  for (const double x : values) ++counts[bin(x)];
  std::size_t rank = (values.size() - 1) / 2, middle = 0;
  for (; rank >= counts[middle]; ++middle) rank -= counts[middle];
  std::vector<double> candidates;
  candidates.reserve(counts[middle]);
  std::ranges::copy_if(values, std::back_inserter(candidates),
                       [&](double x) { return bin(x) == middle; });
  const auto at = candidates.begin() + static_cast<std::ptrdiff_t>(rank);
  std::ranges::nth_element(candidates, at);
  return *at;
}

struct Dichotomy {
  double high = 0.0;  ///< values on the upper side
  double runs = 1.0;
};

template <class IsHigh>
Dichotomy dichotomy(View<double> values, IsHigh is_high) {
  std::size_t high = 0, changes = 0;
  bool before = is_high(values.front());
  for (const double x : values) {
    const bool now = is_high(x);
    high += now ? 1 : 0;
    changes += now != before ? 1 : 0;
    before = now;
  }
  return {static_cast<double>(high), static_cast<double>(changes + 1)};
}

void test_runs(View<double> values, double median, WhitenessTest& test) {
  const auto n = static_cast<double>(values.size());
  const Dichotomy above = dichotomy(values, [=](double x) { return x > median; });
  const Dichotomy not_below = dichotomy(values, [=](double x) { return x >= median; });
  const auto imbalance = [=](const Dichotomy& d) { return std::abs(2.0 * d.high - n); };
  const auto& [high, runs] = imbalance(not_below) < imbalance(above) ? not_below : above;
  const double mean = 1.0 + 2.0 * high * (n - high) / n;
  const double variance = (mean - 1.0) * (mean - 2.0) / (n - 1.0);
  // A single value on one side gives a constant number of runs.
  test.runs_z = variance > 0.0 ? (runs - mean) / std::sqrt(variance) : 0.0;
  test.runs_p = std::erfc(std::abs(test.runs_z) / std::numbers::sqrt2);
}

Result<WhitenessTest> test_series(View<double> series, double scale_s, std::size_t parameters) {
  const ValidSum valid = finite_sum(series);
  WhitenessTest test;
  test.scale_s = scale_s;
  test.values = static_cast<std::size_t>(valid.count);
  test.lags = lags_for(test.values);
  if (test.values < fewest_blocks)
    return Error{Errc::too_few_samples, "a test of whiteness needs at least 20 block means"};
  if (test.lags <= parameters)
    return Error{Errc::too_few_samples, "too few block means for that many fitted parameters"};

  const double mean = valid.sum / valid.count;
  const LaggedProducts products = lagged_products(series, mean, test.lags);
  const double std = std::sqrt(products.sums[0] / valid.count);
  // Rounding alone makes means of equal samples differ slightly.
  if (!(std > 1e-12 * std::abs(mean)))
    return Error{Errc::not_observable, "the block means are all equal"};
  if (!std::isfinite(std)) return Error{Errc::not_finite, "the squares of the residuals overflow"};
  test_autocorrelation(products, series.size(), parameters, test);

  std::vector<double> closed_up;
  if (test.values < series.size()) {
    std::ranges::copy_if(series, std::back_inserter(closed_up),
                         [](double x) { return std::isfinite(x); });
    series = closed_up;
  }
  const PeriodogramTest periodogram = test_cumulative_periodogram(series, mean);
  test.periodogram_excess = periodogram.excess;
  test.periodogram_p = periodogram.p;
  test_runs(series, lower_median(series, mean, std), test);
  test.white = std::min({test.ljung_box_p, test.periodogram_p, test.runs_p}) > joint_level / tests;
  return test;
}

}  // namespace

std::vector<double> autocorrelation(View<double> series, std::size_t lags) {
  const ValidSum valid = finite_sum(series);
  const LaggedProducts products = lagged_products(series, valid.sum / valid.count, lags);
  if (!(products.sums[0] > 0.0))
    return std::vector<double>(lags + 1, std::numeric_limits<double>::quiet_NaN());
  return normalised(products, series.size());
}

Result<WhitenessTest> test_whiteness(View<double> residuals, const WhitenessOptions& options) {
  if (!std::isfinite(options.rate_hz) || options.rate_hz <= 0.0)
    return Error{Errc::invalid_argument, "rate_hz must be positive and finite"};
  const double samples = std::round(options.scale_s * options.rate_hz);
  if (!(samples >= 1.0)) return Error{Errc::invalid_argument, "scale_s is shorter than a sample"};
  if (samples > static_cast<double>(residuals.size()))
    return Error{Errc::too_few_samples, "scale_s is longer than the residuals"};
  const auto length = static_cast<std::size_t>(samples);
  const double scale_s = samples / options.rate_hz;
  if (length == 1) return test_series(residuals, scale_s, options.fitted_parameters);
  return test_series(block_means(residuals, length), scale_s, options.fitted_parameters);
}

std::vector<WhitenessTest> test_whiteness_at_scales(View<double> residuals,
                                                    double rate_hz,
                                                    std::size_t fitted_parameters) {
  std::vector<WhitenessTest> scales;
  const auto add = [&](double scale_s) {
    const auto test = test_whiteness(residuals, {rate_hz, scale_s, fitted_parameters});
    if (test && test->values >= fewest_blocks_of_a_scale) scales.push_back(*test);
  };
  if (!std::isfinite(rate_hz) || rate_hz <= 0.0) return scales;
  add(1.0 / rate_hz);
  const auto samples = static_cast<double>(residuals.size());
  for (double scale_s = 1.0; samples >= fewest_blocks_of_a_scale * std::round(scale_s * rate_hz);
       scale_s *= 10.0)
    if (std::round(scale_s * rate_hz) >= 2.0) add(scale_s);
  return scales;
}

}  // namespace proofmass::signal
