#include "proofmass/thesis/means.hpp"

#include <cmath>
#include <limits>

namespace proofmass::thesis {
namespace {

double mean_of(View<double> samples) {
  double sum = 0.0;
  std::size_t finite = 0;
  for (const double x : samples) {
    if (!std::isfinite(x)) continue;
    sum += x;
    ++finite;
  }
  if (2 * finite <= samples.size()) return std::numeric_limits<double>::quiet_NaN();
  return sum / static_cast<double>(finite);
}

}  // namespace

std::vector<double> means_over(View<double> samples, std::size_t by) {
  std::vector<double> means;
  means.reserve(samples.size() / by);
  for (std::size_t first = 0; first + by <= samples.size(); first += by)
    means.push_back(mean_of(samples.subspan(first, by)));
  return means;
}

}  // namespace proofmass::thesis
