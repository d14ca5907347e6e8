#pragma once

#include <optional>

#include "proofmass/calibrate/tumble/coefficients.hpp"

// Residual analysis of a tumble.
namespace proofmass::calibrate {

/// Residuals, and studentised deletion residuals,
///
///     t = r/s(r) √((ν − 1)/(ν − (r/s(r))²))   with ν = dof, if sigma is from the residuals,
///
/// or r/s(r) with a stated noise. A position is suspect if that is significant at 1 % (Bonferroni
/// over the positions). Source: R. D. Cook, S. Weisberg, Residuals and Influence in Regression
/// (1982), 2.2.
void find_residuals(const TumbleSolution& solution, View<TumblePosition> positions, TumbleFit& fit);

/// Against the stated noise, χ² or F; else against the scatter of repeated positions, F = ((rss −
/// rss_r)/(ν − ν_r))/(rss_r/ν_r), rss_r about a level for each position that was visited (same
/// angle, mounting and direction) and the drift. Absent if neither is available. Source: N. R.
/// Draper, H. Smith, Applied Regression Analysis, 3rd ed. (1998), 2.1.
[[nodiscard]] std::optional<TumbleLackOfFit> find_lack_of_fit(const TumbleSolution& solution,
                                                              View<TumblePosition> positions,
                                                              const Eigen::VectorXd& outputs);

/// The drift as fitted, or from the two visits of one position, or unknown.
[[nodiscard]] TumbleDrift find_drift(const TumbleSolution& solution,
                                     View<TumblePosition> positions,
                                     const TumbleFit& fit);

}  // namespace proofmass::calibrate
