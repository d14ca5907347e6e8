#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "proofmass/core/state_bytes.hpp"
#include "proofmass/core/view.hpp"

namespace proofmass::signal {

/// A subsample of a series of any length, in order and evenly spread: all values up to `capacity`,
/// then one of every 2^k, with the smallest sufficient k. The one is chosen by a hash of its
/// position, so that no period of the series is aliased. The same series gives the same sample,
/// however it is divided into blocks.
class Subsample {
 public:
  static constexpr std::size_t usual_capacity = std::size_t{1} << 18;

  /// capacity: even.
  explicit Subsample(std::size_t capacity = usual_capacity) : capacity_(capacity) {}

  void add(View<double> values);

  /// Adds the sample of the part of the series that follows. The evenness stays, the choice is
  /// another than that of the whole series.
  void append(const Subsample& part);

  /// Writes at most `most` values, thinned out further for that.
  void exchange(StateBytes& bytes, std::size_t most);

  [[nodiscard]] View<double> values() const& { return kept_; }
  [[nodiscard]] std::vector<double> values() && { return std::move(kept_); }
  /// Fraction: values of the series per value of the sample.
  [[nodiscard]] double share() const {
    return kept_.empty() ? 1.0 : static_cast<double>(seen_) / static_cast<double>(kept_.size());
  }

 private:
  void halve();

  std::size_t capacity_;
  std::vector<double> kept_;
  std::size_t seen_ = 0;
  std::size_t next_ = 0;  ///< position of the next value to be taken
  unsigned level_ = 0;    ///< k
};

}  // namespace proofmass::signal
