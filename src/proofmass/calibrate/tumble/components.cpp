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

/// Restricted likelihood as a function of the sizes.
class SizeSearch {
 public:
  SizeSearch(const Eigen::MatrixXd& A, const Eigen::VectorXd& y, const TumbleErrors& errors)
      : A_(A), y_(y), errors_(errors) {
    const TumbleSolved plain = solve_tumble(A, y, errors, {});
    const auto dof = static_cast<double>(A.rows() - A.cols());
    scatter_ = std::sqrt(plain.chi_square / dof);
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

  /// ln L, minus 2 if the bias drift exceeds the assumption: errors of the angles alone are the
  /// simpler explanation of large residuals.
  [[nodiscard]] double of(const TumbleSizes& sizes) const {
    constexpr double simpler = 2.0;
    const bool beyond = errors_.drift_assumed && sizes.drift > 1.001 * errors_.drift_std;
    return solve_tumble(A_, y_, errors_, sizes).log_likelihood - (beyond ? simpler : 0.0);
  }
  [[nodiscard]] const TumbleSizes& unit() const { return unit_; }
  [[nodiscard]] double scatter() const { return scatter_; }
  /// True if the stated noise alone does not explain the residuals.
  [[nodiscard]] bool misfits() const {
    const auto dof = static_cast<double>(A_.rows() - A_.cols());
    const double square = scatter_ * scatter_;
    return (errors_.noise_dof > 0.0 ? fisher_f_p(square, dof, errors_.noise_dof)
                                    : chi_square_p(square * dof, dof)) < fits_p;
  }
  /// Maximises over one size, the others fixed: over zero and 10^(−1.5 … 2.5) units, then on a
  /// finer grid about the best value.
  void climb(double TumbleSizes::* size, TumbleSizes& at, double& best) const {
    constexpr int steps = 16;
    const TumbleSizes from = at;
    for (int k = size == &TumbleSizes::noise ? 0 : -1; k <= steps; ++k) {
      TumbleSizes next = from;
      next.*size = k < 0 ? 0.0 : unit_.*size * std::pow(10.0, -1.5 + 4.0 * k / steps);
      const double value = of(next);
      if (value <= best) continue;
      best = value;
      at = next;
    }
    const double middle = at.*size;
    constexpr int finer = 4;
    for (int k = -finer; middle > 0.0 && k <= finer; ++k) {
      TumbleSizes next = at;
      next.*size = middle * std::pow(10.0, 0.25 * k / (finer + 1));
      if (size == &TumbleSizes::noise && errors_.noise_known && next.noise < 1.0) continue;
      const double value = of(next);
      if (value <= best) continue;
      best = value;
      at = next;
    }
  }
  /// Largest value of a size for which ln L ≥ `level`, at most `most`.
  [[nodiscard]] double highest(double TumbleSizes::* size,
                               const TumbleSizes& at,
                               double level,
                               double most) const {
    const auto value = [&](double x) {
      TumbleSizes next = at;
      next.*size = x;
      return of(next);
    };
    if (value(most) >= level) return most;
    double low = at.*size, high = most;
    constexpr int steps = 24;
    for (int k = 0; k < steps; ++k) {
      const double middle = low > 0.0 ? std::sqrt(low * high) : 0.1 * high;
      if (low == 0.0 && middle < 1e-6 * unit_.*size) return middle;
      (value(middle) >= level ? low : high) = middle;
    }
    return high;
  }

 private:
  const Eigen::MatrixXd& A_;
  const Eigen::VectorXd& y_;
  const TumbleErrors& errors_;
  TumbleSizes unit_;
  double scatter_ = 0.0;
};

// Value to use for an assumed size.
double judged(const SizeSearch& search,
              double TumbleSizes::* size,
              const TumbleSizes& at,
              double best,
              double assumed) {
  constexpr double far = 1e4;
  if (at.*size > assumed)
    return search.highest(size, at, best - exceeded, far * std::max(at.*size, search.unit().*size));
  return search.highest(size, at, best - allowed, assumed);
}

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
  const auto dof = static_cast<double>(A.rows() - A.cols());
  TumbleSizes at = sizes;
  at.noise = errors.noise_known ? 1.0 : search.scatter();
  if (errors.indexing_assumed) at.indexing_rad = 0.0;
  if (errors.drift_assumed) at.drift = 0.0;
  double best = search.of(at);
  const double plain = best, scatter = at.noise;
  TumbleSizes scattered = at;
  scattered.noise = search.scatter();
  constexpr int rounds = 3;
  const auto climb = [&](bool noise) {
    for (int round = 0; round < rounds; ++round) {
      if (errors.indexing_assumed) search.climb(&TumbleSizes::indexing_rad, at, best);
      if (errors.drift_assumed) search.climb(&TumbleSizes::drift, at, best);
      if (noise) search.climb(&TumbleSizes::noise, at, best);
    }
  };
  climb(!errors.noise_known);
  if (errors.noise_known) {
    const double chi_square = solve_tumble(A, y, errors, at).chi_square;
    const double p = errors.noise_dof > 0.0 ? fisher_f_p(chi_square / dof, dof, errors.noise_dof)
                                            : chi_square_p(chi_square, dof);
    if (p < fits_p) {
      climb(true);
    } else if (search.misfits() && best - search.of(scattered) < decisive) {
      // A larger noise of all positions explains the residuals nearly as well, which indicates an
      // outlier: the noise is increased as well.
      sizes.noise = search.scatter();
    }
  } else if (best - plain < 2.0) {
    // Scatter alone explains the residuals sufficiently.
    at = {.noise = scatter,
          .indexing_rad = errors.indexing_assumed ? 0.0 : errors.indexing_std_rad,
          .drift = errors.drift_assumed ? 0.0 : errors.drift_std};
    best = plain;
  }
  sizes.noise = std::max(sizes.noise, at.noise);
  if (errors.indexing_assumed)
    sizes.indexing_rad =
        judged(search, &TumbleSizes::indexing_rad, at, best, errors.indexing_std_rad);
  if (errors.drift_assumed)
    sizes.drift = judged(search, &TumbleSizes::drift, at, best, errors.drift_std);
  return sizes;
}

}  // namespace proofmass::calibrate
