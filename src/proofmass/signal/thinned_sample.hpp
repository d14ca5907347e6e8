#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "proofmass/core/view.hpp"

namespace proofmass::signal {

/// Values of a series of any length, in order and evenly spread over it: all of them up to
/// `capacity`, then one out of each 2^k, with k as large as it must be. Which of the 2^k is drawn
/// by a hash of the place, so that no period of the series comes through. The same series always
/// gives the same sample, in whatever pieces it comes.
class ThinnedSample {
 public:
  static constexpr std::size_t usual_capacity = std::size_t{1} << 18;

  /// capacity: even.
  explicit ThinnedSample(std::size_t capacity = usual_capacity) : capacity_(capacity) {}

  void add(View<double> values);

  [[nodiscard]] View<double> values() const& { return kept_; }
  [[nodiscard]] std::vector<double> values() && { return std::move(kept_); }
  /// Values of the series for one of the sample.
  [[nodiscard]] double share() const {
    return kept_.empty() ? 1.0 : static_cast<double>(seen_) / static_cast<double>(kept_.size());
  }

 private:
  void halve();

  std::size_t capacity_;
  std::vector<double> kept_;
  std::size_t seen_ = 0;
  std::size_t next_ = 0;  ///< place of the value that is taken next
  unsigned level_ = 0;    ///< k
};

}  // namespace proofmass::signal
