#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/core/state_bytes.hpp"
#include "proofmass/core/view.hpp"
#include "proofmass/signal/audit/subsample.hpp"
#include "proofmass/signal/clipping_tail.hpp"

namespace proofmass::characterise {

/// Overview of a series in blocks, with the checks whether its noise can be the sensor's. NaN and
/// infinities are missing.
class RecordOverview {
 public:
  /// first: number of samples of the whole series before this part.
  explicit RecordOverview(std::size_t first = 0) : before_(first % block) {}

  void add(View<double> samples);

  /// Adds the part that follows.
  void append(const RecordOverview& part);

  /// Fails where the state read is not that of such a part.
  void exchange(StateBytes& bytes);

  [[nodiscard]] std::size_t samples() const { return samples_; }
  [[nodiscard]] std::size_t missing() const { return missing_; }
  [[nodiscard]] double mean() const;
  /// Standard deviation about the means of blocks short enough for drift to be negligible.
  [[nodiscard]] double short_term_std() const;

  /// Errors: not_finite (no sample is a number), not_observable (the samples are constant, vary
  /// beyond the numerical range, or vary by less than half a quantisation step).
  [[nodiscard]] Status check_spread(std::optional<double> lsb) const;
  /// Errors: not_observable (clipped). A ClippingTail counts the samples next to a rail.
  [[nodiscard]] Status check_rails(std::optional<double> lsb) const;

 private:
  static constexpr std::size_t block = 64;

  struct Sums {
    double total = 0.0, squares = 0.0, count = 0.0;  ///< squares: about the block's mean
  };
  struct Extreme {
    double value = 0.0;
    std::size_t count = 0;  ///< samples with exactly this value
  };

  void add_sums(View<double> samples);
  void add_block(View<double> samples);
  /// Sums over the finite samples of a block, complete or not.
  [[nodiscard]] static Sums sums_of(View<double> samples);
  void add_extremes(const RecordOverview& part);
  void look_at_extremes(View<double> finite);

  std::size_t before_;  ///< samples of the first block that are before this part
  std::size_t samples_ = 0, missing_ = 0;
  double total_ = 0.0, squares_ = 0.0, freedom_ = 0.0;
  std::vector<double> head_;  ///< of the first block, if it begins before this part
  std::vector<double> open_;  ///< of the last block, if it is not complete
  Extreme low_{.value = std::numeric_limits<double>::infinity()};
  Extreme high_{.value = -std::numeric_limits<double>::infinity()};
  signal::Subsample sample_;
  signal::ClippingTail lowest_{signal::ClippingTail::Side::lowest};
  signal::ClippingTail highest_{signal::ClippingTail::Side::highest};
  std::vector<double> finite_;  ///< finite values of the inspected samples
};

}  // namespace proofmass::characterise
