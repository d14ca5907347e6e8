#include "proofmass/characterise/noise/ordinate_likelihood.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "proofmass/characterise/noise/fisher_scoring.hpp"
#include "proofmass/core/contract.hpp"
#include "proofmass/core/linalg.hpp"
#include "proofmass/signal/fourier.hpp"

namespace proofmass::characterise {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double ordinates_converged = 1e-6;  // in log-likelihood, where 1.92 bounds an interval

// All quantities that depend on a density.
struct State {
  ArrayXd S;
  VectorXd coefficients;
  PositiveFactor information;  // of the coefficients
  ArrayXd residual;
  PositiveFactor adjusting_information;
  double log_likelihood = 0.0;
};

class Ordinates {
 public:
  Ordinates(const VectorXd& z, const MatrixXd& P, const OrdinateMeans& means)
      : z_(z),
        P_(P),
        means_(means),
        least_(1e-12 * z.squaredNorm() / static_cast<double>(z.size())) {
    PM_EXPECTS(P.rows() == z.size());
  }

  [[nodiscard]] ArrayXd density(const VectorXd& theta) const {
    return (P_ * theta).array().max(std::max(least_, 1e-300));
  }

  [[nodiscard]] State at(const VectorXd& theta) const { return at_density(density(theta)); }

  [[nodiscard]] State at_density(ArrayXd S) const {
    State state;
    const VectorXd weight = S.inverse().matrix();
    state.residual = z_.array();
    const GramOfColumns gram(means_.impulses, weight);
    double data = S.log().sum();
    if (means_.fitted.cols() > 0) {
      state.information = PositiveFactor(gram.of(means_.fitted));
      const VectorXd Wz = weight.cwiseProduct(z_);
      state.coefficients = state.information.solve(means_.fitted.transpose() * Wz);
      state.residual -= (means_.fitted * state.coefficients).array();
    }
    data += (state.residual.square() / S).sum();
    if (means_.adjusting.cols() > 0) {
      state.adjusting_information = PositiveFactor(gram.of(means_.adjusting));
      data += state.adjusting_information.log_determinant();
    }
    state.log_likelihood = -0.5 * data;
    state.S = std::move(S);
    return state;
  }

  // Expected squares of the ordinates, including the uncertainty of the fitted part.
  [[nodiscard]] VectorXd expected_squares(const State& state) const {
    VectorXd p = state.residual.square().matrix();
    if (means_.adjusting.cols() > 0)
      p += state.adjusting_information.quadratic_forms(means_.adjusting);
    return p;
  }

  // Fisher scoring: the least-squares strengths for the expected squares with weights 1/(2 S²).
  [[nodiscard]] VectorXd scored(const State& state) const {
    const VectorXd weight = (0.5 / state.S.square()).matrix();
    const MatrixXd WP = weight.asDiagonal() * P_;
    return non_negative_minimiser(P_.transpose() * WP, WP.transpose() * expected_squares(state));
  }

  // Initial estimate: the mean of neighbouring squares.
  [[nodiscard]] ArrayXd rough() const {
    constexpr Index reach = 4;
    const ArrayXd p = z_.array().square();
    ArrayXd S(p.size());
    for (Index k = 0; k < p.size(); ++k) {
      const Index from = std::max<Index>(0, k - reach), to = std::min(p.size() - 1, k + reach);
      S(k) = p.segment(from, to - from + 1).mean();
    }
    return S.max(std::max(1e-9 * p.mean(), 1e-300));
  }

 private:
  const VectorXd& z_;
  const MatrixXd& P_;
  const OrdinateMeans& means_;
  double least_;
};

OrdinateFit result_of(State state, VectorXd theta) {
  return {std::move(theta), state.S.matrix(), std::move(state.coefficients),
          state.information.inverse(), state.log_likelihood};
}

}  // namespace

GramOfColumns::GramOfColumns(View<std::size_t> impulses, const VectorXd& w)
    : impulses_(impulses), w_(w) {
  constexpr std::size_t few = 16;  // whose products are as fast as a transform
  if (impulses.size() < few) return;
  std::vector<double> weights(static_cast<std::size_t>(w.size()) + 1, 0.0);
  std::copy(w.begin(), w.end(), weights.begin() + 1);
  sums_ = signal::cosine_sums(weights);
}

MatrixXd GramOfColumns::of(const MatrixXd& X) const {
  if (sums_.empty()) return weighted_gram(X, w_);
  const auto m = std::ssize(impulses_);
  const Index own = X.cols() - m;
  PM_EXPECTS(own >= 0 && X.rows() == w_.size());
  const MatrixXd curves = X.leftCols(own);
  MatrixXd gram(X.cols(), X.cols());
  if (own > 0) {
    gram.topLeftCorner(own, own) = weighted_gram(curves, w_);
    gram.bottomLeftCorner(m, own) = X.rightCols(m).transpose() * (w_.asDiagonal() * curves);
    gram.topRightCorner(own, m) = gram.bottomLeftCorner(m, own).transpose();
  }
  gram.bottomRightCorner(m, m) = of_impulses(X.col(own));
  return gram;
}

// The columns' common factor c from their sum of squares, c² (n − 1)/2.
MatrixXd GramOfColumns::of_impulses(const VectorXd& first) const {
  const double scale = first.squaredNorm() / static_cast<double>(first.size());
  const std::size_t twice_n = 2 * (sums_.size() - 1);
  MatrixXd gram(std::ssize(impulses_), std::ssize(impulses_));
  for (std::size_t i = 0; i < impulses_.size(); ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      const std::size_t difference = impulses_[i] - impulses_[j];
      const std::size_t sum = impulses_[i] + impulses_[j] + 1;
      const auto row = static_cast<Index>(i), column = static_cast<Index>(j);
      gram(row, column) = gram(column, row) =
          scale * (sums_[difference] + sums_[std::min(sum, twice_n - sum)]);
    }
  return gram;
}

OrdinateFit fit_ordinates(const VectorXd& z,
                          const MatrixXd& P,
                          const OrdinateMeans& means,
                          const VectorXd& start) {
  const Ordinates ordinates(z, P, means);
  VectorXd theta =
      start.size() > 0 ? start : ordinates.scored(ordinates.at_density(ordinates.rough()));
  State state = ordinates.at(theta);
  climb(ordinates, {.least_gain = ordinates_converged}, theta, state);
  return result_of(std::move(state), std::move(theta));
}

double promised_gain(const VectorXd& z,
                     const MatrixXd& P,
                     const OrdinateMeans& means,
                     const OrdinateFit& fit,
                     View<VectorXd> columns) {
  const Ordinates ordinates(z, P, means);
  const State state = ordinates.at_density(fit.density.array());
  const VectorXd weight = (0.5 / state.S.square()).matrix();
  const VectorXd excess = ordinates.expected_squares(state) - fit.density;
  std::vector<Index> active;
  for (Index k = 0; k < P.cols(); ++k)
    if (fit.strength(k) > 0.0) active.push_back(k);
  MatrixXd X, own;
  if (!active.empty()) {
    X = P(Eigen::all, active);
    own = positive_inverse(X.transpose() * (weight.asDiagonal() * X));
  }
  double most = 0.0;
  for (const VectorXd& column : columns) {
    const VectorXd weighted = weight.cwiseProduct(column);
    const double score = weighted.dot(excess);
    if (score <= 0.0) continue;
    const double alone = weighted.dot(column);
    double information = alone;
    if (!active.empty()) {
      const VectorXd shared = X.transpose() * weighted;
      information -= shared.dot(own * shared);
    }
    // A column spanned by the others adds nothing.
    constexpr double least_share = 1e-9;
    if (information > least_share * alone) most = std::max(most, score * score / information);
  }
  return most;
}

OrdinateFit evaluate_ordinates(const VectorXd& z,
                               const MatrixXd& P,
                               const OrdinateMeans& means,
                               const VectorXd& strength) {
  const Ordinates ordinates(z, P, means);
  return result_of(ordinates.at(strength), strength);
}

}  // namespace proofmass::characterise
