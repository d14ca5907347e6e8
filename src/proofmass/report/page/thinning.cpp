#include "proofmass/report/page/thinning.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "proofmass/core/contract.hpp"

namespace proofmass::report {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

struct Range {
  std::size_t begin, end;
};

// The b-th of `buckets` intervals of n values; none is empty if n >= buckets.
Range stretch(std::size_t n, std::size_t buckets, std::size_t b) {
  return {n * b / buckets, n * (b + 1) / buckets};
}

void keep_extremes(View<double> x, View<double> y, Range range, Polyline& out) {
  std::size_t first = range.end, last = range.end, low = range.end, high = range.end;
  bool gap = false;
  for (std::size_t k = range.begin; k < range.end; ++k) {
    if (!std::isfinite(y[k])) {
      gap = true;
      continue;
    }
    if (first == range.end) first = low = high = k;
    if (y[k] < y[low]) low = k;
    if (y[k] > y[high]) high = k;
    last = k;
  }
  std::size_t previous = range.end;  // also the value of all four if no value is finite
  for (const std::size_t k : {first, std::min(low, high), std::max(low, high), last}) {
    if (k == previous) continue;
    out.x.push_back(x[k]);
    out.y.push_back(y[k]);
    previous = k;
  }
  if (gap) {
    out.x.push_back(x[range.end - 1]);
    out.y.push_back(none);
  }
}

}  // namespace

Polyline thinned(View<double> x, View<double> y, std::size_t buckets) {
  PM_EXPECTS(x.size() == y.size() && buckets > 0);
  if (y.size() <= 4 * buckets) return {{x.begin(), x.end()}, {y.begin(), y.end()}};
  Polyline out;
  out.x.reserve(5 * buckets);
  out.y.reserve(5 * buckets);
  for (std::size_t b = 0; b < buckets; ++b) keep_extremes(x, y, stretch(y.size(), buckets, b), out);
  return out;
}

Envelope thinned_band(View<double> x, View<double> lower, View<double> upper, std::size_t buckets) {
  PM_EXPECTS(x.size() == lower.size() && x.size() == upper.size() && buckets > 0);
  if (x.size() <= buckets) {
    return {{x.begin(), x.end()}, {lower.begin(), lower.end()}, {upper.begin(), upper.end()}};
  }
  Envelope out;
  for (std::size_t b = 0; b < buckets; ++b) {
    const Range range = stretch(x.size(), buckets, b);
    double least = none, greatest = none;
    for (std::size_t k = range.begin; k < range.end; ++k) {
      // fmin and fmax ignore a NaN if the other argument is a number.
      if (std::isfinite(lower[k])) least = std::fmin(least, lower[k]);
      if (std::isfinite(upper[k])) greatest = std::fmax(greatest, upper[k]);
    }
    out.x.push_back(0.5 * (x[range.begin] + x[range.end - 1]));
    out.lower.push_back(least);
    out.upper.push_back(greatest);
  }
  // The band must extend to both ends of the curve to which it belongs.
  out.x.front() = x.front();
  out.x.back() = x.back();
  return out;
}

}  // namespace proofmass::report
