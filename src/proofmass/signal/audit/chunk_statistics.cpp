#include "proofmass/signal/audit/chunk_statistics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <numeric>

#include "proofmass/core/vector_clones.hpp"
#include "proofmass/signal/channel_audit.hpp"

namespace proofmass::signal {
namespace {

// Large enough for the compiler to keep the inner loop and vectorise it.
constexpr std::size_t lanes = 64;
using Lanes = std::array<double, lanes>;

double total(const Lanes& sums) {
  return std::accumulate(sums.begin(), sums.end(), 0.0);
}

// For short blocks.
constexpr std::size_t quad = 4;
using Quad [[gnu::vector_size(quad * sizeof(double))]] = double;

[[gnu::always_inline]] inline double total(const Quad& x) {
  return (x[0] + x[2]) + (x[1] + x[3]);
}

// 0 if is_plausible, else positive. Branch-free; every comparison with NaN is false.
[[gnu::always_inline]] inline double oddness(double value) {
  const double size = std::abs(value);
  const double small = size < least_normal ? 1.0 : 0.0, zero = size == 0.0 ? 1.0 : 0.0;
  return (size <= absurd_magnitude ? 0.0 : 1.0) + (small - zero);
}

}  // namespace

PM_VECTOR_CLONES
ChunkStatistics chunk_statistics(View<double> values) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  const double* x = values.data();
  Lanes sums{}, low, high, odd{};
  low.fill(inf);
  high.fill(-inf);
  std::size_t k = 0;
  for (; k + lanes <= values.size(); k += lanes) {
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const double value = x[k + lane];
      sums[lane] += value;
      low[lane] = value < low[lane] ? value : low[lane];
      high[lane] = value > high[lane] ? value : high[lane];
      odd[lane] += oddness(value);
    }
  }
  for (; k < values.size(); ++k) {
    sums[0] += x[k];
    low[0] = std::min(low[0], x[k]);
    high[0] = std::max(high[0], x[k]);
    odd[0] += oddness(x[k]);
  }
  return {.plausible = total(odd) == 0.0,
          .sum = total(sums),
          .min = *std::ranges::min_element(low),
          .max = *std::ranges::max_element(high)};
}

PM_VECTOR_CLONES
double squares_about(View<double> values, double mean) {
  const double* x = values.data();
  Lanes sums{};
  std::size_t k = 0;
  for (; k + lanes <= values.size(); k += lanes) {
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const double z = x[k + lane] - mean;
      sums[lane] += z * z;
    }
  }
  for (; k < values.size(); ++k) sums[0] += (x[k] - mean) * (x[k] - mean);
  return total(sums);
}

PM_VECTOR_CLONES
DepartureSums sum_departures(View<double> values) {
  const double* x = values.data();
  const double first = x[0];
  Quad sum{}, squares{}, steps{};
  std::size_t k = 1;
  for (; k + quad <= values.size(); k += quad) {
    Quad here, before;
    std::memcpy(&here, x + k, sizeof(Quad));
    std::memcpy(&before, x + k - 1, sizeof(Quad));
    const Quad z = here - first, step = here - before;
    sum += z;
    squares += z * z;
    steps += step * step;
  }
  DepartureSums out{total(sum), total(squares), total(steps)};
  for (; k < values.size(); ++k) {
    const double z = x[k] - first, step = x[k] - x[k - 1];
    out.sum += z;
    out.squares += z * z;
    out.steps += step * step;
  }
  return out;
}

PM_VECTOR_CLONES
bool has_repeats(View<double> values) {
  if (values.size() < 2) return false;
  const double* x = values.data();
  const std::size_t pairs = values.size() - 1;
  Lanes equal{};
  std::size_t k = 0;
  for (; k + lanes <= pairs; k += lanes)
    for (std::size_t lane = 0; lane < lanes; ++lane)
      equal[lane] += x[k + lane] == x[k + lane + 1] ? 1.0 : 0.0;
  for (; k < pairs; ++k) equal[0] += x[k] == x[k + 1] ? 1.0 : 0.0;
  return total(equal) > 0.0;
}

PM_VECTOR_CLONES
bool steps_are_fine_or_reversed(View<double> values, double least) {
  const double* x = values.data();
  Lanes found{};
  std::size_t k = 2;
  for (; k + lanes <= values.size(); k += lanes)
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const double* here = x + k + lane;
      found[lane] += std::abs(here[0] - here[-1]) < least ? 1.0 : 0.0;
      found[lane] += here[0] == here[-2] ? 1.0 : 0.0;
    }
  for (; k < values.size(); ++k)
    if (std::abs(x[k] - x[k - 1]) < least || x[k] == x[k - 2]) return true;
  return total(found) > 0.0;
}

PM_VECTOR_CLONES
std::size_t count_below(View<double> values, double sign, double bound) {
  const double* x = values.data();
  const std::size_t n = values.size();
  std::uint64_t count = 0;
  for (std::size_t k = 0; k < n; ++k) count += sign * x[k] < bound ? 1 : 0;
  return count;
}

PM_VECTOR_CLONES
StepStatistics step_statistics(View<double> stamps_s, double nominal_s) {
  if (stamps_s.size() < 2) return {};
  const double* t = stamps_s.data();
  const std::size_t steps = stamps_s.size() - 1;
  const double half_s = 0.5 * nominal_s;
  Lanes sums{}, odd{};
  std::size_t k = 0;
  for (; k + lanes <= steps; k += lanes) {
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const double deviation_s = (t[k + lane + 1] - t[k + lane]) - nominal_s;
      sums[lane] += deviation_s * deviation_s;
      odd[lane] += std::abs(deviation_s) <= half_s ? 0.0 : 1.0;
    }
  }
  for (; k < steps; ++k) {
    const double deviation_s = (t[k + 1] - t[k]) - nominal_s;
    sums[0] += deviation_s * deviation_s;
    odd[0] += std::abs(deviation_s) <= half_s ? 0.0 : 1.0;
  }
  return {.regular = total(odd) == 0.0, .squares = total(sums)};
}

void add_chunk(Moments& moments, const ChunkStatistics& figures, View<double> values) {
  const auto n = static_cast<double>(values.size());
  const double mean = figures.sum / n;
  const double squares = squares_about(values, mean);
  if (moments.count == 0) {
    moments = {.count = values.size(),
               .nonfinite = moments.nonfinite,
               .mean = mean,
               .squares = squares,
               .min = figures.min,
               .max = figures.max};
    return;
  }
  const auto before = static_cast<double>(moments.count);
  const double share = n / (before + n), step = mean - moments.mean;
  moments.mean += step * share;
  moments.squares += squares + step * step * before * share;
  moments.count += values.size();
  moments.min = std::min(moments.min, figures.min);
  moments.max = std::max(moments.max, figures.max);
}

}  // namespace proofmass::signal
