#include "proofmass/io/time/clock_pair.hpp"

#include <algorithm>
#include <cmath>

#include "proofmass/core/contract.hpp"
#include "proofmass/core/statistics.hpp"

namespace proofmass::io {
namespace {

/// A block of rows: its centre on the base clock, and the median of other minus base.
struct BlockPoint {
  double x = 0.0;
  double y = 0.0;
  double weight = 1.0;
};

/// Rows with numbers in both.
std::vector<std::size_t> common_rows(View<double> base_s, View<double> other_s) {
  std::vector<std::size_t> rows;
  for (std::size_t k = 0; k < base_s.size(); ++k)
    if (std::isfinite(base_s[k]) && std::isfinite(other_s[k])) rows.push_back(k);
  return rows;
}

std::vector<BlockPoint> blocks_of(View<double> base_s,
                                  View<double> other_s,
                                  View<std::size_t> rows,
                                  double offset) {
  const std::size_t count = std::clamp<std::size_t>(rows.size() / 64, 32, 256);
  std::vector<BlockPoint> out;
  for (std::size_t i = 0; i < count; ++i) {
    std::vector<double> x;
    std::vector<double> y;
    for (std::size_t j = i * rows.size() / count; j < (i + 1) * rows.size() / count; ++j) {
      x.push_back(base_s[rows[j]]);
      y.push_back(other_s[rows[j]] - base_s[rows[j]] - offset);
    }
    out.push_back({moments(x).mean, *median(y)});
  }
  return out;
}

struct Line {
  double level = 0.0;  ///< at x = middle
  double slope = 0.0;
  double middle = 0.0;
};

/// Theil–Sen: the median of the slopes between all pairs.
Line first_line(const std::vector<BlockPoint>& points) {
  std::vector<double> slopes;
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t j = i + 1; j < points.size(); ++j)
      if (points[j].x > points[i].x)
        slopes.push_back((points[j].y - points[i].y) / (points[j].x - points[i].x));
  Line line;
  line.slope = median(slopes).value_or(0.0);
  std::vector<double> levels;
  for (const BlockPoint& point : points) levels.push_back(point.y - line.slope * point.x);
  line.level = median(levels).value_or(0.0);
  return line;
}

double residual(const Line& line, const BlockPoint& point) {
  return point.y - line.level - line.slope * (point.x - line.middle);
}

/// The robust spread of the points about a line fitted with two parameters.
double spread_about(const Line& line, const std::vector<BlockPoint>& points) {
  std::vector<double> rests;
  for (const BlockPoint& point : points) rests.push_back(residual(line, point));
  const auto count = static_cast<double>(points.size());
  return robust_std(rests).value_or(0.0) * std::sqrt(count / (count - 2.0));
}

Line weighted_line(const std::vector<BlockPoint>& points) {
  double total = 0.0;
  double x = 0.0;
  double y = 0.0;
  for (const BlockPoint& point : points) {
    total += point.weight;
    x += point.weight * point.x;
    y += point.weight * point.y;
  }
  x /= total;
  y /= total;
  double xx = 0.0;
  double xy = 0.0;
  for (const BlockPoint& point : points) {
    xx += point.weight * (point.x - x) * (point.x - x);
    xy += point.weight * (point.x - x) * (point.y - y);
  }
  return {y, xy / xx, x};
}

/// Tukey's biweight about the previous line, a few times.
Line robust_line(std::vector<BlockPoint>& points) {
  Line line = first_line(points);
  constexpr double tuning = 4.685;  // 95 % efficient for normal residuals
  for (int i = 0; i < 20; ++i) {
    const double limit = tuning * spread_about(line, points);
    if (!(limit > 0.0)) break;  // all points lie on it
    for (BlockPoint& point : points) {
      const double u = residual(line, point) / limit;
      point.weight = std::abs(u) < 1.0 ? (1.0 - u * u) * (1.0 - u * u) : 0.0;
    }
    line = weighted_line(points);
  }
  return line;
}

/// Variance inflation of the slope by autocorrelation: (1 + ρ) / (1 − ρ) with the correlation ρ of
/// adjacent blocks, corrected for the bias due to the two fitted parameters (about 3 / n).
double likeness(const Line& line, const std::vector<BlockPoint>& points) {
  double squares = 0.0;
  double products = 0.0;
  double before = 0.0;
  for (const BlockPoint& point : points) {
    const double rest = point.weight > 0.0 ? residual(line, point) : 0.0;
    squares += rest * rest;
    products += rest * before;
    before = rest;
  }
  if (!(squares > 0.0)) return 1.0;
  const double correlation = products / squares + 3.0 / static_cast<double>(points.size());
  const double bounded = std::clamp(correlation, 0.0, 0.9);
  return (1.0 + bounded) / (1.0 - bounded);
}

/// Standard deviation of the slope, by the asymptotic covariance of an M-estimate: σ² Σψ²/(n−2) /
/// (Σψ'/n)² / Σ(x−x̄)².
double slope_std(const Line& line, const std::vector<BlockPoint>& points) {
  const double limit = 4.685 * spread_about(line, points);
  if (!(limit > 0.0)) return 0.0;
  double psi_squares = 0.0;
  double psi_slopes = 0.0;
  double squares = 0.0;
  for (const BlockPoint& point : points) {
    const double rest = residual(line, point);
    const double u2 = rest * rest / (limit * limit);
    squares += (point.x - line.middle) * (point.x - line.middle);
    if (u2 >= 1.0) continue;
    psi_squares += rest * rest * std::pow(1.0 - u2, 4);
    psi_slopes += (1.0 - u2) * (1.0 - 5.0 * u2);
  }
  const auto count = static_cast<double>(points.size());
  const double steepness = psi_slopes / count;
  if (!(steepness > 0.0)) return 0.0;
  return std::sqrt(likeness(line, points) * psi_squares / (count - 2.0) / (steepness * steepness) /
                   squares);
}

double jitter_of(View<double> stamps_s) {
  std::vector<double> steps;
  for (std::size_t k = 1; k < stamps_s.size(); ++k) steps.push_back(stamps_s[k] - stamps_s[k - 1]);
  return robust_std(steps).value_or(0.0);
}

}  // namespace

Result<ClockPair> compare_clocks(View<double> base_s, View<double> other_s) {
  PM_EXPECTS(base_s.size() == other_s.size());
  const std::vector<std::size_t> rows = common_rows(base_s, other_s);
  if (rows.size() < 64)
    return Error{Errc::too_few_samples, "two clocks are compared by 64 rows or more"};
  const double offset_s = other_s[rows.front()] - base_s[rows.front()];
  std::vector<BlockPoint> points = blocks_of(base_s, other_s, rows, offset_s);
  if (!(points.back().x > points.front().x))
    return Error{Errc::not_observable, "the clock does not advance"};
  const Line line = robust_line(points);
  ClockPair out;
  out.offset_s = offset_s + line.level - line.slope * line.middle;
  out.drift_ppm = 1e6 * line.slope;
  out.drift_std_ppm = 1e6 * slope_std(line, points);
  out.base_jitter_s = jitter_of(base_s);
  out.other_jitter_s = jitter_of(other_s);
  out.blocks = points.size();
  out.outliers = static_cast<std::size_t>(std::ranges::count(points, 0.0, &BlockPoint::weight));
  return out;
}

}  // namespace proofmass::io
