#include "proofmass/signal/clipping_tail.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "proofmass/signal/audit/chunk_statistics.hpp"
#include "proofmass/signal/audit/extreme_levels.hpp"

namespace proofmass::signal {
namespace {

std::size_t count_beside(View<double> values, double extreme, double width) {
  return static_cast<std::size_t>(std::ranges::count_if(
      values, [&](double x) { return x != extreme && std::abs(x - extreme) <= width; }));
}

}  // namespace

void ClippingTail::add(View<double> values, double extreme) {
  // Most values of a long series lie beyond the tail: only a few parts need a check of each value.
  constexpr std::size_t part = 64;
  for (std::size_t from = 0; from < values.size() && sign_ * extreme < below_; from += part) {
    const View<double> some = values.subspan(from, std::min(part, values.size() - from));
    if (count_below(some, sign_, below_) == 0) continue;
    // Branch-free, as the few in the tail are unpredictable.
    std::array<double, part> tail{};
    std::size_t count = 0;
    for (const double value : some) {
      tail[count] = sign_ * value;
      count += tail[count] < below_ ? 1 : 0;
    }
    for (std::size_t k = 0; k < count; ++k) keep(tail[k]);
  }
}

void ClippingTail::keep(double value) {
  if (!(value < below_)) return;
  kept_.push_back(value);
  if (kept_.size() >= 2 * capacity_) trim();
}

void ClippingTail::trim() {
  const auto last = kept_.begin() + static_cast<std::ptrdiff_t>(capacity_ - 1);
  std::ranges::nth_element(kept_, last);
  below_ = *last;
  kept_.resize(capacity_);
}

void ClippingTail::append(const ClippingTail& part) {
  below_ = std::min(below_, part.below_);
  for (const double value : part.kept_) keep(value);
}

void ClippingTail::exchange(StateBytes& bytes) {
  if (kept_.size() > capacity_) trim();
  bytes(kept_);
  bytes(below_);
  if (kept_.size() > capacity_ || std::isnan(below_)) bytes.fail();
}

double ClippingTail::beside(double width, const Subsample& sample) const {
  if (kept_.empty()) return 0.0;
  const double extreme = *std::ranges::min_element(kept_);
  const double exact = static_cast<double>(count_beside(kept_, extreme, width));
  if (extreme + width < below_) return exact;
  const auto of_sample = static_cast<double>(count_beside(sample.values(), sign_ * extreme, width));
  return std::max(exact, of_sample * sample.share());
}

double ClippingTail::most_frequent_beside(const Subsample& sample) const {
  constexpr std::size_t all_beside = 8;
  const ExtremeLevels exact = levels_at_lowest(kept_);
  const bool is_all = std::isinf(below_);
  if (exact.beside == all_beside || is_all) return static_cast<double>(exact.most_frequent);
  std::vector<double> values(sample.values().begin(), sample.values().end());
  for (double& value : values) value *= sign_;
  return static_cast<double>(levels_at_lowest(std::move(values)).most_frequent) * sample.share();
}

}  // namespace proofmass::signal
