#pragma once

#include <cstddef>
#include <vector>

#include "proofmass/core/view.hpp"

namespace proofmass::signal {

/// Says where rows are missing among stamps whose single steps do not tell: rounded to about a step
/// of the samples, or with one stamp for a packet of rows. As long as no row is missing the stamps
/// lie in a band about evenly spaced instants, and rounding fills it evenly; a missing row lifts
/// all stamps behind it by one step. The band follows a clock that wanders, by up to 1/4096 of its
/// width a row.
class StampBand {
 public:
  /// Rows that a decision looks ahead.
  static constexpr std::size_t ahead = 16;

  /// Step of the samples and width of the band, both in the unit of the stamps, > 0.
  StampBand(double step, double width) : step_(step), width_(width) {}

  /// Whether the next stamp lies in the band if no row is missing before it.
  [[nodiscard]] bool holds(double stamp) const;
  /// Rows missing before the first of these, the next stamps (`ahead` of them, fewer at the end):
  /// the number with which most of them lie in the band; 0 unless that is better by far.
  [[nodiscard]] double missing_before(View<double> next) const;
  void take(double stamp, double missing);
  /// How far outside the band the stamps were that were taken, in sum.
  [[nodiscard]] double strain() const { return strain_; }

 private:
  [[nodiscard]] double outside(View<double> next, double missing) const;

  double step_;
  double width_;
  bool has_begun_ = false;
  double first_ = 0.0;
  double number_ = 0.0;  ///< of the sample that comes next, missing ones counted
  double low_ = 0.0;     ///< of the stamps less their even instants, as of late
  double high_ = 0.0;
  double strain_ = 0.0;
};

/// How badly these stamps lie in a band with this step: StampBand::strain(), and a hundredth of a
/// step for each missing row.
[[nodiscard]] double strain_in_band(View<double> stamps, double step, double width);

/// Sample numbers of stamps, from 0, missing ones counted.
[[nodiscard]] std::vector<double> numbers_in_band(View<double> stamps, double step, double width);

}  // namespace proofmass::signal
