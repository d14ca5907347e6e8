#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "proofmass/calibrate/multi_position/norm_fit.hpp"
#include "proofmass/calibrate/multi_position/pose_shifts.hpp"

// Hypotheses on bad poses: sets of them, ranked by the fit of the others.
namespace proofmass::calibrate {

class PoseHypotheses {
 public:
  /// `full` is the fit to all poses. The arguments must outlive the hypotheses.
  PoseHypotheses(const NormData& data, NormParameters free, const NormFit& full);

  /// The fit without these poses; null if the others do not determine the parameters.
  [[nodiscard]] const NormFit* without(const PoseSet& out);

  /// Sets of one or two poses, by exhaustive search: those without which the others fit best, the
  /// best first. Linearised about the fit to all and about a robust fit, then fitted.
  [[nodiscard]] std::vector<PoseSet> best(std::size_t size);

  /// The smallest Σ residual²/variance without this many, from the linear model: no fit is made.
  [[nodiscard]] std::optional<double> linear_rss(std::size_t size) const;

  /// Sets of the same size as `best` without which Σ residual²/variance is at most `rss`: all sets
  /// of one or two poses, of more those with one pose exchanged. `best` comes first.
  [[nodiscard]] std::vector<PoseSet> alike(const PoseSet& best, double rss);

  /// Poses outside the least trimmed squares: if more than two are bad, starts from many subsets
  /// find what a start from all does not. At most `most` of them. Source: P. J. Rousseeuw, K. Van
  /// Driessen, Data Mining and Knowledge Discovery 12 (2006) 29.
  [[nodiscard]] PoseSet trimmed(std::size_t most) const;

  /// Whether a robust fit has outliers.
  [[nodiscard]] bool suspicious() const { return suspicious_; }

  /// The linear model at the fit without these poses, all lengths known.
  [[nodiscard]] PoseShifts shifts(const NormFit& fit) const;

 private:
  [[nodiscard]] std::vector<PoseSet> fitted(const std::vector<PoseSet>& sets);

  const NormData& data_;
  NormParameters free_;
  const NormFit& full_;
  bool suspicious_ = false;
  std::vector<PoseShifts> points_;
  std::map<PoseSet, std::optional<NormFit>> fits_;
};

}  // namespace proofmass::calibrate
