#include "proofmass/core/linalg.hpp"
#include "proofmass/estimate/wheel_passes.hpp"

namespace proofmass::estimate {
namespace {

struct Curvature {
  Eigen::VectorXd gradient;
  Eigen::MatrixXd hessian;
};

/// Gradient and Hessian of f at x by central differences of the given steps.
template <class Function>
Curvature curvature(const Function& f, const Places& x, const Places& step) {
  const Eigen::Index n = x.size();
  const auto at = [&](Eigen::Index i, double di, Eigen::Index j, double dj) {
    Places y = x;
    y(i) += di * step(i);
    y(j) += dj * step(j);
    return f(y);
  };
  const double here = f(x);
  Curvature c{Eigen::VectorXd(n), Eigen::MatrixXd(n, n)};
  for (Eigen::Index i = 0; i < n; ++i) {
    const double up = at(i, 1.0, i, 0.0), down = at(i, -1.0, i, 0.0);
    c.gradient(i) = (up - down) / (2.0 * step(i));
    c.hessian(i, i) = (up - 2.0 * here + down) / (step(i) * step(i));
    for (Eigen::Index j = 0; j < i; ++j) {
      const double mixed = at(i, 1, j, 1) - at(i, 1, j, -1) - at(i, -1, j, 1) + at(i, -1, j, -1);
      c.hessian(i, j) = c.hessian(j, i) = mixed / (4.0 * step(i) * step(j));
    }
  }
  return c;
}

}  // namespace

/// Newton's steps up the likelihood, halved where they overshoot.
template <int S>
FoundPlaces find_places(const WheelModel<S>& model, const Excerpt<S>& excerpt, WheelPrior prior,
                        const PlacesPrior& belief) {
  const double prior_information = 1.0 / (belief.std_m * belief.std_m);
  const auto likelihood = [&](const Places& places) {
    prior.places = places;
    auto state = excerpt.state;
    reset_constants<S>(prior, state.x);
    return score_run(model, state, excerpt.first, excerpt.last).log_likelihood -
           0.5 * prior_information * (places - belief.mean).squaredNorm();
  };
  FoundPlaces found{*prior.places, Eigen::MatrixXd::Identity(2 * S, 2 * S) * 1e-4};
  double best = likelihood(found.mean);
  // Far from the truth the surface is ragged; where the recording says little, the truth is near what
  // was believed.
  if (const double value = likelihood(belief.mean); !(best >= value)) {
    best = value;
    found.mean = belief.mean;
  }
  for (int round = 0; round < 4; ++round) {
    const Places step = found.cov.diagonal().cwiseSqrt().cwiseMax(1e-6).cwiseMin(0.05);
    const Curvature c = curvature(likelihood, found.mean, step);
    if (!c.hessian.allFinite() || !c.gradient.allFinite()) break;
    // No direction is known worse than beforehand; that also keeps the steps going up.
    const SymmetricEigen axes = symmetric_eigen(-c.hessian);
    const Eigen::VectorXd information = axes.values.cwiseMax(prior_information);
    found.cov = axes.vectors * information.cwiseInverse().asDiagonal() * axes.vectors.transpose();
    Places move = found.cov * c.gradient;
    const double gain = c.gradient.dot(move);  // twice what a quadratic would gain
    double value = likelihood(found.mean + move);
    for (int halvings = 0; !(value >= best) && halvings < 6; ++halvings) {
      move *= 0.5;
      value = likelihood(found.mean + move);
    }
    if (!(value >= best)) break;
    best = value;
    found.mean += move;
    if (gain < 0.01) break;
  }
  return found;
}

template FoundPlaces find_places(const WheelModel<1>&, const Excerpt<1>&, WheelPrior,
                                 const PlacesPrior&);
template FoundPlaces find_places(const WheelModel<2>&, const Excerpt<2>&, WheelPrior,
                                 const PlacesPrior&);

}  // namespace proofmass::estimate
