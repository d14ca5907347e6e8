#include "proofmass/core/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "proofmass/core/contract.hpp"

namespace proofmass {

void Moments::add(double x) {
  if (!std::isfinite(x)) {
    ++nonfinite;
    return;
  }
  min = count == 0 ? x : std::min(min, x);
  max = count == 0 ? x : std::max(max, x);
  ++count;
  const double step = x - mean;
  mean += step / static_cast<double>(count);
  squares += step * (x - mean);
}

double Moments::std() const {
  return count < 2 ? 0.0 : std::sqrt(squares / static_cast<double>(count - 1));
}

Moments moments(View<double> series) {
  Moments result;
  for (const double x : series) result.add(x);
  return result;
}

std::optional<double> quantile(View<double> series, double p) {
  PM_EXPECTS(p >= 0.0 && p <= 1.0);
  std::vector<double> finite;
  finite.reserve(series.size());
  std::ranges::copy_if(series, std::back_inserter(finite),
                       [](double x) { return std::isfinite(x); });
  if (finite.empty()) return std::nullopt;
  const double at = p * static_cast<double>(finite.size() - 1);
  const auto below = finite.begin() + static_cast<std::ptrdiff_t>(std::floor(at));
  std::ranges::nth_element(finite, below);
  const double fraction = at - std::floor(at);
  if (fraction == 0.0) return *below;
  return std::lerp(*below, *std::min_element(below + 1, finite.end()), fraction);
}

std::optional<double> robust_std(View<double> series) {
  const auto centre = median(series);
  if (!centre) return std::nullopt;
  std::vector<double> deviations(series.begin(), series.end());
  for (double& x : deviations) x = std::abs(x - *centre);
  return 1.4826 * *median(deviations);
}

}  // namespace proofmass
