#pragma once

#include <optional>
#include <vector>

#include "proofmass/calibrate/multi_position.hpp"
#include "proofmass/calibrate/norm_fit.hpp"

// Which poses belong together, and how large the noise is that they are judged by.
namespace proofmass::calibrate {

/// By what the variances of the means have to be multiplied, and how well that is known.
struct Scatter {
  double factor = 0.0;
  double dof = 0.0;  ///< of the factor; 0: it is not known
  std::optional<LackOfFit> lack_of_fit;
};

/// From Σ residual²/variance with `dof` degrees of freedom, and the noise_dof of the variances (0:
/// only their ratios are known). Where both are known and F = rss/dof is what noise makes in one of
/// twenty cases or oftener, they are pooled; else the residuals alone count.
[[nodiscard]] Scatter scatter_of(double rss, double dof, double noise_dof);

struct PoseSelection {
  NormFit fit;
  Scatter scatter;
  /// Of all poses but the suspect ones; that of scatter where no others are alike.
  std::optional<LackOfFit> lack_of_fit;
  ResidualWeights weights;  ///< of those used
  std::vector<bool> used, suspect;
  std::vector<std::optional<double>> leave_one_out;  ///< |f| − 1 by the fit to the others
  std::vector<std::optional<double>> studentised;    ///< over its standard deviation
  /// The least error in |f| of each pose that would have been noticed.
  std::vector<std::optional<double>> detectable;
  std::vector<std::size_t> alike;  ///< poses of which some are bad, but which cannot be told
  /// Of the free parameters, by that: how they scatter with the choice. Empty: there is none.
  Eigen::MatrixXd by_choice;
};

struct SelectionOptions {
  NormParameters free;
  double noise_dof;
  bool keep_suspects;
};

/// Finds the fewest poses without which the others agree. Every pose and every pair of poses is a
/// hypothesis, by the fit to the others; a set of more is looked for by least trimmed squares where
/// two do not explain the residuals. A set is taken for bad where it lowers Σ residual²/variance by
/// more than chance does: Fisher's F against the noise that remains, p < 0.01 after Bonferroni's
/// correction for the number of such sets.
///
/// Sets of the same size that explain the residuals as well, within 9 in units of the noise's
/// variance, cannot be told from it. A pose is suspect only if all of them hold it; the others of
/// them are `alike`. The fit is then the mean of the fits without each set, all counting the same,
/// and by_choice is their covariance. Where no pose is suspect, yet chance explains the residuals
/// in one of twenty cases at most, the fits without each that may be bad and the fit to all are
/// put together in the same way.
///
/// An error that would be noticed (power 80 % at 0.1 %) is 4.13 standard deviations of its
/// estimate. Source: W. Baarda, A testing procedure for use in geodetic networks (1968).
/// Errors: those of fit_norm.
[[nodiscard]] Result<PoseSelection> select_poses(const NormData& data,
                                                 const Parameters& start,
                                                 const SelectionOptions& options);

}  // namespace proofmass::calibrate
