#include "proofmass/calibrate/session_noise.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "proofmass/calibrate/multi_position/norm_model.hpp"
#include "proofmass/calibrate/slow_noise.hpp"
#include "proofmass/core/linalg.hpp"

namespace proofmass::calibrate {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Matrices = std::array<MatrixXd, 3>;

constexpr std::size_t most_poses = 300;  // the cost is their cube
constexpr double most_pairs = 150.0;
/// Ratio of a mean's variance due to drift to that due to white noise.
constexpr std::array<double, 10> ratios{0.0, 0.1, 0.25, 0.6, 1.5, 4.0, 10.0, 25.0, 60.0, 150.0};

// Drift of unit coefficient over all sessions.
struct Units {
  MatrixXd flicker, walk;
  VectorXd samples;         // of each rest
  double dwell = 1.0;       // its mean
  double of_flicker = 1.0;  // mean variance of a rest's mean
  double of_walk = 1.0;
};

Units units_of(View<RestSession> sessions) {
  Index n = 0;
  for (const RestSession& session : sessions) n += static_cast<Index>(session.rests);
  Units out{MatrixXd::Zero(n, n), MatrixXd::Zero(n, n), VectorXd(n)};
  Index first = 0;
  for (const RestSession& session : sessions) {
    const auto count = static_cast<Index>(session.rests);
    Span whole = session.spans.front();
    for (Index k = 0; k < count; ++k) {
      const Span& span = session.spans[static_cast<std::size_t>(k)];
      whole = {std::min(whole.start, span.start), std::max(whole.end, span.end)};
      out.samples(first + k) = span.length();
    }
    out.flicker.block(first, first, count, count) =
        slow_noise_covariance(session.spans, whole, SlowNoise::flicker);
    out.walk.block(first, first, count, count) =
        slow_noise_covariance(session.spans, whole, SlowNoise::random_walk);
    first += count;
  }
  out.dwell = 1.0 / out.samples.cwiseInverse().mean();
  out.of_flicker = std::max(out.flicker.diagonal().mean(), 1e-3);
  out.of_walk = std::max(out.walk.diagonal().mean(), 1e-3 * out.dwell);
  return out;
}

// One point of the grid.
struct GridPoint {
  double f, k;
  double score = 0.0;             // −2 ln of its probability
  std::array<double, 3> white{};  // N² of each axis, over all sessions
};

// The rests' part of the score, with the best-fitting white noise.
void score_rests(View<RestSession> sessions, GridPoint& at) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double pairs = 0.0, sum = 0.0, logs = 0.0;
    for (const RestSession& session : sessions)
      for (const signal::AllanLevel& level : session.levels[axis]) {
        const double count = std::min(level.pairs, most_pairs);
        const double shape = 1.0 / level.samples + at.f + at.k * level.samples;
        pairs += count;
        sum += count * level.variance / shape;
        logs += count * std::log(shape);
      }
    at.white[axis] = sum / pairs;
    at.score += logs + pairs * std::log(at.white[axis]);
  }
}

// C of each axis.
Matrices covariances(const Units& units, View<RestSession> sessions, const GridPoint& at) {
  Matrices out;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    out[axis] = at.white[axis] * (at.f * units.flicker + at.k * units.walk);
    out[axis].diagonal() += at.white[axis] * units.samples.cwiseInverse();
    Index k = 0;
    for (const RestSession& session : sessions) {
      const auto count = static_cast<Index>(session.rests);
      out[axis].diagonal().segment(k, count).array() += session.rounding[axis];
      k += count;
    }
  }
  return out;
}

// The residuals of a fit to the poses that agree.
struct Residuals {
  std::vector<Index> used;
  MatrixXd J;
  VectorXd r;
  Eigen::Matrix<double, Eigen::Dynamic, 3> of_mean;  // nᵀM
};

Residuals residuals_of(View<Pose> poses, const MultiPosition& fit) {
  const Parameters p(fit.estimate.data());
  Residuals out;
  for (std::size_t k = 0; k < poses.size(); ++k)
    if (fit.poses[k].used) out.used.push_back(static_cast<Index>(k));
  const auto n = static_cast<Index>(out.used.size());
  out.J.resize(n, 9);
  out.r.resize(n);
  out.of_mean.resize(n, 3);
  // Columns of unit size: biases by the scale, scales by themselves.
  Parameters size = Parameters::Ones();
  size.head<3>() = size.segment<3>(3) = p.segment<3>(3);
  for (Index row = 0; row < n; ++row) {
    const Pose& pose = poses[static_cast<std::size_t>(out.used[static_cast<std::size_t>(row)])];
    const NormTerm term = norm_term(p, {pose.mean, pose.mean_covariance});
    out.r(row) = term.force.norm() - fit.gravity_mps2;
    out.of_mean.row(row) = -term.gradient.head<3>();
    out.J.row(row) = term.gradient.cwiseProduct(size.transpose());
  }
  return out;
}

// A position in twenty recordings is bad, by up to ±10 mg.
constexpr double one_is_bad = 0.05;
constexpr double bad_by_mps2 = 0.1;

// The residuals' part: ln|C| + ln|JᵀC⁻¹J| + rᵀQr, and its value if one position were bad.
double score_of(const Residuals& residuals, const Matrices& C) {
  const auto n = static_cast<Index>(residuals.used.size());
  MatrixXd of_lengths = MatrixXd::Zero(n, n);
  for (Index axis = 0; axis < 3; ++axis) {
    const VectorXd by = residuals.of_mean.col(axis);
    of_lengths += by.asDiagonal() *
                  C[static_cast<std::size_t>(axis)](residuals.used, residuals.used) *
                  by.asDiagonal();
  }
  const PositiveInverse weights = invert_positive(of_lengths);
  const MatrixXd WJ = weights.inverse * residuals.J;
  const PositiveInverse cofactor = invert_positive(residuals.J.transpose() * WJ);
  const MatrixXd Q = weights.inverse - WJ * cofactor.inverse * WJ.transpose();
  const VectorXd g = Q * residuals.r;
  double likelihood = 1.0 - one_is_bad;
  for (Index k = 0; k < n; ++k) {
    if (!(Q(k, k) > 1e-6 * weights.inverse(k, k))) continue;
    const double gain = std::min(g(k) * g(k) / Q(k, k), 1000.0);
    const double width = std::sqrt(2.0 * std::numbers::pi / Q(k, k)) / (2.0 * bad_by_mps2);
    likelihood += one_is_bad / static_cast<double>(n) * std::min(width, 1.0) * std::exp(0.5 * gain);
  }
  return weights.log_determinant + cofactor.log_determinant + residuals.r.dot(g) -
         2.0 * std::log(likelihood);
}

// Half of the probability at zero, the rest over the others.
double prior_score(double ratio) {
  constexpr double others = static_cast<double>(ratios.size() - 1);
  return ratio == 0.0 ? 2.0 * std::log(2.0) : 2.0 * std::log(2.0 * others);
}

std::vector<GridPoint> scored(View<RestSession> sessions,
                              const Units& units,
                              const Residuals& residuals) {
  std::vector<GridPoint> grid;
  for (const double flicker : ratios)
    for (const double walk : ratios) {
      GridPoint& at = grid.emplace_back();
      at.f = flicker / (units.dwell * units.of_flicker);
      at.k = walk / (units.dwell * units.of_walk);
      at.score = prior_score(flicker) + prior_score(walk);
      score_rests(sessions, at);
      at.score += score_of(residuals, covariances(units, sessions, at));
    }
  return grid;
}

// A strength over the grid.
struct OverGrid {
  double sum = 0.0, squares = 0.0;

  void add(double weight, double value) {
    sum += weight * value;
    squares += weight * value * value;
  }
  [[nodiscard]] double cautious(double total) const {
    const double mean = sum / total;
    return mean + std::sqrt(std::max(0.0, squares / total - mean * mean));
  }
};

bool known(View<RestSession> sessions) {
  return std::ranges::all_of(sessions, [](const RestSession& session) {
    return session.rests > 0 && std::ranges::all_of(session.levels, [](const auto& levels) {
             return !levels.empty() && levels.front().variance > 0.0;
           });
  });
}

}  // namespace

std::optional<SessionNoise> session_noise(View<Pose> poses,
                                          View<RestSession> sessions,
                                          MultiPositionOptions options) {
  if (sessions.empty() || !known(sessions) || poses.size() > most_poses) return std::nullopt;
  if (options.model && *options.model != PoseModel::norm_9) return std::nullopt;
  const Units units = units_of(sessions);
  if (units.samples.size() != static_cast<Index>(poses.size())) return std::nullopt;
  const Result<MultiPosition> fit = calibrate_positions(poses, options);
  if (!fit || fit->model != PoseModel::norm_9) return std::nullopt;
  const Residuals residuals = residuals_of(poses, *fit);
  const std::vector<GridPoint> grid = scored(sessions, units, residuals);
  const double best = std::ranges::min(grid, {}, &GridPoint::score).score;
  double total = 0.0;
  Matrices C;
  std::array<OverGrid, 3> flicker, walk;
  SessionNoise out{.poses = {poses.begin(), poses.end()}, .between = {}};
  for (MatrixXd& one : C) one = MatrixXd::Zero(units.samples.size(), units.samples.size());
  for (const GridPoint& at : grid) {
    const double weight = std::exp(-0.5 * (at.score - best));
    const Matrices own = covariances(units, sessions, at);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      C[axis] += weight * own[axis];
      flicker[axis].add(weight, at.white[axis] * at.f);
      walk[axis].add(weight, at.white[axis] * at.k);
    }
    total += weight;
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    out.flicker[axis] = flicker[axis].cautious(total);
    out.random_walk[axis] = walk[axis].cautious(total);
    out.between[axis] = C[axis] / total;
    const auto place = static_cast<Index>(axis);
    for (std::size_t k = 0; k < poses.size(); ++k) {
      const auto row = static_cast<Index>(k);
      out.poses[k].mean_covariance(place, place) = out.between[axis](row, row);
    }
  }
  return out;
}

}  // namespace proofmass::calibrate
