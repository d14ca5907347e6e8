#pragma once

#include <optional>

#include "proofmass/calibrate/tumble_coefficients.hpp"

// What the residuals of a tumble tell.
namespace proofmass::calibrate {

/// Residuals with what a fit to the other positions would make of each,
///
///     t = r/s(r) √((ν − 1)/(ν − (r/s(r))²))   with ν = dof, where sigma is of the residuals,
///
/// or r/s(r) of a stated noise. A position is suspect where so much would be chance in one of a
/// hundred tests (Bonferroni's bound over the positions).
/// Source: R. D. Cook, S. Weisberg, Residuals and Influence in Regression (1982), 2.2.
void find_residuals(const TumbleSolution& solution, View<TumblePosition> positions, TumbleFit& fit);

/// Against the stated noise, χ² or F; else against the scatter of repeated positions,
/// F = ((rss − rss_r)/(ν − ν_r))/(rss_r/ν_r), rss_r about a level for each position that was
/// visited (same angle, mounting and direction) and the drift. Absent where neither is there.
/// Source: N. R. Draper, H. Smith, Applied Regression Analysis, 3rd ed. (1998), 2.1.
[[nodiscard]] std::optional<TumbleLackOfFit> find_lack_of_fit(const TumbleSolution& solution,
                                                              View<TumblePosition> positions,
                                                              const Eigen::VectorXd& outputs);

/// The drift as fitted, or as the two visits of one position show it, or that it is not known.
[[nodiscard]] TumbleDrift find_drift(const TumbleSolution& solution,
                                     View<TumblePosition> positions,
                                     const TumbleFit& fit);

}  // namespace proofmass::calibrate
