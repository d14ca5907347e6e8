#pragma once

#include <cstddef>
#include <vector>

#include "proofmass/core/view.hpp"

namespace proofmass::signal {

/// Detects missing rows among stamps whose single intervals are not conclusive: rounded to about
/// one sample period, or with one stamp per packet of rows. While no row is missing the stamps lie
/// in a band about an even grid, which rounding fills uniformly; a missing row shifts all later
/// stamps by one period. The band follows clock drift, by up to 1/4096 of its width per row.
class StampBand {
 public:
  /// Number of rows that a decision looks ahead.
  static constexpr std::size_t ahead = 16;

  /// Sample period and width of the band, both in the unit of the stamps, > 0.
  StampBand(double step, double width) : step_(step), width_(width) {}

  /// True if the next stamp lies in the band, assuming that no row is missing before it.
  [[nodiscard]] bool holds(double stamp) const;
  /// Rows missing before the first of these, the next stamps (`ahead` of them, fewer at the end):
  /// the number with which most of them lie in the band; 0 unless another number is far better.
  [[nodiscard]] double missing_before(View<double> next) const;
  void take(double stamp, double missing);
  /// Rounded stamps: the part of the width that none of them reached. The period may be off by this
  /// over the duration: with steps of exactly 5/4 of a tick, the stamps are at every fourth of a
  /// tick. 0 for packets, whose band is as wide as the range of their delays.
  [[nodiscard]] double unfilled() const { return is_of_rounding() ? width_ - filled_ : 0.0; }
  /// Sum of the distances of the stamps outside the band.
  [[nodiscard]] double strain() const { return strain_; }

 private:
  [[nodiscard]] double outside(View<double> next, double missing) const;
  [[nodiscard]] bool is_of_rounding() const { return width_ < 2.5 * step_; }

  double step_;
  double width_;
  bool has_begun_ = false;
  double first_ = 0.0;
  double number_ = 0.0;  ///< number of the next sample, missing ones counted
  double low_ = 0.0;     ///< lower edge of the recent stamps minus their even times
  double high_ = 0.0;
  double filled_ = 0.0;  ///< largest difference of the edges
  double strain_ = 0.0;
};

/// Misfit of these stamps to a band with this period: StampBand::strain(), plus a hundredth of a
/// period for each missing row.
[[nodiscard]] double strain_in_band(View<double> stamps, double step, double width);

/// Sample numbers of stamps, from 0, missing ones counted.
[[nodiscard]] std::vector<double> numbers_in_band(View<double> stamps, double step, double width);

}  // namespace proofmass::signal
