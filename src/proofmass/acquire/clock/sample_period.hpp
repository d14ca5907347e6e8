#pragma once

#include <array>
#include <cstddef>

#include "proofmass/core/view.hpp"

namespace proofmass::acquire {

/// The typical interval between rows, and the detection of intervals that are too long, from the
/// last 64. Intervals that skip rows (two, three times the typical one) may be frequent and affect
/// neither the typical interval nor its scatter.
class SamplePeriod {
 public:
  /// The granted interval; 0: none.
  explicit SamplePeriod(double granted_s) : granted_s_(granted_s), step_s_(granted_s) {}

  /// An interval not explained by known missing rows; possibly a hole.
  void add(double step_s);
  [[nodiscard]] double step_s() const { return step_s_; }  ///< 0: not known yet
  /// True if an interval is so long that rows must be missing. Never within the first 16.
  [[nodiscard]] bool is_hole(double step_s) const;

 private:
  void learn();
  [[nodiscard]] View<double> recent() const;
  [[nodiscard]] bool is_by_grant() const;
  void learn_skips();
  void learn_irregular();

  static constexpr std::size_t memory = 64;
  double granted_s_;
  double step_s_;
  double longest_s_ = 0.0;  ///< longest interval that is not a hole
  double skips_ = 0.0;      ///< fraction of intervals that are double
  std::array<double, memory> recent_{};
  std::size_t count_ = 0;  ///< total added
};

}  // namespace proofmass::acquire
