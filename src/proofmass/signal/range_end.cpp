#include "proofmass/signal/range_end.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "proofmass/signal/audit/stuck_values.hpp"
#include "proofmass/signal/channel_audit.hpp"

namespace proofmass::signal {
namespace {

struct Run {
  std::size_t first = 0, end = 0;
};

std::vector<Run> runs_at(View<double> series, double value) {
  std::vector<Run> runs;
  for (std::size_t k = 0; k < series.size(); ++k) {
    Run run{k, k};
    while (run.end < series.size() && series[run.end] == value) ++run.end;
    if (run.end - run.first >= RailRuns::shortest_run) runs.push_back(run);
    k = std::max(k, run.end);
  }
  return runs;
}

// Runs are both reached and left with a slope.
bool is_run_into(View<double> series, const std::vector<Run>& runs, double value, double lsb) {
  RailRuns rail{.rail = value};
  for (const auto [first, end] : runs) {
    if (first >= 2) rail.add_approach(end - first, series[first - 1], series[first - 2]);
    if (end + 1 < series.size()) rail.add_approach(end - first, series[end], series[end + 1]);
  }
  return rail.is_run_into(lsb);
}

}  // namespace

std::vector<bool> at_range_end(View<double> series) {
  std::vector<bool> out(series.size(), false);
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double value : series) {
    if (!std::isfinite(value)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  const double lsb = find_lsb(series).value_or(0.0);
  constexpr double symmetric = 0.95;
  for (const double value : {low, high}) {
    if (std::abs(value) < symmetric * std::max(std::abs(low), std::abs(high))) continue;
    const std::vector<Run> runs = runs_at(series, value);
    if (low != high && !is_run_into(series, runs, value, lsb)) continue;
    for (const auto [first, end] : runs)
      std::fill(out.begin() + static_cast<std::ptrdiff_t>(first),
                out.begin() + static_cast<std::ptrdiff_t>(end), true);
  }
  return out;
}

std::vector<bool> saturated_rows(const std::array<std::vector<double>, 3>& axes) {
  std::vector<bool> out(axes[0].size(), false);
  for (const std::vector<double>& axis : axes) {
    const std::vector<bool> own = at_range_end(axis);
    if (std::ranges::find(own, false) == own.end()) continue;
    for (std::size_t row = 0; row < out.size(); ++row) out[row] = out[row] || own[row];
  }
  return out;
}

std::size_t drop_rows(const std::vector<bool>& rows, std::array<std::vector<double>, 3>& axes) {
  for (std::vector<double>& axis : axes)
    for (std::size_t row = 0; row < rows.size(); ++row)
      if (rows[row]) axis[row] = std::numeric_limits<double>::quiet_NaN();
  return static_cast<std::size_t>(std::ranges::count(rows, true));
}

}  // namespace proofmass::signal
