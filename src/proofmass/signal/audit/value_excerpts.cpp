#include "proofmass/signal/audit/value_excerpts.hpp"

#include <algorithm>

#include "proofmass/core/contract.hpp"
#include "proofmass/core/statistics.hpp"

namespace proofmass::signal {

// Sixteen segments, or fewer of one piece each.
ValueExcerpts::ValueExcerpts(std::size_t capacity)
    : stretch_(std::max(piece, capacity / 16 / piece * piece)),
      capacity_(std::max(capacity / stretch_, std::size_t{1}) * stretch_) {}

void ValueExcerpts::add(View<double> values) {
  PM_EXPECTS(seen_ % piece == 0 && values.size() <= piece);
  const std::size_t number = seen_ / stretch_;
  seen_ += values.size();
  if (number % stride_ != 0) return;
  kept_.insert(kept_.end(), values.begin(), values.end());
  if (kept_.size() <= capacity_) return;
  // Every second segment is dropped; the last one is incomplete and has an even number.
  std::size_t count = 0;
  for (std::size_t from = 0; from < kept_.size(); from += 2 * stretch_) {
    const std::size_t length = std::min(stretch_, kept_.size() - from);
    std::copy_n(kept_.begin() + static_cast<std::ptrdiff_t>(from), length,
                kept_.begin() + static_cast<std::ptrdiff_t>(count));
    count += length;
  }
  kept_.resize(count);
  stride_ *= 2;
}

std::vector<double> ValueExcerpts::values() const {
  if (stride_ == 1) return kept_;
  std::vector<double> out;
  for (std::size_t from = 0; from < kept_.size(); from += stretch_) {
    if (from > 0) out.push_back(no_value);
    const View<double> one =
        View<double>(kept_).subspan(from, std::min(stretch_, kept_.size() - from));
    out.insert(out.end(), one.begin(), one.end());
  }
  return out;
}

double ValueExcerpts::share() const {
  return kept_.empty() ? 1.0 : static_cast<double>(seen_) / static_cast<double>(kept_.size());
}

}  // namespace proofmass::signal
