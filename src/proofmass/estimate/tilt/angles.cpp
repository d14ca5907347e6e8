#include "proofmass/estimate/tilt/angles.hpp"

#include <algorithm>
#include <cmath>

#include "proofmass/core/units.hpp"

namespace proofmass::estimate {
namespace {

// Beyond it the first-order standard deviation of an angle is meaningless.
constexpr double largest_std_rad = 0.5;

double std_along(const Mat<3>& gradient, const Mat<3, 3>& cov) {
  return std::sqrt(std::max(0.0, gradient.dot(cov * gradient)));
}

std::string degrees(double angle_rad) {
  const double tenths = std::round(std::abs(angle_rad) / rad_per_deg * 10.0);
  std::string text = std::to_string(static_cast<long>(tenths) / 10);
  return text + "." + std::to_string(static_cast<long>(tenths) % 10) + " degrees";
}

// asin(f/g) and its standard deviation; absent if the axis is too near the vertical.
std::optional<Uncertain> elevation(double force, double variance, const Uncertain& gravity) {
  const double sine = force / gravity.value;
  if (!(std::abs(sine) < 1.0)) return std::nullopt;
  const double cosine = std::sqrt(1.0 - sine * sine);
  const double std = std::hypot(std::sqrt(variance), sine * gravity.std) / (gravity.value * cosine);
  // The sine is not monotonic at the vertical: within two standard deviations of it there are two
  // solutions.
  if (std > largest_std_rad || cosine < 2.0 * std) return std::nullopt;
  return Uncertain{std::asin(sine), std};
}

void set_roll(TiltAngles& out, const Mat<3>& f, const Mat<3, 3>& cov) {
  const double across = f.y() * f.y() + f.z() * f.z();
  const double std =
      across > 0.0 ? std_along({0.0, f.z() / across, -f.y() / across}, cov) : largest_std_rad * 2.0;
  if (across == 0.0 || std > largest_std_rad) {
    out.why_no_roll = "the x axis is vertical, where roll and heading are the same angle";
    return;
  }
  out.roll_rad = Uncertain{std::atan2(f.y(), f.z()), std};
}

std::optional<Inclination> inclination_of(const Mat<3>& f, const Mat<3, 3>& cov) {
  Eigen::Index axis = 0;
  f.cwiseAbs().maxCoeff(&axis);
  const Eigen::Index a = (axis + 1) % 3, b = (axis + 2) % 3;
  const double across = std::hypot(f(a), f(b)), squares = f.squaredNorm();
  // Along the inclination; without one, any direction across the axis.
  Mat<3> lean = Mat<3>::Unit(a);
  if (across > 0.0) lean = (f(a) * Mat<3>::Unit(a) + f(b) * Mat<3>::Unit(b)) / across;
  const double size = std::abs(f(axis));
  const Mat<3> gradient =
      (size * lean - across * std::copysign(1.0, f(axis)) * Mat<3>::Unit(axis)) / squares;
  Inclination out{.axis = static_cast<std::size_t>(axis),
                  .up = f(axis) > 0.0,
                  .angle_rad = {std::atan2(across, size), std_along(gradient, cov)},
                  .azimuth_rad = std::nullopt};
  if (out.angle_rad.std > largest_std_rad) return std::nullopt;
  if (out.angle_rad.value < 2.0 * out.angle_rad.std) return out;
  const Mat<3> turn = (f(a) * Mat<3>::Unit(b) - f(b) * Mat<3>::Unit(a)) / (across * across);
  const double std = std_along(turn, cov);
  if (std < largest_std_rad) out.azimuth_rad = Uncertain{std::atan2(f(b), f(a)), std};
  return out;
}

}  // namespace

TiltAngles angles_of(const Mat<3>& force, const Mat<3, 3>& cov) {
  const double norm = force.norm();
  TiltAngles out;
  // A sensor in free fall, or without signal, has no direction of gravity.
  constexpr double least = 1e-100;
  if (!(norm > least)) {
    out.why_no_roll = out.why_no_pitch = "the data do not determine the direction";
    return out;
  }
  set_roll(out, force, cov);
  out.inclination = inclination_of(force, cov);
  for (int i = 0; i < 3; ++i) {
    // d asin(f_i / |f|) = (e_i − f f_i / |f|²)ᵀ df / √(|f|² − f_i²)
    const double across = std::sqrt(std::max(0.0, norm * norm - force(i) * force(i)));
    Mat<3> gradient = Mat<3>::Unit(i) - force * (force(i) / (norm * norm));
    const double std = std_along(gradient, cov) / std::max(across, 1e-9 * norm);
    if (across > 0.0 && std < largest_std_rad)
      out.elevation_rad[static_cast<std::size_t>(i)] = Uncertain{std::atan2(force(i), across), std};
  }
  const double across = std::hypot(force.y(), force.z());
  Mat<3> gradient{-across, 0.0, force.x()};  // if x is vertical, any direction across it
  if (across > 0.0)
    gradient = {-across, force.x() * force.y() / across, force.x() * force.z() / across};
  const double std = std_along(gradient, cov) / (norm * norm);
  if (std > largest_std_rad)
    out.why_no_pitch = "the data do not determine the direction";
  else
    out.pitch_rad = Uncertain{std::atan2(-force.x(), across), std};
  return out;
}

namespace {

// A force of which some axes are missing (NaN).
struct PartOfForce {
  Mat<3> force;
  Mat<3, 3> cov;
  Uncertain gravity;

  [[nodiscard]] bool has(int axis) const { return std::isfinite(force(axis)); }
  /// Covariance without an axis that is 0 by assumption.
  [[nodiscard]] Mat<3, 3> cov_without(int axis) const {
    Mat<3, 3> known = cov;
    known.row(axis).setZero();
    known.col(axis).setZero();
    return known;
  }
  /// Norm of the force across x.
  [[nodiscard]] double across() const {
    return std::sqrt(gravity.value * gravity.value - force.x() * force.x());
  }
};

void set_pitch_of(const PartOfForce& part, TiltAngles& out) {
  const Mat<3>& f = part.force;
  if (part.has(0) && out.elevation_rad[0])
    out.pitch_rad = Uncertain{-out.elevation_rad[0]->value, out.elevation_rad[0]->std};
  else if (part.has(0))
    out.why_no_pitch = "the x axis is nearly vertical, where its output is insensitive to tilt";
  else if (part.has(1) && part.has(2))
    out.why_no_pitch =
        "without an x axis only its magnitude is known, " +
        degrees(std::acos(std::min(1.0, std::hypot(f.y(), f.z()) / part.gravity.value)));
  else
    out.why_no_pitch = "needs the x axis, or y and z for its magnitude";
}

// sin roll = f_y / √(g² − f_x²), with z upwards.
void set_roll_by_y(const PartOfForce& part, TiltAngles& out) {
  const double across = part.across();
  const double sine = part.force.y() / across;
  const double cosine = std::sqrt(std::max(0.0, 1.0 - sine * sine));
  const Mat<3> gradient{sine * part.force.x() / across, 1.0, 0.0};
  const double std = std::hypot(std_along(gradient, part.cov_without(2)),
                                sine * part.gravity.value / across * part.gravity.std) /
                     (across * std::max(cosine, 1e-9));
  if (cosine > 2.0 * std && std < largest_std_rad)
    out.roll_rad = Uncertain{std::asin(sine), std};
  else
    out.why_no_roll = "the y axis is nearly vertical, where its output is insensitive to tilt";
}

void set_roll_of(const PartOfForce& part, TiltAngles& out) {
  const Mat<3>& f = part.force;
  if (part.has(1) && part.has(2)) return set_roll(out, {0.0, f.y(), f.z()}, part.cov_without(0));
  if (part.has(0) && part.has(1) && out.pitch_rad) return set_roll_by_y(part, out);
  if (!part.has(0) || !part.has(2)) {
    out.why_no_roll = "it takes the y axis and another";
    return;
  }
  out.why_no_roll = "without a y axis only its magnitude is known";
  if (out.pitch_rad)
    out.why_no_roll += ", " + degrees(std::acos(std::clamp(f.z() / part.across(), -1.0, 1.0)));
}

}  // namespace

TiltAngles angles_of_some(const Mat<3>& force,
                          const Mat<3, 3>& cov,
                          const Uncertain& gravity_mps2) {
  if (force.allFinite()) return angles_of(force, cov);
  const PartOfForce part{force, cov, gravity_mps2};
  TiltAngles out;
  for (int i = 0; i < 3; ++i)
    if (part.has(i))
      out.elevation_rad[static_cast<std::size_t>(i)] = elevation(force(i), cov(i, i), gravity_mps2);
  set_pitch_of(part, out);
  set_roll_of(part, out);
  return out;
}

}  // namespace proofmass::estimate
