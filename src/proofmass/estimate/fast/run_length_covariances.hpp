#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "proofmass/core/contract.hpp"
#include "proofmass/estimate/filter/symmetric.hpp"

namespace proofmass::estimate {

/// Run-length-encoded covariances of all epochs of a run. A new one is stored only where an entry
/// differs from the last stored one by more than `tolerance` of its row's and column's standard
/// deviations. A settled filter needs one for the remaining epochs.
template <int N>
class RunLengthCovariances {
 public:
  static constexpr double tolerance = 1e-11;

  /// Number of epochs.
  [[nodiscard]] std::size_t size() const { return size_; }
  /// Number of covariances stored.
  [[nodiscard]] std::size_t kept() const { return kept_.size(); }

  /// Cost: O(log kept()).
  [[nodiscard]] const Symmetric<N>& at(std::size_t k) const {
    PM_EXPECTS(k < size_);
    const auto after = std::upper_bound(first_.begin(), first_.end(), k);
    return kept_[static_cast<std::size_t>(after - first_.begin()) - 1];
  }

  /// Appends the covariance of the next `count` epochs.
  void push(const Symmetric<N>& cov, std::size_t count = 1) {
    if (count == 0) return;
    if (kept_.empty() || !same(kept_.back(), cov)) {
      first_.push_back(size_);
      kept_.push_back(cov);
    }
    size_ += count;
  }

  /// Restores time order after pushing from the last epoch to the first.
  void reverse() {
    for (std::size_t i = 0; i < first_.size(); ++i)
      first_[i] = size_ - (i + 1 < first_.size() ? first_[i + 1] : size_);
    std::reverse(first_.begin(), first_.end());
    std::reverse(kept_.begin(), kept_.end());
  }

 private:
  static bool same(const Symmetric<N>& a, const Symmetric<N>& b) {
    constexpr double squared = tolerance * tolerance;
    for (int i = 0; i < N; ++i)
      for (int j = 0; j <= i; ++j) {
        const double moved = a(i, j) - b(i, j);
        if (!(moved * moved <= squared * std::abs(a(i, i) * a(j, j)))) return false;
      }
    return true;
  }

  std::vector<std::size_t> first_;
  std::vector<Symmetric<N>> kept_;
  std::size_t size_ = 0;
};

}  // namespace proofmass::estimate
