#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "proofmass/characterise/drift/evidence.hpp"
#include "proofmass/characterise/noise/ordinate_likelihood.hpp"
#include "proofmass/characterise/noise_model.hpp"

namespace proofmass::characterise {

/// Noise terms of a drift, as columns of densities at k ≥ 1.
struct NoiseColumns {
  Eigen::MatrixXd P;
  std::vector<Term> terms;  ///< of each column
  double markov_time_constant_s = 0.0;

  /// Number of parameters of the noise.
  [[nodiscard]] int parameters() const;
  /// Strength of a term in a fit; 0 if it has no column.
  [[nodiscard]] double strength(const OrdinateFit& fit, Term term) const;
};

/// Selection of the noise model of a drift.
class NoiseChoice {
 public:
  explicit NoiseChoice(const DriftEvidence& evidence);

  /// White noise and a random walk, which are always present before the selection.
  [[nodiscard]] const NoiseColumns& base() const { return base_; }

  [[nodiscard]] const NoiseColumns& white() const { return white_; }

  /// White noise and a random walk, with flicker, with first-order Markov noise or with both:
  /// flicker if it gains 6 in twice the log-likelihood, a Markov term if it gains 16, as in
  /// noise_fit.hpp, the more likely of the two; without those estimated as zero. If terms
  /// explain as much, the random walk is kept: over the length of the recording it contributes
  /// most, so the interval is conservative.
  [[nodiscard]] NoiseColumns choose(const Eigen::VectorXd& z, const OrdinateMeans& means) const;

  /// A choice with white noise and random walk added back.
  [[nodiscard]] NoiseColumns with_base(const NoiseColumns& columns) const;

  /// Without the columns whose strength is zero.
  [[nodiscard]] static NoiseColumns kept(const NoiseColumns& columns, const OrdinateFit& fit);

 private:
  [[nodiscard]] Eigen::VectorXd column(Term term, double time_constant_s = 0.0) const;
  [[nodiscard]] NoiseColumns with(const NoiseColumns& columns,
                                  Term term,
                                  double time_constant_s = 0.0) const;
  struct Option {
    NoiseColumns columns;
    OrdinateFit fit;
  };
  [[nodiscard]] Option option(NoiseColumns columns,
                              const Eigen::VectorXd& z,
                              const OrdinateMeans& means,
                              const Eigen::VectorXd& start = {}) const;
  [[nodiscard]] std::optional<Option> with_markov(const Option& beside,
                                                  const Eigen::VectorXd& z,
                                                  const OrdinateMeans& means) const;
  [[nodiscard]] std::optional<Option> with_flicker(const Option& beside,
                                                   const Eigen::VectorXd& z,
                                                   const OrdinateMeans& means) const;

  const DriftEvidence& evidence_;
  NoiseColumns white_, base_;
  Eigen::VectorXd flicker_;
  std::vector<Eigen::VectorXd> markov_;
  std::vector<double> markov_times_s_;
};

}  // namespace proofmass::characterise
