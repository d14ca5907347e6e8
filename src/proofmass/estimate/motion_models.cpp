#include "proofmass/estimate/motion_models.hpp"

#include <array>
#include <cmath>
#include <cstddef>

#include "proofmass/estimate/models/bias_models.hpp"

namespace proofmass::estimate {
namespace {

/// (e^(−x) − 1 + x)/x², whose numerator cancels where x is small.
double second_exponential(double x) {
  if (x > 1.0) return (std::expm1(-x) + x) / (x * x);
  double term = 0.5, sum = 0.5;
  for (int n = 3; std::abs(term) > 1e-18; ++n) sum += term *= -x / n;
  return sum;
}

/// Response to a unit acceleration after s: displacement, velocity, acceleration.
Mat<3> after_unit_accel(double s, double tau) {
  const double x = s / tau;
  return {s * s * second_exponential(x), -tau * std::expm1(-x), std::exp(-x)};
}

Mat<3, 3> singer_transition(double dt, double tau) {
  Mat<3, 3> F = Mat<3, 3>::Identity();
  F(0, 1) = dt;
  F.col(2) = after_unit_accel(dt, tau);
  return F;
}

/// ∫ g(s) g(s)ᵀ ds over a step of at most τ, by eight-point Gauss–Legendre quadrature, with a
/// relative error of 1e-17.
Mat<3, 3> singer_integral(double dt, double tau) {
  constexpr std::array<double, 4> nodes = {0.1834346424956498, 0.5255324099163290,
                                           0.7966664774136267, 0.9602898564975363};
  constexpr std::array<double, 4> weights = {0.3626837833783620, 0.3137066458778873,
                                             0.2223810344533745, 0.1012285362903763};
  Mat<3, 3> sum = Mat<3, 3>::Zero();
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (const double side : {-1.0, 1.0}) {
      const Mat<3> g = after_unit_accel(0.5 * dt * (1.0 + side * nodes[i]), tau);
      sum += weights[i] * g * g.transpose();
    }
  return 0.5 * dt * sum;
}

}  // namespace

LinearModel<3, 1> pva_model(const PvaOptions& options) {
  PM_EXPECTS(options.dt_s >= 0.0 && options.jerk_psd_m2ps5 >= 0.0);
  const double t = options.dt_s;
  const double t2 = t * t, t3 = t2 * t, t4 = t3 * t, t5 = t4 * t;
  LinearModel<3, 1> model;
  // clang-format off
  model.F << 1, t, t2 / 2,
             0, 1, t,
             0, 0, 1;
  model.Q << t5 / 20, t4 / 8, t3 / 6,
             t4 / 8,  t3 / 3, t2 / 2,
             t3 / 6,  t2 / 2, t;
  // clang-format on
  model.Q *= options.jerk_psd_m2ps5;
  model.H.setZero();
  model.H(pva::accel_mps2) = 1.0;
  model.R << options.accel_variance_m2ps4;
  return model;
}

LinearModel<3, 1> singer_model(const SingerOptions& options) {
  const double tau = options.maneuver_time_s, std = options.maneuver_std_mps2;
  PM_EXPECTS(options.dt_s >= 0.0 && tau > 0.0 && std >= 0.0);
  int doublings = 0;
  double dt = options.dt_s;
  for (; dt > tau; dt *= 0.5) ++doublings;
  LinearModel<3, 1> model;
  model.Q = 2.0 * std * std / tau * singer_integral(dt, tau);
  for (; doublings > 0; --doublings, dt *= 2.0) {
    const Mat<3, 3> F = singer_transition(dt, tau);
    model.Q = (F * model.Q * F.transpose() + model.Q).eval();
  }
  model.F = singer_transition(options.dt_s, tau);
  model.H.setZero();
  model.H(pva::accel_mps2) = 1.0;
  model.R << options.accel_variance_m2ps4;
  return model;
}

LinearModel<4, 1, 1> pva_bias_model(const PvaBiasOptions& options) {
  const BiasStep step =
      bias_step({options.motion.dt_s, options.time_constant_s, options.bias_psd_m2ps5});
  return with_bias(pva_model(options.motion), step, Mat<1>(1.0));
}

template LinearRun<3, 1> filter_linear(LinearSeries<3, 1>, const Start<3>&, const LinearOptions&);
template LinearRun<3, 1> smooth_linear(LinearSeries<3, 1>, const Start<3>&, const LinearOptions&);
template LinearRun<4, 1> filter_linear(LinearSeries<4, 1, 1>,
                                       const Start<4>&,
                                       const LinearOptions&);
template LinearRun<4, 1> smooth_linear(LinearSeries<4, 1, 1>,
                                       const Start<4>&,
                                       const LinearOptions&);

}  // namespace proofmass::estimate
