#pragma once

#include <array>
#include <cstddef>

#include "proofmass/core/view.hpp"

namespace proofmass::acquire {

/// The step between rows as it usually is, and which steps are too long to be one: told from the
/// last 64. Steps that skip rows (twice, three times the usual one) may be many and count neither
/// for the usual step nor for how much it varies.
class UsualStep {
 public:
  /// The granted one; 0: there is none.
  explicit UsualStep(double granted_s) : granted_s_(granted_s), step_s_(granted_s) {}

  /// A step that nothing known to be missing explains; a hole too.
  void add(double step_s);
  [[nodiscard]] double step_s() const { return step_s_; }  ///< 0: not known yet
  /// Whether a step is so long that rows must be missing. Nothing is within the first 16.
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
  double longest_s_ = 0.0;  ///< that is no hole
  double skips_ = 0.0;      ///< share of steps that are double ones
  std::array<double, memory> recent_{};
  std::size_t count_ = 0;  ///< ever added
};

}  // namespace proofmass::acquire
