#include "proofmass/calibrate/tumble/components.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "proofmass/core/chi_square.hpp"
#include "proofmass/core/linalg.hpp"

namespace proofmass::calibrate {
namespace {

constexpr double fits_p = 0.01;    // p-value below which the stated noise is too small
constexpr double allowed = 1.353;  // decrease of ln L from its maximum: one-sided 95 %
constexpr double decisive = 4.0;   // difference in ln L that decides between two explanations
constexpr double exceeded = 0.5;   // decrease of ln L if the residuals exceed the assumption

/// Sizes and their ln L.
struct Likely {
  TumbleSizes sizes;
  double log_likelihood = 0.0;
};

/// Restricted likelihood as a function of the sizes.
class SizeSearch {
 public:
  SizeSearch(const Eigen::MatrixXd& A, const Eigen::VectorXd& y, const TumbleErrors& errors)
      : A_(A), y_(y), errors_(errors) {
    plain_chi_square_ = solve_tumble(A, y, errors, {}).chi_square;
    scatter_ = std::sqrt(plain_chi_square_ / dof());
    // Units of angle and drift that correspond to the noise or, if larger, to the residuals.
    const double noise = errors.noise_known ? std::max(1.0, scatter_) : scatter_;
    const double output = noise * errors.noise_std.mean();
    const double lever = errors.lever.cwiseAbs().maxCoeff();
    // A stated noise has a factor of at least 1.
    constexpr double above_lowest = 31.6227766;
    unit_ = {.noise = errors.noise_known ? above_lowest : noise,
             .indexing_rad = lever > 0.0 ? output / lever : 0.0,
             .drift = output};
  }

  /// Square root of χ² per degree of freedom with the stated noise alone.
  [[nodiscard]] double scatter() const { return scatter_; }

  /// No assumed error; the noise as stated, or that of the residuals.
  [[nodiscard]] Likely without_assumed() const {
    const TumbleSizes sizes{
        .noise = errors_.noise_known ? 1.0 : scatter_,
        .indexing_rad = errors_.indexing_assumed ? 0.0 : errors_.indexing_std_rad,
        .drift = errors_.drift_assumed ? 0.0 : errors_.drift_std};
    return {sizes, of(sizes)};
  }

  /// Maximises over the assumed sizes and, with `noise`, over the noise.
  void climb(Likely& at, bool noise) const {
    constexpr int rounds = 3;
    for (int round = 0; round < rounds; ++round) {
      if (errors_.indexing_assumed) climb(&TumbleSizes::indexing_rad, at);
      if (errors_.drift_assumed) climb(&TumbleSizes::drift, at);
      if (noise) climb(&TumbleSizes::noise, at);
    }
  }

  /// Factor on a stated noise; raises the noise of `at` with it where no other size explains the
  /// residuals.
  [[nodiscard]] double noise_factor(Likely& at) const {
    if (misfits(solve_tumble(A_, y_, errors_, at.sizes).chi_square)) {
      climb(at, true);
      return at.sizes.noise;
    }
    TumbleSizes scattered = without_assumed().sizes;
    scattered.noise = scatter_;
    // A larger noise of all positions explains the residuals nearly as well, which indicates an
    // outlier: the noise is increased as well.
    const bool outlier = misfits(plain_chi_square_) && at.log_likelihood - of(scattered) < decisive;
    return outlier ? std::max(scatter_, 1.0) : 1.0;
  }

  /// Value to use for an assumed size.
  [[nodiscard]] double judged(double TumbleSizes::* size, const Likely& at, double assumed) const {
    constexpr double far = 1e4;
    const double found = at.sizes.*size;
    if (found > assumed) return highest(size, at, exceeded, far * std::max(found, unit_.*size));
    return highest(size, at, allowed, assumed);
  }

 private:
  [[nodiscard]] double dof() const { return static_cast<double>(A_.rows() - A_.cols()); }

  /// ln L, minus 2 if the bias drift exceeds the assumption: errors of the angles alone are the
  /// simpler explanation of large residuals.
  [[nodiscard]] double of(const TumbleSizes& sizes) const {
    constexpr double simpler = 2.0;
    const bool beyond = errors_.drift_assumed && sizes.drift > 1.001 * errors_.drift_std;
    return solve_tumble(A_, y_, errors_, sizes).log_likelihood - (beyond ? simpler : 0.0);
  }

  /// True if the noise does not explain this χ².
  [[nodiscard]] bool misfits(double chi_square) const {
    return (errors_.noise_dof > 0.0 ? fisher_f_p(chi_square / dof(), dof(), errors_.noise_dof)
                                    : chi_square_p(chi_square, dof())) < fits_p;
  }

  /// Takes one size's value where that is more likely.
  void consider(double TumbleSizes::* size, double value, TumbleSizes from, Likely& at) const {
    from.*size = value;
    const double log_likelihood = of(from);
    if (log_likelihood > at.log_likelihood) at = {from, log_likelihood};
  }

  /// Maximises over one size, the others fixed: over zero and 10^(−1.5 … 2.5) units, then on a
  /// finer grid about the best value.
  void climb(double TumbleSizes::* size, Likely& at) const {
    constexpr int steps = 16;
    const TumbleSizes from = at.sizes;
    const bool is_noise = size == &TumbleSizes::noise;
    if (!is_noise) consider(size, 0.0, from, at);
    for (int k = 0; k <= steps; ++k)
      consider(size, unit_.*size * std::pow(10.0, -1.5 + 4.0 * k / steps), from, at);
    const double middle = at.sizes.*size;
    if (!(middle > 0.0)) return;
    constexpr int finer = 4;
    for (int k = -finer; k <= finer; ++k) {
      const double value = middle * std::pow(10.0, 0.25 * k / (finer + 1));
      if (is_noise && errors_.noise_known && value < 1.0) continue;
      consider(size, value, from, at);
    }
  }

  /// Largest value of a size, at most `most`, that decreases ln L by `decrease` or less.
  [[nodiscard]] double highest(double TumbleSizes::* size,
                               const Likely& at,
                               double decrease,
                               double most) const {
    const auto is_likely = [&](double x) {
      TumbleSizes next = at.sizes;
      next.*size = x;
      return of(next) >= at.log_likelihood - decrease;
    };
    if (is_likely(most)) return most;
    double low = at.sizes.*size, high = most;
    constexpr int steps = 24;
    for (int k = 0; k < steps; ++k) {
      const double middle = low > 0.0 ? std::sqrt(low * high) : 0.1 * high;
      if (low == 0.0 && middle < 1e-6 * unit_.*size) return middle;
      (is_likely(middle) ? low : high) = middle;
    }
    return high;
  }

  const Eigen::MatrixXd& A_;
  const Eigen::VectorXd& y_;
  const TumbleErrors& errors_;
  TumbleSizes unit_;
  double scatter_ = 0.0, plain_chi_square_ = 0.0;
};

}  // namespace

TumbleCovariance::TumbleCovariance(const TumbleErrors& errors, const TumbleSizes& sizes)
    : errors_(errors),
      weight_((sizes.noise * errors.noise_std).cwiseAbs2().cwiseInverse()),
      lever_(sizes.indexing_rad * errors.lever) {
  const std::size_t count = 1 + *std::max_element(errors.setting.begin(), errors.setting.end());
  square_ = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(count));
  for (Eigen::Index k = 0; k < lever_.size(); ++k)
    square_(static_cast<Eigen::Index>(errors.setting[static_cast<std::size_t>(k)])) +=
        lever_(k) * lever_(k) * weight_(k);
  log_determinant_ = square_.array().log().sum() - weight_.array().log().sum();
  if (sizes.drift <= 0.0 || errors.drift.cols() == 0) return;
  const Eigen::MatrixXd Z = sizes.drift * errors.drift;
  drift_ = solve_settings(Z);
  const PositiveInverse inner =
      invert_positive(Eigen::MatrixXd::Identity(Z.cols(), Z.cols()) + Z.transpose() * drift_);
  inner_ = inner.inverse;
  log_determinant_ += inner.log_determinant;
}

// Sherman–Morrison formula for each setting.
Eigen::MatrixXd TumbleCovariance::solve_settings(const Eigen::MatrixXd& X) const {
  Eigen::MatrixXd out = weight_.asDiagonal() * X;
  Eigen::MatrixXd along = Eigen::MatrixXd::Zero(square_.size(), X.cols());
  const auto setting = [&](Eigen::Index k) {
    return static_cast<Eigen::Index>(errors_.setting[static_cast<std::size_t>(k)]);
  };
  for (Eigen::Index k = 0; k < X.rows(); ++k) along.row(setting(k)) += lever_(k) * out.row(k);
  for (Eigen::Index k = 0; k < X.rows(); ++k)
    out.row(k) -= weight_(k) * lever_(k) / square_(setting(k)) * along.row(setting(k));
  return out;
}

Eigen::MatrixXd TumbleCovariance::solve(const Eigen::MatrixXd& X) const {
  Eigen::MatrixXd out = solve_settings(X);
  if (drift_.cols() > 0) out -= drift_ * (inner_ * (drift_.transpose() * X));
  return out;
}

Eigen::VectorXd TumbleCovariance::inverse_diagonal() const {
  Eigen::VectorXd diagonal = weight_;
  for (Eigen::Index k = 0; k < diagonal.size(); ++k) {
    const double along = lever_(k) * weight_(k);
    diagonal(k) -= along * along /
                   square_(static_cast<Eigen::Index>(errors_.setting[static_cast<std::size_t>(k)]));
  }
  if (drift_.cols() > 0) diagonal -= (drift_ * inner_).cwiseProduct(drift_).rowwise().sum();
  return diagonal;
}

double TumbleSolved::deleted(Eigen::Index k) const {
  return projector(k) > 0.0 ? projected(k) / std::sqrt(projector(k)) : 0.0;
}

TumbleSolved solve_tumble(const Eigen::MatrixXd& A,
                          const Eigen::VectorXd& y,
                          const TumbleErrors& errors,
                          const TumbleSizes& sizes) {
  const TumbleCovariance V(errors, sizes);
  const Eigen::MatrixXd B = V.solve(A);
  const PositiveInverse normal = invert_positive(A.transpose() * B);
  TumbleSolved out;
  out.covariance = normal.inverse;
  out.gain = normal.inverse * B.transpose();
  out.beta = out.gain * y;
  out.beta += out.gain * (y - A * out.beta);  // one step of iterative refinement
  out.projected = V.solve(y - A * out.beta);
  const double square = (y - A * out.beta).dot(out.projected);
  out.chi_square = std::max(square, 0.0);
  // If the sizes far exceed the noise, V is ill-conditioned and the sum of squares can become
  // negative.
  constexpr double rounding = 1e-3;
  out.log_likelihood = square < -rounding
                           ? -std::numeric_limits<double>::infinity()
                           : -0.5 * (V.log_determinant() + normal.log_determinant + out.chi_square);
  out.projector = V.inverse_diagonal() - B.cwiseProduct(out.gain.transpose()).rowwise().sum();
  return out;
}

TumbleSizes find_sizes(const Eigen::MatrixXd& A,
                       const Eigen::VectorXd& y,
                       const TumbleErrors& errors) {
  TumbleSizes sizes{.noise = errors.noise_known ? 1.0 : 0.0,
                    .indexing_rad = errors.indexing_std_rad,
                    .drift = errors.drift_std};
  if (A.rows() <= A.cols()) return sizes;
  const SizeSearch search(A, y, errors);
  constexpr double none = 1e-100;
  if (!errors.noise_known && search.scatter() < none) return {.noise = 0.0};
  const Likely plain = search.without_assumed();
  Likely at = plain;
  search.climb(at, !errors.noise_known);
  if (errors.noise_known) {
    sizes.noise = search.noise_factor(at);
  } else {
    // Scatter alone may explain the residuals sufficiently.
    constexpr double sufficient = 2.0;
    if (at.log_likelihood - plain.log_likelihood < sufficient) at = plain;
    sizes.noise = at.sizes.noise;
  }
  if (errors.indexing_assumed)
    sizes.indexing_rad = search.judged(&TumbleSizes::indexing_rad, at, errors.indexing_std_rad);
  if (errors.drift_assumed) sizes.drift = search.judged(&TumbleSizes::drift, at, errors.drift_std);
  return sizes;
}

}  // namespace proofmass::calibrate
