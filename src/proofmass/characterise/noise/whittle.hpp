#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "proofmass/characterise/noise/cosine_ordinates.hpp"

namespace proofmass::characterise {

/// A group of neighbouring spectral values, narrow enough for a linear density.
struct SpectralGroup {
  double frequency_hz = 0.0;
  double density = 0.0;  ///< mean of the two-sided densities, unit²/Hz
  double dof = 0.0;      ///< degrees of freedom of the mean
  /// For a group of one cosine coefficient: its amplitude, and that of a ramp of 1 unit/s; its
  /// density is then amplitude². of_ramp = 0 where a ramp has no effect.
  double amplitude = 0.0, of_ramp = 0.0;
  CosineVector vector = {};  ///< of a group of one cosine coefficient
};

/// Maximum of the likelihood.
struct WhittleFit {
  Eigen::VectorXd strength;  ///< θ, one a column; 0 for those not taken in
  Eigen::VectorXd density;   ///< S = X θ, one a group
  double log_likelihood = 0.0;
  double slope = 0.0, slope_variance = 0.0;  ///< of the ramp; 0 if not determined
};

/// Likelihood of non-negative strengths θ of known spectral shapes X, S = X θ, given independent
/// densities p with ν degrees of freedom each (gamma distributed) and a ramp of unknown slope R:
///
///     ℓ(θ) = −½ Σ ν (ln S + p/S) − ½ ln Σ r²/S,    p = (a − R r)² where the ramp contributes,
///
/// with R at its weighted least squares value; the last term is that of restricted likelihood,
/// which corrects for the fit of R. Maximised by Fisher scoring, each step of which is a
/// non-negative weighted least squares fit of p with weights ν/(2 S²) from the fitted S of the step
/// before: the weights that equivalent degrees of freedom give. Source: P. Whittle, Estimation and
/// information in stationary time series, Ark. Mat. 2 (1953) 423; H. D. Patterson, R. Thompson,
/// Biometrika 58 (1971) 545 (restricted likelihood).
class WhittleLikelihood {
 public:
  /// columns: one row a group, one column a shape, all ≥ 0 and > 0 somewhere in each row.
  WhittleLikelihood(std::vector<SpectralGroup> groups, Eigen::MatrixXd columns);

  /// A strength held at a value while the others are fitted.
  struct Held {
    int column = 0;
    double strength = 0.0;
  };

  /// Maximises over the columns named. `start` is an initial θ.
  [[nodiscard]] WhittleFit maximise(const std::vector<int>& active,
                                    const std::optional<Held>& held = {},
                                    const Eigen::VectorXd& start = {}) const;

  /// The same evidence with a ramp of known slope subtracted, and no slope to estimate.
  [[nodiscard]] WhittleLikelihood at_slope(double slope) const;

  /// The same evidence with the contribution of a wave to each single coefficient subtracted.
  [[nodiscard]] WhittleLikelihood without_wave(const SlowWave& wave) const;

  /// Fisher information of the active strengths at S: ½ Σ ν X Xᵀ / S².
  [[nodiscard]] Eigen::MatrixXd information(const WhittleFit& fit,
                                            const std::vector<int>& active) const;

  /// Fisher information of arbitrary shapes.
  [[nodiscard]] Eigen::MatrixXd information_on(const WhittleFit& fit,
                                               const Eigen::MatrixXd& X) const;

  void set_column(int column, const Eigen::VectorXd& shape) { columns_.col(column) = shape; }

  [[nodiscard]] Eigen::VectorXd column(int column) const { return columns_.col(column); }

  /// Reduces the degrees of freedom as if S itself had this relative variance.
  void allow_misfit(double relative_variance);

  [[nodiscard]] const std::vector<SpectralGroup>& groups() const { return groups_; }
  [[nodiscard]] const Eigen::ArrayXd& dof() const { return dof_; }
  /// p with the ramp of the fit subtracted.
  [[nodiscard]] Eigen::ArrayXd densities(const WhittleFit& fit) const;

 private:
  struct Ramp {
    double slope = 0.0, variance = 0.0;
  };
  struct Ascent;
  [[nodiscard]] Ramp ramp(const Eigen::ArrayXd& S) const;
  [[nodiscard]] double log_likelihood(const Eigen::ArrayXd& S) const;
  [[nodiscard]] Eigen::ArrayXd expected_densities(const Ramp& ramp) const;
  [[nodiscard]] Eigen::ArrayXd smoothed() const;

  std::vector<SpectralGroup> groups_;
  Eigen::MatrixXd columns_;
  Eigen::ArrayXd dof_, raw_, amplitude_, of_ramp_, rough_;
  Eigen::Index ramp_rows_ = 0;  ///< the ramp reaches none of the later groups
};

}  // namespace proofmass::characterise
