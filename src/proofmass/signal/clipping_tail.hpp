#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "proofmass/core/state_bytes.hpp"
#include "proofmass/core/view.hpp"
#include "proofmass/signal/audit/subsample.hpp"

namespace proofmass::signal {

/// The lowest values of a series in blocks, or the highest, with repetitions: the number of values
/// close to the extreme is exact as long as it is small.
class ClippingTail {
 public:
  enum class Side { lowest, highest };
  static constexpr std::size_t usual_capacity = Subsample::usual_capacity / 32;

  explicit ClippingTail(Side side, std::size_t capacity = usual_capacity)
      : sign_(side == Side::lowest ? 1.0 : -1.0), capacity_(capacity) {}

  /// Adds finite values; `extreme` is the most extreme of them on this side.
  void add(View<double> values, double extreme);

  /// Adds the tail of another part of the series.
  void append(const ClippingTail& part);

  void exchange(StateBytes& bytes);

  /// For a series that is entirely in `sample` or in this tail: number of values within `width` of
  /// the extreme, excluding the extreme itself. Beyond the tail's capacity: estimated from the
  /// sample.
  [[nodiscard]] double beside(double width, const Subsample& sample) const;

  /// How often the most frequent of the eight values next to the extreme occurs; of the same
  /// series. 0 if all values are equal.
  [[nodiscard]] double most_frequent_beside(const Subsample& sample) const;

 private:
  void keep(double value);
  void trim();

  double sign_;
  std::size_t capacity_;
  std::vector<double> kept_;                                ///< multiplied by sign_
  double below_ = std::numeric_limits<double>::infinity();  ///< limit of relevant values
};

}  // namespace proofmass::signal
