#pragma once

#include <cstddef>
#include <vector>

#include "proofmass/core/view.hpp"

namespace proofmass::signal {

/// Contiguous segments of a series of any length: all of it up to `capacity`, then one segment of
/// every 2^k, with the smallest sufficient k. The same series gives the same excerpts, in whatever
/// blocks of whole `piece`s it is added.
class ValueExcerpts {
 public:
  static constexpr std::size_t piece = 1024;
  static constexpr std::size_t usual_capacity = std::size_t{1} << 17;

  /// capacity: a multiple of `piece`.
  explicit ValueExcerpts(std::size_t capacity = usual_capacity);

  /// Adds a piece; only the last one may be shorter.
  void add(View<double> values);

  /// The segments in order, with a NaN between those that are not adjacent.
  [[nodiscard]] std::vector<double> values() const;
  /// Fraction: values of the series per value of the excerpts.
  [[nodiscard]] double share() const;

 private:
  std::size_t stretch_;  ///< samples per segment
  std::size_t capacity_;
  std::vector<double> kept_;  ///< segments number 0, stride_, 2 stride_, …
  std::size_t stride_ = 1;
  std::size_t seen_ = 0;
};

}  // namespace proofmass::signal
