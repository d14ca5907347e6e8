#include "proofmass/characterise/noise/whittle.hpp"

#include <algorithm>
#include <cmath>

#include "proofmass/characterise/noise/fisher_scoring.hpp"
#include "proofmass/core/contract.hpp"
#include "proofmass/core/linalg.hpp"
#include "proofmass/core/statistics.hpp"

namespace proofmass::characterise {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// In log-likelihood: far below the resolution of an interval.
constexpr double whittle_converged = 1e-8;

MatrixXd chosen(const MatrixXd& columns, const std::vector<int>& active) {
  MatrixXd X(columns.rows(), static_cast<Index>(active.size()));
  for (std::size_t k = 0; k < active.size(); ++k)
    X.col(static_cast<Index>(k)) = columns.col(active[k]);
  return X;
}

}  // namespace

WhittleLikelihood::WhittleLikelihood(std::vector<SpectralGroup> groups, MatrixXd columns)
    : groups_(std::move(groups)), columns_(std::move(columns)) {
  const auto n = static_cast<Index>(groups_.size());
  PM_EXPECTS(n > 0 && columns_.rows() == n);
  dof_.resize(n);
  raw_.resize(n);
  amplitude_.resize(n);
  of_ramp_.resize(n);
  for (Index g = 0; g < n; ++g) {
    const SpectralGroup& group = groups_[static_cast<std::size_t>(g)];
    dof_(g) = group.dof;
    raw_(g) = group.density;
    amplitude_(g) = group.amplitude;
    of_ramp_(g) = group.of_ramp;
    if (group.of_ramp != 0.0) ramp_rows_ = g + 1;
  }
  rough_ = smoothed();
}

// Initial estimate of S: the mean over a factor of two in frequency to either side.
ArrayXd WhittleLikelihood::smoothed() const {
  const ArrayXd p = expected_densities({});
  ArrayXd S(p.size());
  for (Index g = 0; g < p.size(); ++g) {
    const double f = groups_[static_cast<std::size_t>(g)].frequency_hz;
    double sum = 0.0, weight = 0.0;
    const auto take = [&](Index k) {
      const double other = groups_[static_cast<std::size_t>(k)].frequency_hz;
      if (other < 0.5 * f || other > 2.0 * f) return false;
      sum += dof_(k) * p(k);
      weight += dof_(k);
      return true;
    };
    for (Index k = g; k < p.size() && take(k); ++k) {
    }
    for (Index k = g; k > 0 && take(k - 1); --k) {
    }
    S(g) = sum / weight;
  }
  return S.max(1e-12 * S.maxCoeff()).max(1e-300);
}

WhittleLikelihood::Ramp WhittleLikelihood::ramp(const ArrayXd& S) const {
  if (ramp_rows_ == 0) return {};
  const ArrayXd weighted = of_ramp_.head(ramp_rows_) / S.head(ramp_rows_);
  const double information = (weighted * of_ramp_.head(ramp_rows_)).sum();
  return {(weighted * amplitude_.head(ramp_rows_)).sum() / information, 1.0 / information};
}

// Expected densities without the ramp, given the uncertainty of its slope: the expectation step
// towards the maximum of the restricted likelihood.
ArrayXd WhittleLikelihood::expected_densities(const Ramp& ramp) const {
  ArrayXd p = raw_;
  if (ramp_rows_ > 0 && ramp.variance > 0.0) {
    const auto r = of_ramp_.head(ramp_rows_);
    const ArrayXd rest = amplitude_.head(ramp_rows_) - ramp.slope * r;
    p.head(ramp_rows_) =
        (r != 0.0).select(rest.square() + ramp.variance * r.square(), p.head(ramp_rows_));
  }
  return p;
}

ArrayXd WhittleLikelihood::densities(const WhittleFit& fit) const {
  ArrayXd p = raw_;
  const auto r = of_ramp_.head(ramp_rows_);
  const ArrayXd rest = amplitude_.head(ramp_rows_) - fit.slope * r;
  p.head(ramp_rows_) = (r != 0.0).select(rest.square(), p.head(ramp_rows_));
  return p;
}

double WhittleLikelihood::log_likelihood(const ArrayXd& S) const {
  const Ramp found = ramp(S);
  WhittleFit fit;
  fit.slope = found.slope;
  const double data = -0.5 * (dof_ * (S.log() + densities(fit) / S)).sum();
  return ramp_rows_ > 0 ? data + 0.5 * std::log(found.variance) : data;
}

// One problem of maximise(): the free columns, and the fixed density.
struct WhittleLikelihood::Ascent {
  struct State {
    ArrayXd S;
    double log_likelihood = 0.0;
  };

  const WhittleLikelihood& likelihood;
  MatrixXd X;
  ArrayXd fixed;
  ArrayXd least;  // keeps S off zero where all that reaches is gone

  [[nodiscard]] State at(const VectorXd& theta) const {
    return at_density((fixed + (X * theta).array()).max(least));
  }

  [[nodiscard]] State at_density(ArrayXd S) const {
    const double value = likelihood.log_likelihood(S);
    return {std::move(S), value};
  }

  [[nodiscard]] VectorXd scored(const State& state) const {
    const ArrayXd weight = 0.5 * likelihood.dof_ / state.S.square();
    const ArrayXd p = likelihood.expected_densities(likelihood.ramp(state.S));
    const MatrixXd WX = weight.matrix().asDiagonal() * X;
    return non_negative_minimiser(X.transpose() * WX, WX.transpose() * (p - fixed).matrix());
  }
};

WhittleFit WhittleLikelihood::maximise(const std::vector<int>& active,
                                       const std::optional<Held>& held,
                                       const VectorXd& start) const {
  Ascent ascent{*this, chosen(columns_, active), ArrayXd::Zero(columns_.rows()), 1e-9 * rough_};
  if (held) ascent.fixed = columns_.col(held->column).array() * held->strength;
  VectorXd theta = VectorXd::Zero(static_cast<Index>(active.size()));
  if (start.size() > 0)
    theta = start(active);
  else if (!active.empty())
    theta = ascent.scored(ascent.at_density(rough_));
  Ascent::State state = ascent.at(theta);
  if (!active.empty()) climb(ascent, {.least_gain = whittle_converged}, theta, state);
  WhittleFit fit;
  fit.strength = VectorXd::Zero(columns_.cols());
  for (std::size_t k = 0; k < active.size(); ++k)
    fit.strength(active[k]) = theta(static_cast<Index>(k));
  if (held) fit.strength(held->column) = held->strength;
  fit.density = state.S.matrix();
  fit.log_likelihood = state.log_likelihood;
  const Ramp found = ramp(state.S);
  fit.slope = found.slope;
  fit.slope_variance = found.variance;
  return fit;
}

WhittleLikelihood WhittleLikelihood::at_slope(double slope) const {
  WhittleLikelihood other = *this;
  other.raw_ = densities({.strength = {}, .density = {}, .slope = slope});
  other.of_ramp_.setZero();
  other.ramp_rows_ = 0;
  return other;
}

WhittleLikelihood WhittleLikelihood::without_wave(const SlowWave& wave) const {
  WhittleLikelihood other = *this;
  const std::complex<double> size(wave.cosine, -wave.sine);
  for (Index g = 0; g < raw_.size(); ++g) {
    const CosineVector& vector = groups_[static_cast<std::size_t>(g)].vector;
    if (vector.k == 0) continue;
    other.amplitude_(g) -= (size * vector.of_wave(wave.frequency_hz)).real();
    other.raw_(g) = square(other.amplitude_(g));
  }
  return other;
}

MatrixXd WhittleLikelihood::information(const WhittleFit& fit,
                                        const std::vector<int>& active) const {
  return information_on(fit, chosen(columns_, active));
}

MatrixXd WhittleLikelihood::information_on(const WhittleFit& fit, const MatrixXd& X) const {
  const ArrayXd weight = 0.5 * dof_ / fit.density.array().square();
  return X.transpose() * (weight.matrix().asDiagonal() * X);
}

void WhittleLikelihood::allow_misfit(double relative_variance) {
  for (Index g = 0; g < dof_.size(); ++g) {
    const double own = groups_[static_cast<std::size_t>(g)].dof;
    dof_(g) = 1.0 / (1.0 / own + 0.5 * relative_variance);
  }
}

}  // namespace proofmass::characterise
