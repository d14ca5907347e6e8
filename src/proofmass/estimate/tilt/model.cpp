#include "proofmass/estimate/tilt/model.hpp"

#include <algorithm>
#include <cmath>

#include "proofmass/core/so3.hpp"
#include "proofmass/core/statistics.hpp"
#include "proofmass/estimate/tilt/gyroscope.hpp"

namespace proofmass::estimate {
namespace {

// Relative uncertainty of the norm at the start: far below that of the tilt.
constexpr double norm_std = 2e-3;
// Attitude creep during a rest, rad/√s.
constexpr double creep_rad_rts = 1e-5;

// |g|² 1 − g gᵀ: the variance across g of a rotation with unit variance about every axis.
Mat<3, 3> across(const Mat<3>& g) {
  return g.squaredNorm() * Mat<3, 3>::Identity() - g * g.transpose();
}

/// Derivatives of g and v = ġ after h seconds on a great circle,
///
///     g' = c g + S v,   v' = c v − w² S g,   c = cos w h,   S = sin(w h) / w,   w = |v| / |g|,
///
/// with v the part of ġ that is perpendicular to g; T = (h c − S) / w² is dS/dw / w.
void set_great_circle_jacobian(const Mat<3>& g, const Mat<3>& v, double h, Mat<9, 9>& F) {
  const double g2 = g.squaredNorm();
  const double w2 = v.squaredNorm() / g2, w = std::sqrt(w2), angle = w * h;
  const bool tiny = angle < 1e-2;
  const double c = std::cos(angle);
  const double S = tiny ? h * (1.0 - angle * angle / 6.0) : std::sin(angle) / w;
  const double T = tiny ? -h * h * h / 3.0 : (h * c - S) / w2;
  const Mat<3, 3> I = Mat<3, 3>::Identity(), gg = g * g.transpose() / g2,
                  vv = v * v.transpose() / g2;
  const Mat<3, 3> gv = g * v.transpose() / g2, vg = gv.transpose();
  const Mat<3, 3> g_by_v = S * I - h * S * gv + T * vv;
  const Mat<3, 3> v_by_v = c * I - h * S * vv - (S + h * c) * gv;
  // v itself changes by (1 − g gᵀ/|g|²) dġ − g vᵀ/|g|² dg.
  F.topLeftCorner<3, 3>() = c * I + w2 * (h * S * gg - T * vg) - g_by_v * gv;
  F.topRightCorner<3, 3>() = g_by_v * (I - gg);
  F.bottomLeftCorner<3, 3>() = w2 * (h * S * vg + (S + h * c) * gg - S * I) - v_by_v * gv;
  F.bottomRightCorner<3, 3>() = v_by_v * (I - gg);
}

}  // namespace

TiltModel::TiltModel(const TiltEpochs& epochs, const TiltKnown& known, const TiltMotion& motion)
    : epochs_(epochs), known_(known), motion_(motion) {}

Mat<3, 3> TiltModel::turn_by_gyroscope(const Mat<9>& x,
                                       std::size_t k,
                                       Transition<9, 9>& step) const {
  const double h = epochs_.step_s[k];
  const Mat<3> rate = epochs_.rate_radps[k];
  const bool known = rate.allFinite();
  const Mat<3> turn = known ? Mat<3>((rate - x.tail<3>()) * h) : Mat<3>::Zero();
  const Mat<3, 3> R = rotation_by(-turn);
  const Mat<3> g = R * x.head<3>();
  step.mean.head<3>() = g;
  step.F.topLeftCorner<3, 3>() = R;
  if (known) step.F.topRightCorner<3, 3>() = -h * cross_matrix(g);
  const double angle_variance =
      known ? square(motion_.drive) * h +
                  turn_variance_rad2(known_.rate_scale_std, rate.squaredNorm(), h)
            : square(known_.usual_rate_radps) * h * std::max(h, unknown_turn_s);
  step.Q.topLeftCorner<3, 3>() = angle_variance * across(g);
  return R;
}

Mat<3, 3> TiltModel::turn_freely(const Mat<9>& x, std::size_t k, Transition<9, 9>& step) const {
  const double h = epochs_.step_s[k];
  const Mat<3> g = x.head<3>();
  Mat<3> v = x.tail<3>();
  if (about_smoothed_) v -= g * (g.dot(v) / g.squaredNorm());
  const Mat<3> rate = cross(v, g) / g.squaredNorm();
  const Mat<3, 3> R = rotation_by(-h * rate);
  step.mean.head<3>() = R * g;
  step.mean.tail<3>() = R * v;
  if (about_smoothed_) {
    set_great_circle_jacobian(g, v, h, step.F);
  } else {
    step.F.topLeftCorner<3, 3>() = R;
    step.F.topRightCorner<3, 3>() = h * R;
    step.F.bottomRightCorner<3, 3>() = R;
  }
  const Mat<3, 3> driven = square(motion_.drive) * across(step.mean.head<3>());
  step.Q.topLeftCorner<3, 3>() = driven * (h * h * h / 3.0);
  step.Q.topRightCorner<3, 3>() = driven * (h * h / 2.0);
  step.Q.bottomLeftCorner<3, 3>() = driven * (h * h / 2.0);
  step.Q.bottomRightCorner<3, 3>() = driven * h;
  return R;
}

Transition<9, 9> TiltModel::transition(const Mat<9>& x, std::size_t k) const {
  Transition<9, 9> step{x, Mat<9, 9>::Identity(), Mat<9, 9>::Zero(), Mat<9>::Zero()};
  const double h = epochs_.step_s[k];
  const bool rests = epochs_.resting[k] != 0, rested = epochs_.resting[k - 1] != 0;
  Mat<3, 3> R = Mat<3, 3>::Identity();
  if (rests && rested) {
    step.Q.topLeftCorner<3, 3>() = square(creep_rad_rts) * h * across(x.head<3>());
    if (!motion_.gyroscope) {
      step.mean.tail<3>().setZero();
      step.F.bottomRightCorner<3, 3>().setZero();
    }
  } else if (motion_.gyroscope) {
    R = turn_by_gyroscope(x, k, step);
  } else {
    R = turn_freely(x, k, step);
  }
  if (motion_.gyroscope)
    step.Q.bottomRightCorner<3, 3>() =
        square(known_.rate_bias_walk_radps_rts) * h * Mat<3, 3>::Identity();
  const double phi = rests || rested ? 0.0 : std::exp(-h / motion_.accel_time_s);
  // A constant acceleration in world axes rotates in the sensor axes as gravity does.
  const Mat<3> a = phi * R * x.segment<3>(3);
  step.mean.segment<3>(3) = a;
  step.F.block<3, 3>(3, 3) = phi * R;
  if (phi > 0.0 && !motion_.gyroscope)
    step.F.block<3, 3>(3, 6) =
        -h * cross_matrix(a) * cross_matrix(x.head<3>()) / x.head<3>().squaredNorm();
  else if (phi > 0.0 && epochs_.rate_radps[k].allFinite())
    step.F.block<3, 3>(3, 6) = -h * cross_matrix(a);
  if (!rests) step.Q.block<3, 3>(3, 3) = (1.0 - phi * phi) * epochs_.accel_cov_m2ps4[k];
  return step;
}

int TiltModel::accel_readings(std::size_t k) const {
  return static_cast<int>(epochs_.force_mps2[k].array().isFinite().count());
}

void TiltModel::measure(const Mat<9>& x, std::size_t k, Readings<9, 6>& out) const {
  out.count = 0;
  const auto add = [&out](const Reading<9>& reading) {
    out.rows[static_cast<std::size_t>(out.count++)] = reading;
  };
  const bool rests = epochs_.resting[k] != 0;
  for (int i = 0; i < 3; ++i) {
    const double f = epochs_.force_mps2[k](i);
    if (!std::isfinite(f)) continue;
    const double variance =
        rests ? square(known_.rest_std_mps2(i)) : square(motion_.reading_std_mps2);
    add({f, x(i) + x(3 + i), variance, Mat<9>(Mat<9>::Unit(i) + Mat<9>::Unit(3 + i))});
  }
  if (!rests || !motion_.gyroscope) return;
  for (int i = 0; i < 3; ++i) {
    const double rate = epochs_.rate_at_radps[k](i);
    if (!std::isfinite(rate)) continue;
    add({rate, x(6 + i), square(known_.rest_rate_std_radps(i)), Mat<9>(Mat<9>::Unit(6 + i))});
  }
}

FilterState<9> TiltModel::start() const {
  const double G = known_.gravity_mps2;
  for (const Mat<3>& f : epochs_.force_mps2)
    if (f.allFinite() && f.norm() > 0.0) return start_about(f * (G / f.norm()));
  return start_about({0.0, 0.0, G});
}

FilterState<9> TiltModel::start_about(const Mat<3>& g) const {
  FilterState<9> state;
  const double G = known_.gravity_mps2;
  state.x.mean.setZero();
  state.x.mean.head<3>() = g;
  const bool rests = !epochs_.resting.empty() && epochs_.resting.front() != 0;
  Mat<3, 3> accel = Mat<3, 3>::Zero();
  if (!rests) accel = epochs_.accel_cov_m2ps4.front();
  // The measurement used for the start is processed again: the prior is so wide that it counts
  // once.
  const double wide = 100.0 * (accel.trace() / 3.0 + square(motion_.reading_std_mps2) +
                               known_.rest_std_mps2.cwiseAbs2().maxCoeff());
  state.x.cov.topLeftCorner<3, 3>() =
      std::min(wide, square(G)) / square(G) * across(g) + square(norm_std) * g * g.transpose();
  state.x.cov.block<3, 3>(3, 3) = accel;
  const double third = motion_.gyroscope ? square(known_.rate_bias_std_radps)
                                         : (rests ? 0.0 : square(known_.usual_rate_radps * G));
  state.x.cov.bottomRightCorner<3, 3>() = third * Mat<3, 3>::Identity();
  return state;
}

void TiltModel::reopen(Gaussian<9>& x, std::size_t) const {
  const Gaussian<9> fresh = start().x;
  const Mat<3> g = x.mean.head<3>();
  x.cov = fresh.cov;
  x.cov.topLeftCorner<3, 3>() = across(g);
}

}  // namespace proofmass::estimate
