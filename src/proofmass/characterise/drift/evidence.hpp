#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <vector>

#include "proofmass/characterise/noise/term_spectra.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/core/view.hpp"

namespace proofmass::characterise {

/// Cosine-transform coefficients k = 0 … n − 1 of the means over successive blocks, and of all
/// components of a drift. The coefficients are independent for any noise at rest (BlockMeans); a
/// squared coefficient is a two-sided density.
///
/// A missing block holds an arbitrary value and has its own column, whose coefficient is fitted:
/// that gives the least squares, and the restricted likelihood, of the available blocks. Source: D.
/// Harville, J. Amer. Statist. Assoc. 72 (1977) 320, section 3; M. S. Bartlett, Some examples of
/// statistical methods of research in agriculture, J. Roy. Statist. Soc. Suppl. 4 (1937) 137, for
/// the device.
class DriftEvidence {
 public:
  /// Errors: too_few_samples (fewer than 12 blocks, or more than half of them missing).
  static Result<DriftEvidence> make(View<double> block_means,
                                    const Sampling& sampling,
                                    double start_s);

  static constexpr std::size_t fewest_blocks = 12;

  [[nodiscard]] Eigen::Index blocks() const { return n_; }
  [[nodiscard]] double block_s() const { return sampling_.step_s(); }
  [[nodiscard]] double start_s() const { return start_s_; }
  [[nodiscard]] double duration_s() const { return static_cast<double>(n_) * block_s(); }
  [[nodiscard]] double end_s() const { return start_s_ + duration_s(); }
  [[nodiscard]] const Sampling& sampling() const { return sampling_; }
  [[nodiscard]] double frequency_hz(Eigen::Index k) const {
    return static_cast<double>(k) / (2.0 * duration_s());
  }
  [[nodiscard]] const std::vector<std::size_t>& missing() const { return missing_; }

  /// Ordinates of the data.
  [[nodiscard]] const Eigen::VectorXd& ordinates() const { return z_; }
  /// Those at k ≥ 1, which do not depend on the level.
  [[nodiscard]] Eigen::VectorXd contrasts() const { return z_.tail(n_ - 1); }
  /// One column for each missing block.
  [[nodiscard]] const Eigen::MatrixXd& dummies() const { return dummies_; }
  /// Ordinates of 1 − e^(−t/T), and of its derivative by ln T.
  [[nodiscard]] Eigen::VectorXd rise(double time_constant_s) const;
  [[nodiscard]] Eigen::VectorXd rise_by_log_time(double time_constant_s) const;
  /// Ordinates of any curve of the time, as means over blocks: over their samples if these are few.
  [[nodiscard]] Eigen::VectorXd of(const std::function<double(double)>& curve) const;
  /// Ordinates of t / duration.
  [[nodiscard]] const Eigen::VectorXd& line() const { return line_; }
  /// Ordinates of a step of height 1 at the beginning of a block.
  [[nodiscard]] Eigen::VectorXd step(std::size_t block) const;
  /// Weights of the ordinates in the value at a time of the transformed series.
  [[nodiscard]] Eigen::VectorXd at(double t_s) const;
  /// The block values of the given coefficients.
  [[nodiscard]] std::vector<double> series(const Eigen::VectorXd& ordinates) const;

 private:
  DriftEvidence(const Sampling& sampling, double start_s)
      : sampling_(sampling), start_s_(start_s) {}

  Eigen::Index n_ = 0;
  Sampling sampling_;
  double start_s_;
  std::vector<std::size_t> missing_;
  std::vector<double> sines_;                ///< of multiples of π/2n, a full turn
  Eigen::VectorXd half_sine_, half_cosine_;  ///< of π k/2n
  Eigen::VectorXd z_, line_;
  Eigen::MatrixXd dummies_;
};

}  // namespace proofmass::characterise
