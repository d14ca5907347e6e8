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

TiltAngles angles_of_some(const Mat<3>& force,
                          const Mat<3, 3>& cov,
                          const Uncertain& gravity_mps2) {
  if (force.allFinite()) return angles_of(force, cov);
  TiltAngles out;
  for (int i = 0; i < 3; ++i)
    if (std::isfinite(force(i)))
      out.elevation_rad[static_cast<std::size_t>(i)] = elevation(force(i), cov(i, i), gravity_mps2);
  const bool x = std::isfinite(force.x()), y = std::isfinite(force.y()),
             z = std::isfinite(force.z());
  const double g = gravity_mps2.value;
  if (x && out.elevation_rad[0])
    out.pitch_rad = Uncertain{-out.elevation_rad[0]->value, out.elevation_rad[0]->std};
  else if (x)
    out.why_no_pitch = "the x axis is nearly vertical, where its output is insensitive to tilt";
  else if (y && z)
    out.why_no_pitch = "without an x axis only its magnitude is known, " +
                       degrees(std::acos(std::min(1.0, std::hypot(force.y(), force.z()) / g)));
  else
    out.why_no_pitch = "needs the x axis, or y and z for its magnitude";
  if (y && z) {
    Mat<3, 3> known = cov;
    known.row(0).setZero();
    known.col(0).setZero();
    set_roll(out, {0.0, force.y(), force.z()}, known);
  } else if (x && y && out.pitch_rad) {
    // sin roll = f_y / √(g² − f_x²), with z upwards
    const double across = std::sqrt(g * g - force.x() * force.x());
    const double sine = force.y() / across;
    const double cosine = std::sqrt(std::max(0.0, 1.0 - sine * sine));
    const Mat<3> gradient{sine * force.x() / across, 1.0, 0.0};
    Mat<3, 3> known = cov;
    known.row(2).setZero();
    known.col(2).setZero();
    const double std =
        std::hypot(std_along(gradient, known), sine * g / across * gravity_mps2.std) /
        (across * std::max(cosine, 1e-9));
    if (cosine > 2.0 * std && std < largest_std_rad)
      out.roll_rad = Uncertain{std::asin(sine), std};
    else
      out.why_no_roll = "the y axis is nearly vertical, where its output is insensitive to tilt";
  } else if (x && z) {
    out.why_no_roll = "without a y axis only its magnitude is known";
    if (out.pitch_rad) {
      const double across = std::sqrt(g * g - force.x() * force.x());
      out.why_no_roll += ", " + degrees(std::acos(std::clamp(force.z() / across, -1.0, 1.0)));
    }
  } else {
    out.why_no_roll = "it takes the y axis and another";
  }
  return out;
}

}  // namespace proofmass::estimate
