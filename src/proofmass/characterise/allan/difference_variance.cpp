#include "proofmass/characterise/allan/difference_variance.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "proofmass/characterise/allan/difference_kernels.hpp"
#include "proofmass/core/contract.hpp"

namespace proofmass::characterise {
namespace {

// So short that a chunk and its comparison data stay in the first-level cache.
constexpr std::size_t chunk = 2048;
// Minimum number of points of a decimated level for a pass over its factors.
constexpr std::size_t batch = 256;
// Interval between subtractions of polynomials invisible to the differences.
constexpr std::size_t rebase_every = 1 << 16;
// At most one in this many samples of a term may be missing.
constexpr std::size_t missing_share = 16;

bool overlaps(Statistic statistic) {
  return statistic != Statistic::adev && statistic != Statistic::hdev;
}

double divisor(Statistic statistic, double m) {
  if (is_modified(statistic)) return 2.0 * m * m * m * m;
  return (order_of(statistic) == 2 ? 2.0 : 6.0) * m * m;
}

// How often a factor may be halved with this many terms per τ.
std::size_t level_of(std::size_t m, std::size_t least_overlap) {
  std::size_t level = 0;
  while (m % 2 == 0 && m / 2 >= least_overlap) {
    m /= 2;
    ++level;
  }
  return level;
}

double mean_of_finite(View<double> samples) {
  double sum = 0.0;
  std::size_t count = 0;
  for (const double x : samples) {
    if (!std::isfinite(x)) continue;
    sum += x;
    ++count;
  }
  return count > 0 ? sum / static_cast<double>(count) : 0.0;
}

}  // namespace

DifferenceVariances::DifferenceVariances(Statistic statistic,
                                         View<std::size_t> factors,
                                         std::size_t least_overlap)
    : statistic_(statistic), factor_count_(factors.size()) {
  PM_EXPECTS(statistic <= Statistic::ohdev);
  levels_.resize(1);
  for (std::size_t at = 0; at < factors.size(); ++at) {
    PM_EXPECTS(factors[at] > 0 && (at == 0 || factors[at] > factors[at - 1]));
    const std::size_t level = overlaps(statistic) ? level_of(factors[at], least_overlap) : 0;
    if (levels_.size() <= level) levels_.resize(level + 1);
    const std::size_t spacing = factors[at] >> level;
    levels_[level].factors.push_back({at, spacing});
    levels_[level].span = std::max(levels_[level].span, order_of(statistic) * spacing);
  }
}

std::size_t DifferenceVariances::stride(Statistic statistic,
                                        std::size_t m,
                                        std::size_t least_overlap) {
  return overlaps(statistic) ? std::size_t{1} << level_of(m, least_overlap) : m;
}

DifferenceVariances::DifferenceVariances(Statistic statistic,
                                         View<std::size_t> factors,
                                         std::size_t least_overlap,
                                         std::ptrdiff_t first)
    : DifferenceVariances(statistic, factors, least_overlap) {
  PM_EXPECTS(overlaps(statistic));
  first_ = first;
}

void DifferenceVariances::add(View<double> samples) {
  for (std::size_t from = 0; from < samples.size(); from += chunk) {
    const View<double> part = samples.subspan(from, std::min(chunk, samples.size() - from));
    samples_ += part.size();
    if (!started_) offset_ = mean_of_finite(part);
    if (gap_ == 0 && all_finite(part.data(), part.size())) {
      if (!started_) {
        begin();
        first_valid_ = part.front();
      }
      add_complete(part);
    } else {
      std::ranges::for_each(part, [this](double y) { add_one(y); });
    }
    process(batch);
    if (since_rebase_ >= rebase_every) rebase();
  }
}

// θ[0], and before it Θ[0]; of a part they are the last points of the part before it.
void DifferenceVariances::begin() {
  head_offset_ = offset_;
  lead_ = std::exchange(gap_, 0);
  PM_EXPECTS(!first_ || *first_ + static_cast<std::ptrdiff_t>(lead_) >= 0);
  const std::size_t before =
      first_ ? static_cast<std::size_t>(*first_ + static_cast<std::ptrdiff_t>(lead_)) : 0;
  if (before > 0) {
    start_ = points_ = before + (is_modified(statistic_) ? 2 : 1);
    frame_.at = points_ - 1;
    return;
  }
  if (is_modified(statistic_)) append_point();
  append_point();
}

void DifferenceVariances::add_complete(View<double> samples) {
  Level& level = levels_.front();
  const std::size_t before = level.points.size();
  level.points.insert(level.points.end(), samples.begin(), samples.end());
  const std::span<double> points(level.points.data() + before, samples.size());
  // Copies, which stay in registers, as members might alias the points.
  double theta = theta_, big_theta = big_theta_;
  const double offset = offset_;
  if (is_modified(statistic_)) {
    for (double& point : points) point = big_theta += theta += point - offset;
  } else {
    for (double& point : points) point = theta += point - offset;
  }
  theta_ = theta;
  big_theta_ = big_theta;
  if (missing_ > 0) level.missing.resize(level.points.size(), missing_);
  level.fresh += samples.size();
  points_ += samples.size();
  since_rebase_ += samples.size();
  last_ = samples.back();
  started_ = true;
}

void DifferenceVariances::add_one(double y) {
  if (!std::isfinite(y)) {
    ++gap_;
    return;
  }
  if (!started_) {
    begin();
    first_valid_ = y;
  } else if (gap_ > 0) {
    close_gap(y);
  }
  gap_ = 0;
  add_sample(y);
  last_ = y;
  started_ = true;
}

// The samples of a gap, interpolated linearly between its neighbours.
void DifferenceVariances::close_gap(double next) {
  // Counting starts with the first missing sample.
  if (missing_ == 0) {
    for (Level& level : levels_) level.missing.assign(level.points.size(), 0);
  }
  const double step = (next - last_) / static_cast<double>(gap_ + 1);
  for (std::size_t k = 1; k <= gap_; ++k) {
    ++missing_;
    add_sample(last_ + step * static_cast<double>(k));
    if (k % chunk == 0) process(batch);
  }
}

void DifferenceVariances::add_sample(double y) {
  theta_ += y - offset_;
  ++since_rebase_;
  append_point();
}

void DifferenceVariances::append_point() {
  Level& level = levels_.front();
  big_theta_ += theta_;
  level.points.push_back(is_modified(statistic_) ? big_theta_ : theta_);
  if (missing_ > 0) level.missing.push_back(missing_);
  ++level.fresh;
  ++points_;
}

// Completes terms with the new points, level after level, once there are enough of them.
void DifferenceVariances::process(std::size_t worth) {
  levels_.front().newest = points_ - 1;
  for (std::size_t k = 0; k < levels_.size(); ++k) {
    Level& level = levels_[k];
    if (k > 0 && level.fresh < worth) return;
    for (Factor& factor : level.factors) take(level, factor, std::size_t{1} << k);
    if (start_ > 0 && level.head.size() < level.span) fill_head(level, std::size_t{1} << k);
    if (k + 1 < levels_.size()) decimate(level, levels_[k + 1]);
    level.fresh = 0;
    forget(level);
  }
}

void DifferenceVariances::decimate(const Level& from, Level& to) const {
  const std::size_t size = from.points.size();
  std::size_t e = size - from.fresh;
  if ((from.newest + 1 - from.fresh) % 2 != 0) ++e;
  if (e >= size) return;
  const std::size_t count = (size - e + 1) / 2, before = to.points.size();
  to.points.resize(before + count);
  for (std::size_t k = 0; k < count; ++k) to.points[before + k] = from.points[e + 2 * k];
  if (missing_ > 0) {
    to.missing.resize(before + count);
    for (std::size_t k = 0; k < count; ++k) to.missing[before + k] = from.missing[e + 2 * k];
  }
  to.newest = from.newest / 2;
  to.fresh += count;
}

// Drops points that no later term needs, occasionally.
void DifferenceVariances::forget(Level& level) {
  if (level.points.size() < 2 * level.span + 2 * chunk) return;
  const auto old = static_cast<std::ptrdiff_t>(level.points.size() - level.span);
  level.points.erase(level.points.begin(), level.points.begin() + old);
  if (missing_ > 0) level.missing.erase(level.missing.begin(), level.missing.begin() + old);
}

void DifferenceVariances::take(const Level& level, Factor& factor, std::size_t stride) const {
  const std::size_t size = level.points.size();
  const std::size_t span = order_of(statistic_) * factor.spacing;
  if (level.fresh == 0 || level.newest < span) return;
  // The first point of a term must be there; where points were dropped, those needed were kept.
  const std::size_t begin = std::max(size - level.fresh, span);
  if (begin >= size) return;
  if (overlaps(statistic_)) return take_all(level, factor, begin, size, stride);
  const std::size_t first_number = level.newest + 1 - size, step = factor.spacing;
  const std::size_t allowed = span * stride / missing_share;
  for (std::size_t e = begin + (step - (begin + first_number) % step) % step; e < size; e += step) {
    if (missing_ > 0 && level.missing[e] - level.missing[e - span] > allowed) continue;
    factor.sum += squared_differences(level.points.data() + e - span, factor, 1);
    ++factor.terms;
  }
}

// The terms that end at the points from `begin` to `end`.
void DifferenceVariances::take_all(const Level& level,
                                   Factor& factor,
                                   std::size_t begin,
                                   std::size_t end,
                                   std::size_t stride) const {
  const std::size_t span = order_of(statistic_) * factor.spacing;
  if (level.missing.empty() || level.missing[end - 1] == level.missing[begin - span]) {
    factor.sum += squared_differences(level.points.data() + begin - span, factor, end - begin);
    factor.terms += end - begin;
    return;
  }
  const std::size_t allowed = span * stride / missing_share;
  for (std::size_t e = begin; e < end; ++e) {
    if (level.missing[e] - level.missing[e - span] > allowed) continue;
    factor.sum += squared_differences(level.points.data() + e - span, factor, 1);
    ++factor.terms;
  }
}

double DifferenceVariances::squared_differences(const double* x,
                                                const Factor& factor,
                                                std::size_t n) const {
  return order_of(statistic_) == 2 ? squared_second_differences(x, factor.spacing, n)
                                   : squared_third_differences(x, factor.spacing, n);
}

// Differences of order d are invariant to polynomials below that order. These are subtracted from
// the stored points to keep the integral small for any length and drift of the series.
void DifferenceVariances::rebase() {
  // The mean of a few samples says nothing about the others.
  const double slope = since_rebase_ < chunk ? 0.0 : theta_ / static_cast<double>(since_rebase_);
  const auto now = static_cast<double>(points_ - 1);
  for (std::size_t k = 0; k < levels_.size(); ++k) {
    Level& level = levels_[k];
    const auto stride = static_cast<double>(std::size_t{1} << k);
    double number =
        static_cast<double>(level.newest + 1) - static_cast<double>(level.points.size());
    for (double& point : level.points) {
      const double t = number * stride - now;
      point -= is_modified(statistic_) ? big_theta_ + theta_ * t + slope * t * (t + 1.0) / 2.0
                                       : theta_ + slope * t;
      number += 1.0;
    }
  }
  if (start_ > 0) frame_ = sum(frame_, {slope, theta_, big_theta_, points_ - 1}, points_ - 1);
  offset_ += slope;
  theta_ = 0.0;
  big_theta_ = 0.0;
  since_rebase_ = 0;
}

double DifferenceVariances::in_frame(const Frame& frame, double t) const {
  return is_modified(statistic_)
             ? frame.big_theta + frame.theta * t + frame.offset * t * (t + 1.0) / 2.0
             : frame.theta + frame.offset * t;
}

DifferenceVariances::Frame DifferenceVariances::moved(Frame frame, std::size_t at) {
  const double by = static_cast<double>(at) - static_cast<double>(frame.at);
  frame.big_theta += frame.theta * by + frame.offset * by * (by + 1.0) / 2.0;
  frame.theta += frame.offset * by;
  frame.at = at;
  return frame;
}

DifferenceVariances::Frame DifferenceVariances::sum(const Frame& a,
                                                    const Frame& b,
                                                    std::size_t at) {
  const Frame x = moved(a, at), y = moved(b, at);
  return {x.offset + y.offset, x.theta + y.theta, x.big_theta + y.big_theta, at};
}

void DifferenceVariances::fill_head(Level& level, std::size_t stride) const {
  const std::size_t size = level.points.size();
  for (std::size_t e = size - level.fresh; e < size && level.head.size() < level.span; ++e) {
    const std::size_t number = level.newest + 1 - size + e;
    const double t = static_cast<double>(number * stride) - static_cast<double>(frame_.at);
    level.head.push_back(level.points[e] + in_frame(frame_, t));
    level.head_missing.push_back(level.missing.empty() ? 0 : level.missing[e]);
  }
}

std::vector<PhaseVariance> DifferenceVariances::finish() const {
  std::vector<PhaseVariance> variances(factor_count_);
  DifferenceVariances last = *this;
  if (points_ > 0) last.process(0);
  for (std::size_t k = 0; k < last.levels_.size(); ++k) {
    for (const Factor& factor : last.levels_[k].factors) {
      if (factor.terms == 0) continue;
      const auto m = static_cast<double>(factor.spacing << k);
      variances[factor.at] = {
          factor.sum / (static_cast<double>(factor.terms) * divisor(statistic_, m)), factor.terms};
    }
  }
  return variances;
}

}  // namespace proofmass::characterise
