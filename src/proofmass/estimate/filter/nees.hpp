#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "proofmass/core/chi_square.hpp"

// Tests stated covariances with runs against a known truth.
namespace proofmass::estimate {

/// eᵀ P⁻¹ e, the normalised estimation error squared: chi-square with as many degrees of freedom as
/// states, if P is correct. P positive definite.
[[nodiscard]] double normalised_error_squared(const Eigen::VectorXd& error,
                                              const Eigen::MatrixXd& cov);

/// 95 % limits of its mean over independent runs: M = 50 runs of n = 4 states give [3.25, 4.82].
/// Epochs of one run are not independent and must not be counted as runs. Source: Bar-Shalom, Li,
/// Kirubarajan, Estimation with Applications (2001), section 5.4.2.
[[nodiscard]] Bounds mean_nees_95(std::size_t runs, std::size_t states);

/// Limits that contain, with at least 95 % probability, the share of `runs` independent runs whose
/// error lies inside a band of coverage p: quantiles of the binomial distribution. 1000 runs of a
/// 95 % band: [0.936, 0.963]. Cost: O(runs).
[[nodiscard]] Bounds share_inside_95(std::size_t runs, double p);

/// Errors over independent runs compared with their stated covariances.
struct NeesTally {
  std::size_t runs = 0;
  std::size_t states = 0;
  double sum = 0.0;
  std::size_t entries_inside_95 = 0;  ///< |e_i| ≤ 1.96 √P_ii

  void add(const Eigen::VectorXd& error, const Eigen::MatrixXd& cov);
  [[nodiscard]] double mean() const { return sum / static_cast<double>(runs); }
  [[nodiscard]] Bounds bounds() const { return mean_nees_95(runs, states); }
  [[nodiscard]] bool inside() const { return mean() >= bounds().lower && mean() <= bounds().upper; }
  /// Share of the states' errors inside their 95 % bands.
  [[nodiscard]] double coverage() const {
    return static_cast<double>(entries_inside_95) / static_cast<double>(runs * states);
  }
};

}  // namespace proofmass::estimate
