#include "proofmass/signal/events/source.hpp"

#include <algorithm>
#include <cmath>

#include "proofmass/signal/events/kernels.hpp"

namespace proofmass::signal {
std::size_t samples_in(double seconds, double rate_hz) {
  return static_cast<std::size_t>(std::min(std::ceil(seconds * rate_hz), 1e18));
}

double median_of(std::span<double> values) {
  if (values.empty()) return nan;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

void Source::read(std::ptrdiff_t first, std::span<double> out) const {
  const auto size = static_cast<std::ptrdiff_t>(series.size());
  const auto count = static_cast<std::ptrdiff_t>(out.size());
  const std::ptrdiff_t begin = std::clamp<std::ptrdiff_t>(first, 0, size);
  const std::ptrdiff_t end = std::clamp<std::ptrdiff_t>(first + count, begin, size);
  std::fill(out.begin(), out.begin() + std::min(begin - first, count), nan);
  std::fill(out.begin() + std::clamp<std::ptrdiff_t>(end - first, 0, count), out.end(), nan);
  if (begin < end)
    copy_finite(series.data() + begin, out.data() + (begin - first),
                static_cast<std::size_t>(end - begin));
  auto gap = std::ranges::lower_bound(missing, static_cast<std::size_t>(begin), {}, &Stretch::last);
  for (; gap != missing.end() && static_cast<std::ptrdiff_t>(gap->first) < end; ++gap) {
    const auto from = std::max(begin, static_cast<std::ptrdiff_t>(gap->first));
    const auto to = std::min(end, static_cast<std::ptrdiff_t>(gap->last) + 1);
    std::fill(out.begin() + (from - first), out.begin() + (to - first), nan);
  }
}

std::vector<double> Source::read(std::size_t first, std::size_t count) const {
  std::vector<double> out(count);
  read(static_cast<std::ptrdiff_t>(first), out);
  return out;
}

double mean_of(const Source& source, std::size_t first, std::size_t count) {
  double sum = 0.0;
  std::size_t seen = 0;
  for (const double x : source.read(first, count))
    if (!std::isnan(x)) {
      sum += x;
      ++seen;
    }
  return 2 * seen >= count && seen > 0 ? sum / static_cast<double>(seen) : nan;
}

Grain grain_of(View<double> series) {
  constexpr std::size_t shortest = 20;
  double quantum = std::numeric_limits<double>::infinity();
  std::vector<Stretch> runs;
  std::size_t changes = 0;
  std::size_t run_first = 0;
  const auto change_at = [&](std::size_t k) {
    ++changes;
    if (k - run_first >= shortest) runs.push_back({run_first, k - 1});
    run_first = k;
  };
  constexpr std::size_t block = 64;
  for (std::size_t k = 1; k < series.size();) {
    const std::size_t end = std::min(k + block, series.size());
    // Fast path: usually no two adjacent values are equal.
    if (const double least = least_difference(series.subspan(k - 1, end - k + 1)); least > 0.0) {
      quantum = std::min(quantum, least);
      change_at(k);
      changes += end - k - 1;
      run_first = end - 1;
      k = end;
      continue;
    }
    for (; k < end; ++k) {
      const double difference = std::abs(series[k] - series[k - 1]);
      if (difference == 0.0) continue;
      quantum = difference < quantum ? difference : quantum;
      change_at(k);
    }
  }
  change_at(series.size());
  std::erase_if(runs, [&](const Stretch& run) {
    return (run.last - run.first + 1) * changes < 20 * series.size();
  });
  return {std::isfinite(quantum) ? quantum : 0.0, std::move(runs)};
}

}  // namespace proofmass::signal
