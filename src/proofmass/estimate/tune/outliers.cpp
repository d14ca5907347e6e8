#include "proofmass/estimate/tune/outliers.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "proofmass/core/contract.hpp"

namespace proofmass::estimate {
namespace {

// The step of the converter, or hardly anything where values differ in their last digits.
double least_distance(const TuneSeries& series) {
  double least = std::numeric_limits<double>::infinity();
  for (const View<double> segment : series.segments) {
    double last = std::numeric_limits<double>::quiet_NaN();
    for (const double x : segment) {
      if (std::isnan(x)) continue;
      if (const double distance = std::abs(x - last); distance > 0.0)
        least = std::min(least, distance);
      last = x;
    }
  }
  return least;
}

struct Residual {
  std::size_t k;
  double value, size;  // in the unit of the series
  double standard;     // in standard deviations, absolute
};

std::vector<Residual> residuals_of(const TuneSystem& system, View<double> segment) {
  const TuneResiduals found = deletion_residuals(system, segment);
  std::vector<Residual> all;
  for (std::size_t k = 0; k < segment.size(); ++k) {
    if (!(found.variance[k] > 0.0)) continue;
    all.push_back({k, segment[k], found.residual[k],
                   std::abs(found.residual[k]) / std::sqrt(found.variance[k])});
  }
  return all;
}

// Whether one of a run, from `i` to before `end`, is beyond the measurements beside the run, too. A
// step is not, nor the neighbour of an outlier, whose own residual has half the size of the
// outlier's where the process noise dominates.
bool is_beyond_neighbours(const Residual& one, View<Residual> all, std::size_t i, std::size_t end) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  const auto widen = [&](double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  };
  if (i > 0) widen(all[i - 1].value);
  if (end < all.size()) widen(all[end].value);
  const double beyond = one.size > 0.0 ? one.value - high : low - one.value;
  return beyond > 0.5 * std::abs(one.size);
}

struct Limits {
  double standard;    // in standard deviations
  double resolution;  // the step of the converter
};

std::vector<Residual> outliers_among(View<Residual> all, const Limits& limits) {
  constexpr std::size_t longest_run = 5;
  constexpr double steps = 1.5;
  const auto stands_out = [&](const Residual& one) {
    return one.standard > limits.standard && std::abs(one.size) > steps * limits.resolution;
  };
  std::vector<Residual> outliers;
  for (std::size_t i = 0, end = 0; i < all.size(); i = std::max(end, i + 1)) {
    for (end = i; end < all.size() && stands_out(all[end]);) ++end;
    if (end - i > longest_run) continue;
    std::ranges::copy_if(
        all.subspan(i, end - i), std::back_inserter(outliers),
        [&](const Residual& one) { return is_beyond_neighbours(one, all, i, end); });
  }
  return outliers;
}

}  // namespace

TuneReadings::TuneReadings(std::vector<TuneSeries> series)
    : series_(std::move(series)), cleaned_(series_.size()), outliers_(series_.size()) {
  for (std::size_t s = 0; s < series_.size(); ++s) {
    cleaned_[s].resize(series_[s].segments.size());
    resolution_.push_back(least_distance(series_[s]));
    count_.push_back(count_readings(series_[s]));
  }
}

double TuneReadings::largest_share() const {
  double largest = 0.0;
  for (std::size_t s = 0; s < series_.size(); ++s) {
    const auto outliers = static_cast<double>(outliers_[s].count);
    largest = std::max(largest, outliers / static_cast<double>(count_[s]));
  }
  return largest;
}

std::size_t TuneReadings::drop_outliers(const TuneProblem& problem) {
  PM_EXPECTS(problem.series().size() == series_.size());
  const double limit = std::sqrt(2.0 * std::log(1000.0 * static_cast<double>(problem.readings())));
  std::size_t dropped = 0;
  for (std::size_t s = 0; s < series_.size(); ++s) {
    for (std::size_t g = 0; g < series_[s].segments.size(); ++g) {
      const std::vector<Residual> all = residuals_of(problem.system(s), series_[s].segments[g]);
      for (const Residual& one : outliers_among(all, {limit, resolution_[s]})) {
        drop(s, g, one.k, one.size);
        ++dropped;
      }
    }
  }
  return dropped;
}

void TuneReadings::drop(std::size_t series, std::size_t segment, std::size_t k, double residual) {
  std::vector<double>& values = cleaned_[series][segment];
  View<double>& seen = series_[series].segments[segment];
  if (values.empty()) {
    values.assign(seen.begin(), seen.end());
    seen = values;
  }
  values[k] = std::numeric_limits<double>::quiet_NaN();
  TuneOutliers& outliers = outliers_[series];
  ++outliers.count;
  outliers.largest = std::max(outliers.largest, std::abs(residual));
}

}  // namespace proofmass::estimate
