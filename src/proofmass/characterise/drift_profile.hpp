#pragma once

#include <optional>
#include <vector>

#include "proofmass/characterise/drift_evidence.hpp"
#include "proofmass/characterise/drift_model.hpp"
#include "proofmass/characterise/drift_trial.hpp"

namespace proofmass::characterise {

/// Intervals of an exponential's amplitude and time constant by adjusted profile likelihood: what
/// twice the log-likelihood loses when the value is held and all else fitted anew, the strengths of
/// the noise too. Of terms of the noise that came out at nothing none is brought back.
///
/// The loss is counted up to (ν + 1) ln(1 + t²/ν), t the 97.5 % quantile of Student's distribution:
/// what bounds the mean of normal values whose variance is known to ν degrees of freedom, 3.84
/// where that is many. Of a drift in a random walk of which the record shows few independent pieces
/// it is 4 to 6. ν is Satterthwaite's, 2 v²/var(v) of the variance v of the value given the
/// strengths. Source: as of fit_ordinates; S. S. Wilks, Ann. Math. Statist. 9 (1938) 60; F. E.
/// Satterthwaite, Biometrics Bull. 2 (1946) 110.
class DriftProfile {
 public:
  DriftProfile(const DriftEvidence& evidence, const DriftTrial& trial);

  /// Loss with the first time constant held.
  [[nodiscard]] double of_log_time(double log_time) const;
  /// Loss with the first amplitude held.
  [[nodiscard]] double of_amplitude(double amplitude) const;

  /// Degrees of freedom to which the noise behind the amplitude is known.
  [[nodiscard]] double amplitude_dof() const { return amplitude_dof_; }

  /// Ends that the range of time constants does not reach are missing.
  [[nodiscard]] Interval95 time_constant(double std_of_log) const;
  [[nodiscard]] Interval95 amplitude(double std) const;

  /// The loss at time constants about the interval, ascending.
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
  const DriftTrial& trial_;
  Eigen::MatrixXd adjusting_;
  double top_ = 0.0;
  std::vector<double> reach_;  ///< how far each ln T is looked for from its best value
  double slope_ = 0.0;         ///< of ln T with the amplitude
  double amplitude_dof_ = 0.0, time_dof_ = 0.0;
};

}  // namespace proofmass::characterise
