#include "proofmass/sensor/calibration_effect.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "proofmass/core/chi_square.hpp"
#include "proofmass/core/directions.hpp"
#include "proofmass/core/linalg.hpp"
#include "proofmass/core/random.hpp"
#include "proofmass/core/statistics.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/sensor/calibration_error.hpp"
#include "proofmass/sensor/file/fields.hpp"

namespace proofmass::sensor {
namespace {

using Eigen::Index;
using Eigen::Vector3d;

constexpr double g_mps2 = standard_gravity_mps2;

/// The standard deviations of nine figures and their correlations.
struct Spread {
  Eigen::VectorXd std = Eigen::VectorXd::Zero(9);
  Eigen::MatrixXd correlation = Eigen::MatrixXd::Identity(9, 9);
};

/// For the figures that are not carried over; an Error names one without a standard deviation.
Result<Spread> spread_of(const Calibration& mine, const Calibration& other) {
  const auto figures = nine_figures(mine);
  const auto others = nine_figures(other);
  Spread spread;
  std::array<bool, 9> counts{};
  for (std::size_t k = 0; k < 9; ++k) {
    counts[k] = figures[k]->has_value() && !carried_over(*figures[k], *others[k]);
    if (!counts[k]) continue;
    const auto std = (*figures[k])->std_si();
    if (!std && !mine.covariance)
      return Error{Errc::invalid_argument, "a calibration figure has no standard deviation"};
    spread.std(static_cast<Index>(k)) =
        mine.covariance ? std::sqrt(std::max((*mine.covariance)[k][k], 0.0)) : *std;
  }
  if (!mine.covariance) return spread;
  for (std::size_t i = 0; i < 9; ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const auto a = static_cast<Index>(i), b = static_cast<Index>(j);
      const double size = spread.std(a) * spread.std(b);
      if (counts[i] && counts[j] && size > 0.0)
        spread.correlation(a, b) = spread.correlation(b, a) = (*mine.covariance)[i][j] / size;
    }
  return spread;
}

/// One of the two files: change of the error for one standard deviation of each of its figures.
struct Side {
  std::array<Affine, 9> columns;
  Eigen::MatrixXd correlation, root;  ///< root · rootᵀ = correlation
  std::optional<double> dof;

  /// Variance of direction · e(u).
  [[nodiscard]] double variance(const Vector3d& direction, const Vector3d& u) const {
    Eigen::VectorXd slope(9);
    for (std::size_t k = 0; k < 9; ++k) slope(static_cast<Index>(k)) = direction.dot(columns[k](u));
    return std::max(slope.dot(correlation * slope), 0.0);
  }
};

/// `error` gives e(u) with another calibration on this side.
template <class ErrorOf>
Result<Side> side_of(const Calibration& mine, const Calibration& other, ErrorOf error) {
  const auto spread = spread_of(mine, other);
  if (!spread) return spread.error();
  Side side;
  side.correlation = spread->correlation;
  const SymmetricEigen eigen = symmetric_eigen(spread->correlation);
  side.root = eigen.vectors * eigen.values.cwiseMax(0.0).cwiseSqrt().asDiagonal();
  if (mine.dof) side.dof = mine.dof->si();
  for (std::size_t k = 0; k < 9; ++k) {
    const double std = spread->std(static_cast<Index>(k));
    if (std == 0.0) continue;
    Calibration up = mine, down = mine;
    std::optional<Figure>& above = *nine_figures(up)[k];
    above->value += std / above->unit.to_si;
    std::optional<Figure>& below = *nine_figures(down)[k];
    below->value -= std / below->unit.to_si;
    const auto high = error(up), low = error(down);
    if (!high || !low)
      return Error{Errc::invalid_argument,
                   "a scale is not distinguishable from 0 by its standard deviation"};
    side.columns[k] = {0.5 * (high->matrix - low->matrix), 0.5 * (high->offset - low->offset)};
  }
  return side;
}

/// Maximum of a function on the unit sphere: the best of many directions, refined.
template <class Function>
LargestError largest(Function f) {
  std::vector<std::pair<double, Vector3d>> tried;
  for (const Vector3d& u : spread_directions(1000)) tried.emplace_back(f(u), u);
  constexpr std::ptrdiff_t kept = 8;
  std::partial_sort(tried.begin(), tried.begin() + kept, tried.end(),
                    [](const auto& a, const auto& b) { return a.first > b.first; });
  LargestError best;
  best.value = -1.0;
  for (auto start = tried.begin(); start != tried.begin() + kept; ++start) {
    auto [value, u] = *start;
    for (double step = 0.1; step > 1e-9;) {
      bool better = false;
      for (Index axis = 0; axis < 3; ++axis)
        for (const double sign : {1.0, -1.0}) {
          const Vector3d moved = (u + sign * step * Vector3d::Unit(axis)).normalized();
          if (const double there = f(moved); there > value) {
            value = there;
            u = moved;
            better = true;
          }
        }
      if (!better) step *= 0.5;
    }
    if (value > best.value) best = {value, std::nullopt, std::nullopt, u};
  }
  return best;
}

double angle_rad(const Vector3d& u, const Vector3d& force) {
  const double along = u.dot(force);
  return std::atan2((force - along * u).norm(), along);
}

/// ∂ angle(u, f) / ∂ f.
Vector3d angle_slope(const Vector3d& u, const Vector3d& force) {
  const Vector3d across = force - u.dot(force) * u;
  if (across.norm() == 0.0) return Vector3d::Zero();
  const double angle = angle_rad(u, force);
  return (std::cos(angle) * across.normalized() - std::sin(angle) * u) / force.norm();
}

void add_scatter(const Side& side, Random& random, Affine& error) {
  Eigen::VectorXd draws(9);
  for (double& x : draws) x = random.normal();
  Eigen::VectorXd moved = side.root * draws;
  // Half a step of the generator keeps the probability away from 0, where the quantile is infinite.
  if (side.dof) {
    const double p = random.unit() + 0x1p-54;
    moved *= std::sqrt(*side.dof / chi_square_quantile(p, *side.dof));
  }
  for (std::size_t k = 0; k < 9; ++k) {
    error.matrix += moved(static_cast<Index>(k)) * side.columns[k].matrix;
    error.offset += moved(static_cast<Index>(k)) * side.columns[k].offset;
  }
}

/// Computes by_chance_95 from pairs of calibrations that differ by their uncertainty alone.
void put_chance(const Side& before, const Side& after, CalibrationEffect& effect) {
  constexpr int pairs = 4000;
  const std::vector<Vector3d> directions = spread_directions(250);
  Random random(1, "chance");
  std::vector<double> forces, angles;
  for (int k = 0; k < pairs; ++k) {
    Affine error;
    add_scatter(before, random, error);
    add_scatter(after, random, error);
    double force = 0.0, across = 0.0;
    for (const Vector3d& u : directions) {
      const Vector3d e = error(u);
      const double along = e.dot(u), square = e.squaredNorm();
      force = std::max(force, square);
      across = std::max(across, square - along * along);
    }
    forces.push_back(std::sqrt(force));
    angles.push_back(std::atan(std::sqrt(std::max(across, 0.0)) / g_mps2));
  }
  effect.force_mps2.by_chance_95 = quantile(forces, 0.95);
  effect.angle_rad.by_chance_95 = quantile(angles, 0.95);
}

void put_uncertainty(const Affine& error,
                     const Side& before,
                     const Side& after,
                     CalibrationEffect& effect) {
  const auto std_of = [&](const Vector3d& direction, const Vector3d& u) {
    return std::sqrt(before.variance(direction, u) + after.variance(direction, u));
  };
  LargestError& force = effect.force_mps2;
  force.std = std_of(error(force.up).normalized(), force.up);
  LargestError& angle = effect.angle_rad;
  angle.std = std_of(angle_slope(angle.up, g_mps2 * angle.up + error(angle.up)), angle.up);
  put_chance(before, after, effect);
}

}  // namespace

bool carried_over(const std::optional<Figure>& before, const std::optional<Figure>& after) {
  return before && before == after;
}

Result<CalibrationEffect> calibration_effect(const SensorModel& before, const SensorModel& after) {
  CalibrationEffect effect;
  effect.reading_unit = common_unit(before, after);
  const auto error = error_between(before, after, effect.reading_unit);
  if (!error) return error.error();
  effect.force_mps2 = largest([&](const Vector3d& u) { return (*error)(u).norm(); });
  effect.angle_rad =
      largest([&](const Vector3d& u) { return angle_rad(u, g_mps2 * u + (*error)(u)); });
  const auto with = [&](const SensorModel& model, const Calibration& calibration) {
    SensorModel changed = model;
    changed.calibration = calibration;
    return changed;
  };
  const auto old_side =
      side_of(before.calibration, after.calibration, [&](const Calibration& calibration) {
        return error_between(with(before, calibration), after, effect.reading_unit);
      });
  const auto new_side =
      side_of(after.calibration, before.calibration, [&](const Calibration& calibration) {
        return error_between(before, with(after, calibration), effect.reading_unit);
      });
  if (!old_side || !new_side) {
    effect.without_std =
        !old_side ? old_side.error().at("OLD").message : new_side.error().at("NEW").message;
    return effect;
  }
  put_uncertainty(*error, *old_side, *new_side, effect);
  return effect;
}

}  // namespace proofmass::sensor
