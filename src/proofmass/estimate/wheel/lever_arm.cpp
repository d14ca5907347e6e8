#include <limits>
#include <optional>

#include "proofmass/core/in_parallel.hpp"
#include "proofmass/core/linalg.hpp"
#include "proofmass/estimate/wheel/colour.hpp"
#include "proofmass/estimate/wheel/likelihood.hpp"

namespace proofmass::estimate {
namespace {

/// f at each point.
template <class Function>
std::vector<double> values_of(const Function& f, const std::vector<Places>& points) {
  std::vector<double> values(points.size());
  in_parallel(points.size(), {}, [&](std::size_t i, const Progress&) { values[i] = f(points[i]); });
  return values;
}

/// Gradient of f at x by central differences of the given steps.
template <class Function>
Eigen::VectorXd gradient_of(const Function& f, const Places& x, const Places& step) {
  std::vector<Places> points;
  for (Eigen::Index i = 0; i < x.size(); ++i)
    for (const double way : {1.0, -1.0}) {
      points.push_back(x);
      points.back()(i) += way * step(i);
    }
  const std::vector<double> values = values_of(f, points);
  Eigen::VectorXd gradient(x.size());
  std::size_t next = 0;
  for (Eigen::Index i = 0; i < x.size(); ++i, next += 2)
    gradient(i) = (values[next] - values[next + 1]) / (2.0 * step(i));
  return gradient;
}

/// Hessian of f at x, from one-sided mixed differences and central second ones: 1 + 2 n + n (n −
/// 1)/2 values of f.
template <class Function>
Eigen::MatrixXd hessian_of(const Function& f, const Places& x, const Places& step) {
  const Eigen::Index n = x.size();
  std::vector<Places> points{x};
  const auto add = [&](Eigen::Index i, double by_i, Eigen::Index j, double by_j) {
    points.push_back(x);
    points.back()(i) += by_i * step(i);
    points.back()(j) += by_j * step(j);
  };
  for (Eigen::Index i = 0; i < n; ++i) add(i, 1.0, i, 0.0);
  for (Eigen::Index i = 0; i < n; ++i) add(i, -1.0, i, 0.0);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < i; ++j) add(i, 1.0, j, 1.0);
  const std::vector<double> values = values_of(f, points);
  const double here = values.front();
  const double *up = values.data() + 1, *down = up + n, *both = down + n;
  Eigen::MatrixXd hessian(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    hessian(i, i) = (up[i] - 2.0 * here + down[i]) / (step(i) * step(i));
    for (Eigen::Index j = 0; j < i; ++j)
      hessian(i, j) = hessian(j, i) = (*both++ - up[i] - up[j] + here) / (step(i) * step(j));
  }
  return hessian;
}

/// Inverse of −hessian, with no direction less certain than the worst of the prior; that also keeps
/// the steps going up.
std::optional<Eigen::MatrixXd> inverse_information(const Eigen::MatrixXd& hessian,
                                                   double least_information) {
  if (!hessian.allFinite()) return std::nullopt;
  const SymmetricEigen axes = symmetric_eigen(-hessian);
  const Eigen::VectorXd information = axes.values.cwiseMax(least_information);
  return axes.vectors * information.cwiseInverse().asDiagonal() * axes.vectors.transpose();
}

}  // namespace

/// Newton steps on the likelihood, halved if they overshoot; the curvature is recomputed only after
/// a long step.
template <int S>
FoundPlaces likeliest_places(const WheelModel<S>& model,
                             const Excerpt<S>& excerpt,
                             const WheelPrior& prior,
                             const PlacesPrior& belief) {
  const Eigen::MatrixXd information = positive_inverse(belief.cov);
  const double least_information = symmetric_eigen(information).values.minCoeff();
  const auto likelihood = [&](const Places& places) {
    WheelPrior with = prior;
    with.places = places;
    auto state = excerpt.state;
    reset_constants<S>(with, state.x);
    const Places off = places - belief.mean;
    return log_likelihood_of(model, state, excerpt.first, excerpt.last) -
           0.5 * off.dot(information * off);
  };
  FoundPlaces found{*prior.places, Eigen::MatrixXd::Identity(2 * S, 2 * S) / least_information};
  double best = likelihood(found.mean);
  // Far from the truth the surface is irregular; if the recording contains little information, the
  // truth is near the prior.
  if (const double value = likelihood(belief.mean); !(best >= value)) {
    best = value;
    found.mean = belief.mean;
  }
  Places step = Places::Constant(2 * S, 0.01);
  bool curved = false;  // found.cov was taken with steps of its own size
  for (int round = 0; round < 8; ++round) {
    if (!curved) {
      const auto cov =
          inverse_information(hessian_of(likelihood, found.mean, step), least_information);
      if (!cov) break;
      found.cov = *cov;
    }
    const Eigen::VectorXd gradient = gradient_of(likelihood, found.mean, step);
    if (!gradient.allFinite()) break;
    Places move = found.cov * gradient;
    const double gain = gradient.dot(move);  // twice what a quadratic would gain
    double value = likelihood(found.mean + move);
    for (int halvings = 0; !(value >= best) && halvings < 3; ++halvings) {
      move *= 0.5;
      value = likelihood(found.mean + move);
    }
    if (value >= best) {
      best = value;
      found.mean += move;
    }
    const Places own = found.cov.diagonal().cwiseSqrt().cwiseMax(1e-6).cwiseMin(0.05);
    curved = (own.array() < 3.0 * step.array()).all() && (step.array() < 3.0 * own.array()).all();
    if (curved && (gain < 0.01 || !(value >= best))) break;
    // If no direction leads up, the differences were taken over more than the surface's own scale.
    step = value >= best ? own : Places(0.2 * step);
  }
  found.log_likelihood = best;
  return found;
}

WheelLevers levers_of(const WheelPath& path, const WheelReadings& readings) {
  const std::vector<double>& time_s = readings.time_s;
  // One turn, at most 1 s: the speed of a slow wheel may change within a turn. Hub vibration
  // appears as changes of speed, which average out over 3 s.
  const double longest_s = readings.shakes ? 3.0 : 1.0;
  const double shortest_s = readings.shakes ? 3.0 : 0.0;
  const std::size_t size = path.moving.size();
  WheelLevers sums(size + 1, Mat<2>::Zero());
  for (std::size_t k = 0; k < size; ++k) {
    const double w = path.moving[k](wheel::speed);
    sums[k + 1] = sums[k] + Mat<2>(w * w, path.moving[k](wheel::accel));
  }
  if (readings.one_speed) {
    // An encoder is so sharp that its own noise in Ω² would outweigh that of the accelerometers.
    const Mat<2> mean = sums.back() / static_cast<double>(size);
    return WheelLevers(size, Mat<2>(mean(0), 0.0));
  }
  WheelLevers levers(size);
  for (std::size_t k = 0; k < size; ++k) {
    const double turn_s = rad_per_turn / std::abs(path.moving[k](wheel::speed));
    // Symmetric about the epoch, also near the ends.
    const double half_s = std::min({0.5 * std::clamp(turn_s, shortest_s, longest_s),
                                    time_s[k] - time_s.front(), time_s.back() - time_s[k]});
    const auto from = static_cast<std::size_t>(
        std::ranges::lower_bound(time_s, time_s[k] - half_s) - time_s.begin());
    const auto to = static_cast<std::size_t>(std::ranges::upper_bound(time_s, time_s[k] + half_s) -
                                             time_s.begin());
    levers[k] = (sums[to] - sums[from]) / static_cast<double>(to - from);
  }
  return levers;
}

namespace {

/// For a pass with the lever arms as additional states.
template <int S>
FilterState<wheel::states(S)> free_places(WheelModel<S>& model,
                                          const WheelLevers& levers,
                                          WheelPrior prior,
                                          const PlacesPrior& belief) {
  model.places_held = false;
  model.levers = &levers;
  prior.places.reset();
  prior.belief = belief;
  return prior_state<S>(prior);
}

}  // namespace

template <int S>
FoundPlaces places_by_levers(WheelModel<S> model,
                             const WheelLevers& levers,
                             WheelPrior prior,
                             const PlacesPrior& belief) {
  auto state = free_places(model, levers, std::move(prior), belief);
  FoundPlaces found;
  filter(model, {0, model.size()}, wheel_gate, state, [&](std::size_t, const auto& step) {
    for (int i = 0; i < step.count; ++i) {
      const auto& update = step.updates[static_cast<std::size_t>(i)];
      const double off = update.innovation / std::sqrt(update.expected);
      found.innovations.push_back(update.used ? static_cast<float>(off)
                                              : std::numeric_limits<float>::quiet_NaN());
    }
  });
  found.mean = state.x.mean.template tail<2 * S>();
  found.cov = state.x.cov.template bottomRightCorner<2 * S, 2 * S>();
  return found;
}

template <int S>
Eigen::VectorXd widening(WheelModel<S> model,
                         const WheelLevers& levers,
                         const std::vector<double>& time_s,
                         WheelPrior prior,
                         const PlacesPrior& belief) {
  constexpr int count = wheel::standing(S);
  using Standing = Mat<count, count>;
  const auto state = free_places(model, levers, std::move(prior), belief);
  const Standing before = state.x.cov.template bottomRightCorner<count, count>();
  // P of constants without random walk: the scores are summed over the whole recording, but a state
  // that walks is determined only by the latest part of it.
  auto standing = model;
  standing.sensors_stand = true;
  auto last = state;
  filter(standing, {0, model.size()}, wheel_gate, last, [](std::size_t, const auto&) {});
  const Standing after = last.x.cov.template bottomRightCorner<count, count>();
  const double block_s = std::max(1.0, (time_s.back() - time_s.front()) / 40.0);
  std::array lengths{ScoreBlocks<S>(block_s), ScoreBlocks<S>(2.0 * block_s),
                     ScoreBlocks<S>(4.0 * block_s)};
  Readings<wheel::states(S), WheelModel<S>::channels> readings;
  smooth_means(
      model, state, wheel_gate, [](std::size_t, const auto&) {},
      [&](std::size_t k, const auto& step, const auto& later) {
        model.measure(later.mean(step.filtered), k, readings);
        for (auto& blocks : lengths) blocks.add(time_s[k], readings);
      });
  const Eigen::VectorXd variance = after.diagonal();
  Eigen::VectorXd widened = Eigen::VectorXd::Ones(count);
  // The prior contributes P P₀⁻¹ P to the variance; a direction without variance has no prior.
  Eigen::VectorXd believed(count);
  const Eigen::VectorXd own = before.diagonal();
  for (int i = 0; i < count; ++i) believed(i) = own(i) > 0.0 ? 1.0 / own(i) : 0.0;
  const Eigen::VectorXd by_belief = (after * believed.asDiagonal() * after).diagonal();
  for (auto& blocks : lengths) {
    const Eigen::VectorXd by_scores = (after * blocks.covariance() * after).diagonal();
    for (int i = 0; i < count; ++i)
      if (variance(i) > 0.0)
        widened(i) = std::max(widened(i), std::sqrt((by_scores(i) + by_belief(i)) / variance(i)));
  }
  return widened;
}

template FoundPlaces likeliest_places(const WheelModel<1>&,
                                      const Excerpt<1>&,
                                      const WheelPrior&,
                                      const PlacesPrior&);
template FoundPlaces likeliest_places(const WheelModel<2>&,
                                      const Excerpt<2>&,
                                      const WheelPrior&,
                                      const PlacesPrior&);
template FoundPlaces places_by_levers(WheelModel<1>,
                                      const WheelLevers&,
                                      WheelPrior,
                                      const PlacesPrior&);
template FoundPlaces places_by_levers(WheelModel<2>,
                                      const WheelLevers&,
                                      WheelPrior,
                                      const PlacesPrior&);
template Eigen::VectorXd widening(
    WheelModel<1>, const WheelLevers&, const std::vector<double>&, WheelPrior, const PlacesPrior&);
template Eigen::VectorXd widening(
    WheelModel<2>, const WheelLevers&, const std::vector<double>&, WheelPrior, const PlacesPrior&);

}  // namespace proofmass::estimate
