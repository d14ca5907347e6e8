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
  std::vector<bool> used, suspect;
  std::vector<std::optional<double>> leave_one_out;  ///< |f| − 1 by the fit to the others
  std::vector<std::optional<double>> studentised;    ///< over its standard deviation
  std::vector<std::size_t> alike;  ///< poses of which one is bad, but which one cannot be told
};

struct SelectionOptions {
  NormParameters free;
  double noise_dof;
  bool keep_suspects;
};

/// Fits from a robust start, then leaves out the pose whose deleted residual is the least likely
/// (Student's t, p < 0.01 after Bonferroni's correction), or takes back one that was left out
/// wrongly, until none is left. A pose is named only if leaving out another in its place explains
/// the residuals clearly worse (by 9 in units of the noise's variance): with few poses more than
/// parameters the residuals say that one is bad, but not which.
/// Source: R. D. Cook, S. Weisberg, Residuals and Influence in Regression (1982), section 2.2.
/// Errors: those of fit_norm.
[[nodiscard]] Result<PoseSelection> select_poses(View<NormalisedPose> poses,
                                                 const Parameters& start,
                                                 const SelectionOptions& options);

}  // namespace proofmass::calibrate
