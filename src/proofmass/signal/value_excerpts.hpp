#pragma once

#include <cstddef>
#include <vector>

#include "proofmass/core/view.hpp"

namespace proofmass::signal {

/// Unbroken stretches of a series of any length: all of it up to `capacity`, then one stretch of
/// each 2^k, with k as large as it must be. The same series always gives the same excerpts, in
/// whatever pieces of whole `piece`s it comes.
class ValueExcerpts {
 public:
  static constexpr std::size_t piece = 1024;
  static constexpr std::size_t usual_capacity = std::size_t{1} << 17;

  /// capacity: a multiple of `piece`.
  explicit ValueExcerpts(std::size_t capacity = usual_capacity);

  /// A piece; only the last one may be shorter.
  void add(View<double> values);

  /// One behind the other, with a NaN between stretches that do not adjoin.
  [[nodiscard]] std::vector<double> values() const;
  /// Values of the series for one of the excerpts'.
  [[nodiscard]] double share() const;

 private:
  std::size_t stretch_;  ///< samples of a stretch
  std::size_t capacity_;
  std::vector<double> kept_;  ///< stretches number 0, stride_, 2 stride_, …
  std::size_t stride_ = 1;
  std::size_t seen_ = 0;
};

}  // namespace proofmass::signal
