#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "proofmass/core/view.hpp"
#include "proofmass/signal/thinned_sample.hpp"

namespace proofmass::signal {

/// The lowest values of a series that comes in pieces, or the highest, each as often as it is read:
/// how many lie close to the extreme is known exactly, as long as they are few.
class ValueTail {
 public:
  enum class Side { lowest, highest };
  static constexpr std::size_t usual_capacity = ThinnedSample::usual_capacity / 32;

  explicit ValueTail(Side side, std::size_t capacity = usual_capacity)
      : sign_(side == Side::lowest ? 1.0 : -1.0), capacity_(capacity) {}

  /// Finite values, and the most extreme of them on this side.
  void add(View<double> values, double extreme);

  /// Of a series that is all in `sample` or in this tail: values within `width` of the extreme, but
  /// not the extreme itself. Beyond the tail's capacity: by the sample.
  [[nodiscard]] double beside(double width, const ThinnedSample& sample) const;

 private:
  void keep(double value);

  double sign_;
  std::size_t capacity_;
  std::vector<double> kept_;                                ///< times sign_
  double below_ = std::numeric_limits<double>::infinity();  ///< only such are still of interest
};

}  // namespace proofmass::signal
