#include "proofmass/characterise/noise/ordinate_likelihood.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "proofmass/characterise/noise/fisher_scoring.hpp"
#include "proofmass/core/contract.hpp"
#include "proofmass/core/linalg.hpp"

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
    double data = S.log().sum();
    if (means_.fitted.cols() > 0) {
      state.information = PositiveFactor(weighted_gram(means_.fitted, weight));
      const VectorXd Wz = weight.cwiseProduct(z_);
      state.coefficients = state.information.solve(means_.fitted.transpose() * Wz);
      state.residual -= (means_.fitted * state.coefficients).array();
    }
    data += (state.residual.square() / S).sum();
    if (means_.adjusting.cols() > 0) {
      state.adjusting_information = PositiveFactor(weighted_gram(means_.adjusting, weight));
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
                     const VectorXd& column) {
  const Ordinates ordinates(z, P, means);
  const State state = ordinates.at_density(fit.density.array());
  const VectorXd weight = (0.5 / state.S.square()).matrix();
  const VectorXd weighted = weight.cwiseProduct(column);
  const double score = weighted.dot(ordinates.expected_squares(state) - fit.density);
  if (score <= 0.0) return 0.0;
  double information = weighted.dot(column);
  std::vector<Index> active;
  for (Index k = 0; k < P.cols(); ++k)
    if (fit.strength(k) > 0.0) active.push_back(k);
  if (!active.empty()) {
    const MatrixXd X = P(Eigen::all, active);
    const VectorXd shared = X.transpose() * weighted;
    const MatrixXd own = X.transpose() * (weight.asDiagonal() * X);
    information -= shared.dot(positive_inverse(own) * shared);
  }
  // A column spanned by the others adds nothing.
  constexpr double least_share = 1e-9;
  if (information <= least_share * weighted.dot(column)) return 0.0;
  return score * score / information;
}

OrdinateFit evaluate_ordinates(const VectorXd& z,
                               const MatrixXd& P,
                               const OrdinateMeans& means,
                               const VectorXd& strength) {
  const Ordinates ordinates(z, P, means);
  return result_of(ordinates.at(strength), strength);
}

}  // namespace proofmass::characterise
