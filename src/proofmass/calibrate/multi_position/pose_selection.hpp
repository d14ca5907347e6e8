#pragma once

#include <optional>
#include <vector>

#include "proofmass/calibrate/multi_position.hpp"
#include "proofmass/calibrate/multi_position/norm_fit.hpp"

// Which poses are consistent, and the noise by which they are tested.
namespace proofmass::calibrate {

/// Factor on the variances of the means, and its degrees of freedom.
struct Scatter {
  double factor = 0.0;
  double dof = 0.0;  ///< of the factor; 0: unknown
  std::optional<LackOfFit> lack_of_fit;
};

/// From Σ residual²/variance with `dof` degrees of freedom, and the noise_dof of the variances (0:
/// only their ratios are known). If both are known and F = rss/dof is not significant at 5 %, they
/// are pooled; else the residuals alone count.
[[nodiscard]] Scatter scatter_of(double rss, double dof, double noise_dof);

struct PoseSelection {
  NormFit fit;
  Scatter scatter;
  /// Over all but the suspect poses; that of scatter if no others are alike.
  std::optional<LackOfFit> lack_of_fit;
  ResidualWeights weights;  ///< of those used
  std::vector<bool> used, suspect;
  std::vector<std::optional<double>> leave_one_out;  ///< |f| − 1 by the fit to the others
  std::vector<std::optional<double>> studentised;    ///< over its standard deviation
  /// The smallest detectable error in |f| of each pose.
  std::vector<std::optional<double>> detectable;
  std::vector<std::size_t> alike;  ///< poses of which some are bad, not identifiable
  /// Covariance of the free parameters due to that ambiguity. Empty: none.
  Eigen::MatrixXd by_choice;
};

struct SelectionOptions {
  NormParameters free;
  double noise_dof;
  bool keep_suspects;
};

/// Finds the smallest set of poses without which the others agree. Every pose and every pair of
/// poses is a hypothesis, by the fit to the others; a larger set is searched by least trimmed
/// squares if two do not explain the residuals. A set is bad if it lowers Σ residual²/variance
/// significantly: F-test against the remaining noise, p < 0.01 with Bonferroni's correction for the
/// number of such sets.
///
/// - Sets of the same size that explain the residuals as well, within 9 in units of the noise's
///   variance, are not distinguishable. A pose is suspect only if all of them contain it; their
///   other poses are `alike`. The fit is then the unweighted mean of the fits without each set, and
///   by_choice is their covariance.
/// - If no pose is suspect, but the residuals are significant at 5 %, the fits without each
///   possibly bad pose and the fit to all are combined in the same way.
/// - A detectable error (power 80 % at 0.1 %) is 4.13 standard deviations of its estimate.
///
/// Source: W. Baarda, A testing procedure for use in geodetic networks (1968). Errors: those of
/// fit_norm.
[[nodiscard]] Result<PoseSelection> select_poses(const NormData& data,
                                                 const Parameters& start,
                                                 const SelectionOptions& options);

}  // namespace proofmass::calibrate
