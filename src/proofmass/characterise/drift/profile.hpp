#pragma once

#include <optional>
#include <vector>

#include "proofmass/characterise/drift/evidence.hpp"
#include "proofmass/characterise/drift/fit_at_shape.hpp"
#include "proofmass/characterise/drift_model.hpp"

namespace proofmass::characterise {

/// Intervals of an exponential's amplitude and time constant by adjusted profile likelihood: the
/// loss in twice the log-likelihood when the value is held and all else refitted, including the
/// noise strengths. Noise terms estimated as zero are not added back.
///
/// The loss is bounded by (ν + 1) ln(1 + t²/ν), t the 97.5 % quantile of Student's distribution:
/// the bound for the mean of normal values whose variance has ν degrees of freedom, 3.84 for large
/// ν, 4 to 6 for a drift in a random walk with few independent parts in the record. ν is
/// Satterthwaite's, 2 v²/var(v) of the variance v of the value given the strengths. Source: as for
/// fit_ordinates; S. S. Wilks, Ann. Math. Statist. 9 (1938) 60; F. E. Satterthwaite, Biometrics
/// Bull. 2 (1946) 110.
class DriftProfile {
 public:
  DriftProfile(const DriftEvidence& evidence, const DriftFitAtShape& trial);

  /// Loss with the first time constant held.
  [[nodiscard]] double of_log_time(double log_time) const;
  /// Loss with the first amplitude held.
  [[nodiscard]] double of_amplitude(double amplitude) const;

  /// Degrees of freedom of the amplitude's noise.
  [[nodiscard]] double amplitude_dof() const { return amplitude_dof_; }

  /// Ends outside the range of time constants are absent.
  [[nodiscard]] Interval95 time_constant(double std_of_log) const;
  [[nodiscard]] Interval95 amplitude(double std) const;

  /// The loss at time constants around the interval, ascending.
  [[nodiscard]] std::vector<ProfilePoint> points(const Interval95& interval) const;

 private:
  struct Held {
    std::optional<double> log_time, amplitude;
  };
  [[nodiscard]] double loss(const Held& held, const ShapeAt& at) const;
  [[nodiscard]] double least_loss(const Held& held,
                                  const ShapeAt& at,
                                  std::size_t first_free) const;

  const DriftEvidence& evidence_;
  const DriftFitAtShape& trial_;
  Eigen::MatrixXd adjusting_;
  double top_ = 0.0;
  std::vector<double> reach_;  ///< how far each ln T is looked for from its best value
  double slope_ = 0.0;         ///< of ln T with the amplitude
  double amplitude_dof_ = 0.0, time_dof_ = 0.0;
};

}  // namespace proofmass::characterise
