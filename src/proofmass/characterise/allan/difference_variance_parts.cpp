#include <algorithm>
#include <utility>

#include "proofmass/characterise/allan/difference_kernels.hpp"
#include "proofmass/characterise/allan/difference_variance.hpp"
#include "proofmass/core/contract.hpp"

// Sums of one part of a series, joined to those of the part before it, and their state as bytes.
namespace proofmass::characterise {

// Takes all pending terms; the integral is then zero at the end.
void DifferenceVariances::settle() {
  if (!started_) return;
  process(0);
  if (since_rebase_ > 0) rebase();
  for (std::size_t k = 0; k < levels_.size(); ++k) {
    Level& level = levels_[k];
    level.newest = (points_ - 1) >> k;
    const std::size_t old = level.points.size() - std::min(level.points.size(), level.span);
    level.points.erase(level.points.begin(),
                       level.points.begin() + static_cast<std::ptrdiff_t>(old));
    if (!level.missing.empty())
      level.missing.erase(level.missing.begin(),
                          level.missing.begin() + static_cast<std::ptrdiff_t>(old));
  }
}

void DifferenceVariances::append(DifferenceVariances part) {
  PM_EXPECTS(first_ && part.first_ && part.levels_.size() == levels_.size());
  PM_EXPECTS(*part.first_ == *first_ + static_cast<std::ptrdiff_t>(samples_));
  samples_ += part.samples_;
  if (!part.started_) {
    gap_ += part.gap_;
    return;
  }
  part.settle();
  if (!started_) return begin_with(std::move(part));
  gap_ += part.lead_;
  if (gap_ > 0) close_gap(part.first_valid_);
  settle();
  PM_EXPECTS(points_ == part.start_);
  const Frame step{part.head_offset_ - offset_, 0.0, 0.0, points_ - 1};
  for (std::size_t k = 0; k < levels_.size(); ++k) join(levels_[k], part.levels_[k], k, step, part);
  if (start_ > 0) frame_ = sum(sum(frame_, step, part.points_ - 1), part.frame_, part.points_ - 1);
  points_ = part.points_;
  offset_ = part.offset_;
  missing_ += part.missing_;
  last_ = part.last_;
  gap_ = part.gap_;
}

// If only missing samples precede the part.
void DifferenceVariances::begin_with(DifferenceVariances part) {
  const auto first = first_;
  const std::size_t samples = samples_, lead = gap_;
  *this = std::move(part);
  first_ = first;
  samples_ = samples;
  lead_ += lead;
}

void DifferenceVariances::join(Level& level,
                               const Level& part,
                               std::size_t k,
                               const Frame& step,
                               const DifferenceVariances& other) {
  const std::size_t stride = std::size_t{1} << k, before = level.points.size();
  const auto count = [&](std::size_t number, const Frame& frame) {
    return static_cast<double>(number * stride) - static_cast<double>(frame.at);
  };
  // The terms across the border, in the frame before it.
  Level across;
  const bool complete = missing_ == 0 && other.missing_ == 0;
  across.points = level.points;
  if (!complete) across.missing = level.missing;
  if (!complete) across.missing.resize(before, 0);
  const std::size_t first_number = (other.start_ + stride - 1) / stride;
  for (std::size_t e = 0; e < part.head.size(); ++e) {
    across.points.push_back(part.head[e] + in_frame(step, count(first_number + e, step)));
    if (!complete) across.missing.push_back(part.head_missing[e] + missing_);
  }
  for (std::size_t f = 0; f < level.factors.size(); ++f) {
    const std::size_t span = order_of(statistic_) * level.factors[f].spacing;
    const std::size_t begin = std::max(before, span);
    const std::size_t end = std::min(before + span, across.points.size());
    if (begin < end) take_all(across, level.factors[f], begin, end, stride);
    level.factors[f].sum += part.factors[f].sum;
    level.factors[f].terms += part.factors[f].terms;
  }
  for (std::size_t e = 0; e < part.head.size() && start_ > 0 && level.head.size() < level.span;
       ++e) {
    level.head.push_back(across.points[before + e] +
                         in_frame(frame_, count(first_number + e, frame_)));
    level.head_missing.push_back(complete ? 0 : across.missing[before + e]);
  }
  // The last points, in the frame after it.
  const std::size_t kept = std::min(before, level.span - std::min(level.span, part.points.size()));
  level.points.erase(level.points.begin(),
                     level.points.begin() + static_cast<std::ptrdiff_t>(before - kept));
  for (std::size_t e = 0; e < kept; ++e) {
    const std::size_t number = first_number - kept + e;
    level.points[e] -=
        in_frame(step, count(number, step)) + in_frame(other.frame_, count(number, other.frame_));
  }
  level.points.insert(level.points.end(), part.points.begin(), part.points.end());
  level.newest = part.newest;
  level.fresh = 0;
  if (complete) return;
  level.missing.resize(before, 0);
  level.missing.erase(level.missing.begin(),
                      level.missing.begin() + static_cast<std::ptrdiff_t>(before - kept));
  for (std::size_t e = 0; e < part.points.size(); ++e)
    level.missing.push_back(missing_ + (part.missing.empty() ? 0 : part.missing[e]));
}

std::size_t DifferenceVariances::points_of_level(std::size_t k) const {
  const std::size_t stride = std::size_t{1} << k;
  return (points_ - 1) / stride + 1 - (start_ + stride - 1) / stride;
}

void DifferenceVariances::exchange(StateBytes& bytes, std::size_t samples) {
  settle();
  samples_ = samples;
  bytes(started_);
  bytes(gap_);
  if (!started_) {
    if (gap_ != samples) bytes.fail();
    return;
  }
  for (std::size_t* count : {&lead_, &start_, &points_, &frame_.at}) bytes(*count);
  bytes(missing_);
  for (double* value : {&first_valid_, &last_, &offset_, &head_offset_, &frame_.offset,
                        &frame_.theta, &frame_.big_theta})
    bytes(*value);
  const std::ptrdiff_t before = *first_ + static_cast<std::ptrdiff_t>(lead_);
  const std::size_t begun = is_modified(statistic_) ? 2 : 1;
  if (lead_ > samples || gap_ > samples - lead_ || before < 0 ||
      start_ != (before == 0 ? 0 : static_cast<std::size_t>(before) + begun) ||
      points_ != static_cast<std::size_t>(before) + begun + samples - lead_ - gap_ ||
      (start_ > 0 && frame_.at != points_ - 1))
    return bytes.fail();
  for (std::size_t k = 0; k < levels_.size() && !bytes.failed(); ++k) exchange_level(bytes, k);
}

void DifferenceVariances::exchange_level(StateBytes& bytes, std::size_t k) {
  Level& level = levels_[k];
  for (Factor& factor : level.factors) {
    bytes(factor.sum);
    bytes(factor.terms);
  }
  bytes(level.points);
  bytes(level.missing);
  bytes(level.head);
  bytes(level.head_missing);
  level.newest = (points_ - 1) >> k;
  const std::size_t points = std::min(level.span, points_of_level(k));
  const std::size_t of_head = start_ > 0 ? points : 0;
  if (level.points.size() != points || level.head.size() != of_head ||
      level.head_missing.size() != of_head || level.missing.size() != (missing_ > 0 ? points : 0))
    bytes.fail();
}

}  // namespace proofmass::characterise
