#pragma once

#include <vector>

#include "proofmass/characterise/drift/evidence.hpp"
#include "proofmass/characterise/drift/fit_at_shape.hpp"
#include "proofmass/characterise/drift/noise.hpp"
#include "proofmass/characterise/drift_model.hpp"

namespace proofmass::characterise {

/// Gain of one model over another in twice the log-likelihood, and its p-value.
struct GainTest {
  double deviance = 0.0, p = 1.0;
};

/// All shapes, fitted, each with its own noise: constant, line, steps if there are any, an
/// exponential and, if that explains anything, one with a line, two of them, and their rivals
/// (drift/shapes.hpp). The evidence must outlive it.
class DriftSelection {
 public:
  explicit DriftSelection(const DriftEvidence& evidence);

  /// Level of the test against no exponential.
  static constexpr double level = 0.01;

  /// Constant, line or exponential, which are always present.
  [[nodiscard]] const DriftFitAtShape& of(DriftShape shape) const;

  /// The best of those with an exponential, or of constant, line and steps. A shape with more
  /// parameters than the previous ones must have strong evidence: a criterion lower by 6 (R. E.
  /// Kass, A. E. Raftery, J. Amer. Statist. Assoc. 90 (1995) 773).
  [[nodiscard]] const DriftFitAtShape& best(bool exponential) const;

  /// Non-exponential shapes that may resemble one; none without drift.
  [[nodiscard]] std::vector<const DriftFitAtShape*> rivals() const;

  /// Exponentials, rivals and the line that fit as well as the best of them, the best first: within
  /// 4 by Akaike's criterion, e² in likelihood, or by Schwarz's.
  [[nodiscard]] std::vector<const DriftFitAtShape*> as_good() const;

  static constexpr double clear_margin = 4.0;

  /// Tests the exponential of a trial against the constant or line that remains without it, with
  /// the best of three noises: that of the trial, that of the shape without it, and white noise
  /// with a random walk; p as in drift/fit.hpp.
  [[nodiscard]] GainTest test(const DriftFitAtShape& trial, DriftShape without) const;

  /// Test against the constant with white noise alone, as a plain fit assumes.
  [[nodiscard]] GainTest plain_test(const DriftFitAtShape& trial) const;

  /// A trial with white noise alone, with the random walk that it may hide: the curve absorbs most
  /// of a weak one, whose most likely strength K is then zero. K² is its posterior mean, for a flat
  /// prior of K. Other trials are returned unchanged.
  [[nodiscard]] DriftFitAtShape with_hidden_walk(const DriftFitAtShape& trial) const;

  /// Best first.
  [[nodiscard]] std::vector<DriftCandidate> candidates() const;

 private:
  void add(DriftShape shape);

  const DriftEvidence& evidence_;
  NoiseChoice choice_;
  std::vector<DriftFitAtShape> trials_;
};

}  // namespace proofmass::characterise
