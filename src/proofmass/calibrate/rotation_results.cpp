#include "proofmass/calibrate/rotation_results.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "proofmass/calibrate/cross_axis.hpp"
#include "proofmass/core/chi_square.hpp"
#include "proofmass/core/linalg.hpp"
#include "proofmass/core/units.hpp"

namespace proofmass::calibrate {
namespace {

using Eigen::Index;
using Q = RotationQuantity;

constexpr std::string_view one_speed =
    "radius and radial bias cannot be told apart at one speed: record a second speed";

// A quantity's value and its derivatives by the eight harmonics of its axis.
struct Derived {
  double value = 0.0;
  Harmonics gradient = Harmonics::Zero();
};

// numerator/denominator, both linear in the harmonics.
Derived ratio(const Harmonics& h, const Harmonics& above, const Harmonics& below) {
  const double a = above.dot(h), b = below.dot(h);
  return {a / b, above / b - a / (b * b) * below};
}

Harmonics unit(std::initializer_list<std::pair<Index, double>> parts) {
  Harmonics vector = Harmonics::Zero();
  for (const auto& [at, factor] : parts) vector(at) = factor;
  return vector;
}

struct Speeds {
  double gravity_mps2, mean_square;
};

Derived derived(Q quantity, const Harmonics& h, const Speeds& at) {
  const double g = at.gravity_mps2;
  const Harmonics k1 = unit({{1, 1.0 / g}, {5, 3.0 / g}});
  switch (quantity) {
    case Q::K1:
      return {k1.dot(h), k1};
    case Q::K0:
      return ratio(h, unit({{0, 1.0}, {4, 1.0}, {7, 1.0}}), k1);
    case Q::K0_radial:
      return ratio(h, unit({{0, 1.0}, {4, 1.0}}), k1);
    case Q::misalignment:
      return ratio(h, unit({{2, 1.0 / g}}), k1);
    case Q::K2_minus_Kpp:
      return ratio(h, unit({{4, -2.0 / (g * g)}}), k1);
    case Q::Kip:
      return ratio(h, unit({{3, 2.0 / (g * g)}}), k1);
    case Q::K3:
      return ratio(h, unit({{5, -4.0 / (g * g * g)}}), k1);
    case Q::radius:
      return ratio(h, unit({{7, 1.0 / at.mean_square}}), k1);
  }
  return {};
}

// How the value follows gravity: value · power · u(g)/g.
double power_of_gravity(Q quantity) {
  switch (quantity) {
    case Q::K1:
    case Q::K2_minus_Kpp:
    case Q::Kip:
      return -1.0;
    case Q::K3:
      return -2.0;
    case Q::K0:
    case Q::K0_radial:
    case Q::radius:
      return 1.0;
    case Q::misalignment:
      return 0.0;
  }
  return 0.0;
}

std::string why_not(const RotationState& state,
                    const RotationFit& fit,
                    std::size_t axis,
                    Q quantity) {
  const auto accepted = [&](int per_turn) {
    return std::ranges::any_of(fit.ripples, [&](const SpeedRipple& one) {
      return one.per_turn == per_turn && one.accepted;
    });
  };
  switch (quantity) {
    case Q::K0:
    case Q::radius:
      return state.speed_told ? "" : std::string(one_speed);
    case Q::misalignment:
      return state.angle_given || axis > 0
                 ? ""
                 : "without an encoder the misalignment is part of the phase";
    case Q::K2_minus_Kpp:
    case Q::Kip:
      return accepted(1)
                 ? "the second harmonics of both axes are those of a speed that varies once "
                   "a turn: what the sensor adds to them cannot be told"
                 : "";
    case Q::K3:
      return accepted(2)
                 ? "the third harmonics of both axes are those of a speed that varies twice "
                   "a turn: what the sensor adds to them cannot be told"
                 : "";
    default:
      return "";
  }
}

double half_width(double std, double dof) {
  return std * student_t_quantile(0.975, dof);
}

// Of two slow figures, their correlation that of the blocks.
Eigen::Matrix2d slow_covariance(const Eigen::MatrixXd& J, const RotationEstimate& estimate) {
  const Eigen::Matrix2d blocks = J * estimate.covariance() * J.transpose();
  Eigen::Vector2d factor;
  for (Index k = 0; k < 2; ++k) {
    const double std = estimate.spread_of(J.row(k).transpose(), true).std;
    factor(k) = blocks(k, k) > 0.0 ? std / std::sqrt(blocks(k, k)) : 0.0;
  }
  return factor.asDiagonal() * blocks * factor.asDiagonal();
}

void fill_radius(const RotationState& state,
                 const RotationEstimate& estimate,
                 const RotationOptions& options,
                 RotationFit& fit) {
  RotationCoefficient& radius = fit.radius;
  if (!state.speed_told) {
    radius.reason = one_speed;
    return;
  }
  if (state.axes == 1) {
    radius = fit.axes[0][Q::radius];
    return;
  }
  const Index size = state.size();
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(2, size);
  Eigen::Vector2d along;
  for (Index axis = 0; axis < 2; ++axis) {
    const Derived one = derived(Q::radius, estimate.harmonics.segment<8>(8 * axis),
                                {options.gravity_mps2, state.mean_square_speed});
    along(axis) = one.value;
    J.row(axis).segment<8>(8 * axis) = one.gradient.transpose();
  }
  const Eigen::Matrix2d C = slow_covariance(J, estimate);
  const double dof = estimate.spread_of(J.row(0).transpose(), true).dof;
  const auto length = cross_axis_sensitivity(along, C, dof);
  if (!length) {
    radius.reason = length.error().message;
  } else if (!length->value) {
    radius.reason = fmt::format("the radius is not told from zero: it is below {:.3g} m (95 %)",
                                length->upper_95);
  } else {
    radius.value = length->value;
    radius.half_width_95 = half_width(length->value->std, dof);
  }
}

// Sums of so many neighbours of one section; what is left over goes to the last of its section.
std::vector<double> joined_blocks(const Eigen::VectorXd& z,
                                  const std::vector<std::size_t>& section,
                                  std::size_t to_one) {
  std::vector<double> joined;
  for (std::size_t begin = 0; begin < section.size();) {
    std::size_t end = begin;
    while (end < section.size() && section[end] == section[begin]) ++end;
    const std::size_t whole = std::max<std::size_t>((end - begin) / to_one, 1);
    const std::size_t first = joined.size();
    joined.resize(first + whole, 0.0);
    for (std::size_t b = begin; b < end; ++b) {
      joined[first + std::min((b - begin) / to_one, whole - 1)] += z(static_cast<Index>(b));
    }
    begin = end;
  }
  return joined;
}

// Harmonics of both axes relative to S1 that a ripple moves, and by what: rows of M, e = (e_s,
// e_c).
struct RippleModel {
  std::array<Index, 4> seen;  ///< places of the four harmonics that judge
  Eigen::Matrix<double, 4, 2> M;
  Eigen::Matrix<double, 16, 2> moved;  ///< all that it moves
};

// The first axis's C1 is taken up by the phase, which turns the second with it.
void move_phase(Eigen::Matrix<double, 16, 2>& moved) {
  moved.row(10) -= moved.row(2);
  moved.row(2).setZero();
}

// Once a turn: −r ω² and r ω̇ along each axis, with ω = ω̄ (1 + e_s cos φ − e_c sin φ), in g.
void add_radius(const Eigen::VectorXd& harmonics, RippleModel& model) {
  // A ω̄² over K1 g: r ω̄² in g, of each axis.
  const double r1 = harmonics(7) / harmonics(1), r2 = harmonics(15) / harmonics(9);
  auto& moved = model.moved;
  moved(1, 0) += r2;
  moved(1, 1) += 2.0 * r1;
  moved(2, 0) -= 2.0 * r1;
  moved(2, 1) += r2;
  moved(9, 0) -= 2.0 * r2;
  moved(9, 1) -= r1;
  moved(10, 0) += r1;
  moved(10, 1) -= 2.0 * r2;
  move_phase(moved);
}

// With ε = e_s sin nφ + e_c cos nφ the error of the phase, δE = ∂E/∂φ ε in each axis's own phase.
RippleModel ripple_model(int per_turn) {
  RippleModel model{{}, Eigen::Matrix<double, 4, 2>::Zero(), Eigen::Matrix<double, 16, 2>::Zero()};
  auto& moved = model.moved;
  if (per_turn == 1) {
    model.seen = {3, 4, 11, 12};
    moved(3, 0) = moved(4, 1) = moved(0, 1) = 0.5;
    moved(11, 1) = 0.5;
    moved(12, 0) = moved(8, 0) = -0.5;
  } else {
    model.seen = {5, 6, 13, 14};
    moved(1, 0) = moved(5, 0) = moved(2, 1) = moved(6, 1) = 0.5;
    moved(9, 0) = moved(13, 0) = moved(10, 1) = moved(14, 1) = -0.5;
    move_phase(moved);
  }
  for (std::size_t k = 0; k < 4; ++k) model.M.row(static_cast<Index>(k)) = moved.row(model.seen[k]);
  return model;
}

// Hotelling's T² of so many dimensions.
double chance_of(double squared, double dimensions, double dof) {
  const double below = dof - dimensions + 1.0;
  if (below < 1.0) return 1.0;
  return fisher_f_p(std::max(squared, 0.0) * below / (dimensions * dof), dimensions, below);
}

Eigen::Matrix4d inverse_of(const Eigen::Matrix4d& C) {
  // C is 4 × 4 and positive, so that its eigenvalues will do.
  const SymmetricEigen eigen = symmetric_eigen(C);
  const Eigen::Vector4d floor = Eigen::Vector4d::Constant(1e-12 * eigen.values.maxCoeff() + 1e-300);
  const Eigen::Vector4d inverse = eigen.values.cwiseMax(floor).cwiseInverse();
  return eigen.vectors * inverse.asDiagonal() * eigen.vectors.transpose();
}

}  // namespace

std::string_view name_of(RotationQuantity quantity) {
  constexpr std::array<std::string_view, rotation_quantities> names{
      "K1", "K0", "K0_radial", "misalignment_rad", "K2_minus_Kpp", "Kip", "K3", "radius_m"};
  return names[static_cast<std::size_t>(quantity)];
}

RotationSpread RotationEstimate::spread_of(const Eigen::VectorXd& gradient, bool slow) const {
  constexpr double least_joined = 6.0, most_to_one = 3.0, one_sided_95 = 1.645;
  const Eigen::VectorXd z = blocks.scores.transpose() * gradient;
  const auto count = static_cast<double>(z.size());
  const double squares = z.squaredNorm();
  double products = 0.0;
  for (Index b = 0; b + 1 < z.size(); ++b) {
    const auto at = static_cast<std::size_t>(b);
    if (blocks.section[at] == blocks.section[at + 1]) products += z(b) * z(b + 1);
  }
  // Expected of independent blocks about their mean: −1/B.
  const double rho = squares > 0.0 ? products / squares + 1.0 / count : 0.0;
  RotationSpread spread{0.0, dof(), rho * std::sqrt(count) > one_sided_95};
  double variance = squares * count / (count - 1.0);
  if (spread.widened) variance *= (1.0 + std::min(rho, 0.9)) / (1.0 - std::min(rho, 0.9));
  const auto to_one =
      static_cast<std::size_t>(std::clamp(std::floor(count / least_joined), 1.0, most_to_one));
  if (slow && to_one > 1) {
    const std::vector<double> joined = joined_blocks(z, blocks.section, to_one);
    double sum = 0.0;
    for (const double x : joined) sum += x * x;
    const auto left = static_cast<double>(joined.size());
    spread.dof = left - static_cast<double>(constraints);
    variance = std::max(spread.widened ? variance : 0.0, sum * left / (left - 1.0));
  }
  spread.std = std::sqrt(variance);
  return spread;
}

double RotationEstimate::dof() const {
  return static_cast<double>(blocks.scores.cols()) - static_cast<double>(constraints);
}

Eigen::MatrixXd RotationEstimate::covariance() const {
  const auto count = static_cast<double>(blocks.scores.cols());
  return blocks.scores * blocks.scores.transpose() * (count / (count - 1.0));
}

void separate_ripples(const RotationState& state, RotationEstimate& estimate, RotationFit& fit) {
  constexpr double beyond_chance = 0.01, ordinary = 0.05;
  for (const int per_turn : {1, 2}) {
    RippleModel model = ripple_model(per_turn);
    if (per_turn == 1 && state.speed_told) add_radius(estimate.harmonics, model);
    // Everything relative to the axis's own S1.
    Eigen::VectorXd scale(16);
    scale << Eigen::VectorXd::Constant(8, estimate.harmonics(1)),
        Eigen::VectorXd::Constant(8, estimate.harmonics(9));
    Eigen::Matrix<double, 4, 16> pick = Eigen::Matrix<double, 4, 16>::Zero();
    for (Index k = 0; k < 4; ++k) {
      const Index at = model.seen[static_cast<std::size_t>(k)];
      pick(k, at) = 1.0 / scale(at);
    }
    const Eigen::Vector4d v = pick * estimate.harmonics;
    const Eigen::Matrix4d W = inverse_of(pick * estimate.covariance() * pick.transpose());
    const Eigen::Matrix2d A = positive_inverse(model.M.transpose() * W * model.M);
    const Eigen::Matrix<double, 2, 4> P = A * model.M.transpose() * W;
    const Eigen::Vector2d e = P * v;
    const Eigen::Vector4d left = v - model.M * e;
    SpeedRipple ripple{.per_turn = per_turn};
    ripple.chance_p = chance_of(v.dot(W * v), 4.0, estimate.dof());
    ripple.ripple_p = chance_of(left.dot(W * left), 2.0, estimate.dof());
    ripple.accepted = ripple.chance_p < beyond_chance && ripple.ripple_p > ordinary;
    // Δω/ω is the derivative of the phase's error by the phase: n times as large.
    const auto size = cross_axis_sensitivity(per_turn * e, per_turn * per_turn * A, estimate.dof());
    if (size && ripple.accepted) ripple.amplitude = size->value;
    fit.ripples.push_back(ripple);
    if (!ripple.accepted) continue;
    const Eigen::MatrixXd L =
        Eigen::MatrixXd::Identity(16, 16) - scale.asDiagonal() * model.moved * P * pick;
    estimate.harmonics = L * estimate.harmonics;
    estimate.blocks.scores = L * estimate.blocks.scores;
  }
}

void fill_rotation(const RotationState& state,
                   const RotationEstimate& estimate,
                   const RotationOptions& options,
                   RotationFit& fit) {
  std::string widened_names;
  fit.axes.resize(state.axes);
  const double u_g = options.gravity_std_mps2 / options.gravity_mps2;
  for (std::size_t axis = 0; axis < state.axes; ++axis) {
    const Index from = harmonic_count * static_cast<Index>(axis);
    const Harmonics h = estimate.harmonics.segment<8>(from);
    std::copy(h.begin(), h.end(), fit.axes[axis].harmonics.begin());
    for (std::size_t q = 0; q < rotation_quantities; ++q) {
      RotationCoefficient& one = fit.axes[axis].coefficients[q];
      one.quantity = static_cast<Q>(q);
      one.reason = why_not(state, fit, axis, one.quantity);
      if (!one.reason.empty()) continue;
      const Derived found =
          derived(one.quantity, h, {options.gravity_mps2, state.mean_square_speed});
      Eigen::VectorXd gradient = Eigen::VectorXd::Zero(state.size());
      gradient.segment<8>(from) = found.gradient;
      const bool slow =
          one.quantity == Q::K0 || one.quantity == Q::K0_radial || one.quantity == Q::radius;
      const RotationSpread spread = estimate.spread_of(gradient, slow);
      const double by_gravity = found.value * power_of_gravity(one.quantity) * u_g;
      one.value = Uncertain{found.value, std::hypot(spread.std, by_gravity)};
      one.half_width_95 = std::hypot(half_width(spread.std, spread.dof), 1.959964 * by_gravity);
      if (spread.widened) {
        widened_names += (widened_names.empty() ? "" : ", ") + std::string(name_of(one.quantity));
        if (state.axes > 1) widened_names += fmt::format(" of axis {}", axis + 1);
      }
    }
  }
  fill_radius(state, estimate, options, fit);
  if (!widened_names.empty()) {
    fit.notes.push_back(fmt::format(
        "neighbouring blocks of {:.0f} turns agree more than chance in {}: the reading drifts; "
        "standard deviations were widened for it",
        estimate.blocks.turns_per_block, widened_names));
  }
}

void fold_turns(const RotationState& state, RotationFit& fit) {
  constexpr std::size_t bins = 72;
  constexpr double per_rad = bins / rad_per_turn;
  struct Bin {
    double reading = 0.0, residual = 0.0, squares = 0.0, count = 0.0;
  };
  std::vector<std::array<Bin, bins>> folds(state.axes);
  std::array<double, 2> squares{}, count{};
  for_each_sample(state, [&](const RotationRecording& recording, const RotationSample& sample) {
    for (std::size_t axis = 0; axis < state.axes; ++axis) {
      const double reading = recording.axes[axis][sample.k];
      const AxisAt at = axis_at(state, axis, sample, reading);
      if (!std::isfinite(at.residual)) continue;
      double phase =
          std::remainder(state.offset[axis] + state.direction * sample.theta, rad_per_turn);
      if (phase < 0.0) phase += rad_per_turn;
      Bin& bin = folds[axis][std::min(static_cast<std::size_t>(phase * per_rad), bins - 1)];
      bin.reading += reading;
      bin.residual += at.residual;
      bin.squares += at.residual * at.residual;
      bin.count += 1.0;
      squares[axis] += at.residual * at.residual;
      count[axis] += 1.0;
    }
  });
  for (std::size_t axis = 0; axis < state.axes; ++axis) {
    fit.axes[axis].residual_rms = count[axis] > 0.0 ? std::sqrt(squares[axis] / count[axis]) : 0.0;
    fit.samples = std::max(fit.samples, static_cast<std::size_t>(count[axis]));
    RotationFold& fold = fit.axes[axis].fold;
    for (std::size_t b = 0; b < bins; ++b) {
      const Bin& bin = folds[axis][b];
      if (bin.count < 2.0) continue;
      fold.angle_rad.push_back((static_cast<double>(b) + 0.5) / per_rad);
      fold.mean.push_back(bin.reading / bin.count);
      const double mean = bin.residual / bin.count;
      fold.residual.push_back(mean);
      fold.residual_std.push_back(
          std::sqrt(std::max(bin.squares / bin.count - mean * mean, 0.0) / (bin.count - 1.0)));
    }
  }
}

}  // namespace proofmass::calibrate
