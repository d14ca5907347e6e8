#include "proofmass/signal/channel_audit.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "proofmass/core/statistics.hpp"
#include "proofmass/signal/audit/subsample.hpp"

namespace proofmass::signal {
namespace {

/// A difference between adjacent distinct values, weighted by the number of occurrences of the
/// rarer one: a single off-grid value has little weight.
struct Difference {
  double size = 0.0;
  double weight = 0.0;
};

std::vector<Difference> differences_of(View<double> sorted) {
  std::vector<Difference> out;
  double last_count = 0.0;
  for (std::size_t k = 0; k < sorted.size();) {
    std::size_t end = k + 1;
    while (end < sorted.size() && sorted[end] == sorted[k]) ++end;
    const auto count = static_cast<double>(end - k);
    if (k > 0) out.push_back({sorted[k] - sorted[k - 1], std::min(count, last_count)});
    last_count = count;
    k = end;
  }
  return out;
}

/// A step, and the weighted fraction of the differences that are whole multiples of it to within 15
/// %.
struct GridFit {
  double step = 0.0;
  double on_grid = 0.0;
};

/// Refines an approximate step: the sum of the differences over the sum of their multiples.
GridFit fit_grid(const std::vector<Difference>& differences, double step) {
  GridFit fit{step, 0.0};
  for (int pass = 0; pass < 2; ++pass) {
    double sum = 0.0;
    double multiples = 0.0;
    double on_grid = 0.0;
    double all = 0.0;
    for (const auto& [size, weight] : differences) {
      all += weight;
      const double n = std::round(size / fit.step);
      if (n < 1.0 || std::abs(size / fit.step - n) > 0.15) continue;
      on_grid += weight;
      // Large differences carry little information while the step is inaccurate.
      if (n > 4.0) continue;
      sum += weight * size;
      multiples += weight * n;
    }
    fit.on_grid = on_grid / all;
    if (multiples > 0.0) fit.step = sum / multiples;
  }
  return fit;
}

/// Number of distinct values, by open addressing, which is faster than sorting them.
std::size_t count_distinct(View<double> values) {
  const std::size_t size = std::bit_ceil(2 * values.size());
  const int unused_bits = 64 - std::countr_zero(size);
  std::vector<double> table(size, no_value);
  std::size_t count = 0;
  for (const double value : values) {
    const double key = value + 0.0;  // −0 is 0
    constexpr std::uint64_t golden = 0x9e3779b97f4a7c15;
    std::size_t at = std::bit_cast<std::uint64_t>(key) * golden >> unused_bits;
    while (table[at] != key && !std::isnan(table[at])) at = (at + 1) % size;
    if (table[at] == key) continue;
    table[at] = key;
    ++count;
  }
  return count;
}

}  // namespace

std::optional<double> find_lsb_of_plausible(std::vector<double> values) {
  if (values.size() < 2 || count_distinct(values) * 2 > values.size()) return std::nullopt;
  std::ranges::sort(values);
  const std::vector<Difference> differences = differences_of(values);
  if (differences.empty()) return std::nullopt;
  std::vector<double> sizes;
  sizes.reserve(differences.size());
  for (const Difference& difference : differences) sizes.push_back(difference.size);
  std::ranges::sort(sizes);
  // The smallest difference is the step unless a few values are off the grid: then try higher
  // quantiles.
  for (const double p : {0.0, 0.01, 0.05, 0.25, 0.5}) {
    const auto at = static_cast<std::size_t>(p * static_cast<double>(sizes.size() - 1));
    const GridFit fit = fit_grid(differences, sizes[at]);
    if (fit.on_grid >= 0.98) return fit.step;
  }
  return std::nullopt;
}

std::optional<double> find_lsb(View<double> series) {
  Subsample sample;
  std::vector<double> plausible;
  constexpr std::size_t piece = 4096;
  for (std::size_t from = 0; from < series.size(); from += piece) {
    plausible.clear();
    std::ranges::copy_if(series.subspan(from, std::min(piece, series.size() - from)),
                         std::back_inserter(plausible), is_plausible);
    sample.add(plausible);
  }
  return find_lsb_of_plausible(std::move(sample).values());
}

}  // namespace proofmass::signal
