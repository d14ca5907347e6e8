#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "proofmass/core/random.hpp"
#include "proofmass/estimate/filter/linear_series.hpp"

// Models and records for the tests of fixed-point, fixed-lag and live smoothing.
namespace proofmass::estimate::test {

/// A damped oscillator with a slow third state and an input. All matrices are dense, so that every
/// entry is tested.
inline LinearModel<3, 2, 1> driven_oscillator(double dt_s) {
  const double c = std::exp(-0.2 * dt_s);
  LinearModel<3, 2, 1> m;
  m.F << c * std::cos(dt_s), c * std::sin(dt_s), 0.1 * dt_s,  //
      -c * std::sin(dt_s), c * std::cos(dt_s), 0.05,          //
      0.02, -0.1 * dt_s, std::exp(-dt_s / 50.0);
  Mat<3, 3> root;
  root << 0.3, 0.1, -0.05, 0.0, 0.4, 0.1, 0.0, 0.0, 0.2;
  m.Q = dt_s * root * root.transpose() + 0.01 * Mat<3, 3>::Identity();
  m.H << 1.0, 0.5, -0.2, 0.3, -0.7, 1.1;
  m.R << 0.04, 0.25;
  m.B << 0.5 * dt_s, -dt_s, 0.2;
  return m;
}

inline Gaussian<3> oscillator_prior() {
  Gaussian<3> x;
  x.mean << 0.5, -0.2, 0.1;
  x.cov << 1.0, 0.2, 0.0, 0.2, 0.5, -0.1, 0.0, -0.1, 2.0;
  return x;
}

/// Irregular steps, with one channel missing, the other, both, and an occasional outlier.
inline std::vector<Epoch<2, 1>> uneven_epochs(std::size_t count) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  Random random(7, "uneven epochs");
  std::vector<Epoch<2, 1>> epochs(count);
  for (std::size_t k = 0; k < count; ++k) {
    const double outlier = k % 17 == 11 ? 30.0 : 0.0;
    epochs[k] = {k % 5 == 0 ? 0.37 : 0.1, Mat<2>(random.normal() + outlier, random.normal()),
                 Mat<1>(random.uniform())};
    if (k % 4 == 2) epochs[k].z(0) = none;
    if (k % 6 == 4 || k % 4 == 2) epochs[k].z(k % 3 == 0 ? 0 : 1) = none;
  }
  return epochs;
}

inline LinearSeries<3, 2, 1> uneven_series(std::size_t count) {
  return LinearSeries<3, 2, 1>::make(uneven_epochs(count), driven_oscillator).value();
}

/// Position and velocity driven by white acceleration, constant over each step: the position is
/// measured.
inline LinearModel<2, 1> constant_velocity(double dt_s, double accel_variance, double variance) {
  LinearModel<2, 1> m;
  m.F << 1.0, dt_s, 0.0, 1.0;
  const Mat<2> g(0.5 * dt_s * dt_s, dt_s);
  m.Q = accel_variance * g * g.transpose();
  m.H << 1.0, 0.0;
  m.R << variance;
  return m;
}

/// Position, velocity and acceleration driven by white jerk of density 1 m²/s⁵, and a Gauss–Markov
/// bias with time constant 100 s and standard deviation 0.07 m/s²; an accelerometer measures the
/// sum of the last two. Source: Bar-Shalom, Li, Kirubarajan, Estimation with Applications (2001),
/// sections 4.3 and 6.2.3.
inline LinearModel<4, 1> biased_motion(double h) {
  const double phi = std::exp(-h / 100.0);
  LinearModel<4, 1> m;
  m.F << 1.0, h, 0.5 * h * h, 0.0, 0.0, 1.0, h, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, phi;
  m.Q << std::pow(h, 5) / 20, std::pow(h, 4) / 8, std::pow(h, 3) / 6, 0.0,  //
      std::pow(h, 4) / 8, std::pow(h, 3) / 3, h * h / 2, 0.0,               //
      std::pow(h, 3) / 6, h * h / 2, h, 0.0,                                //
      0.0, 0.0, 0.0, 0.005 * (1.0 - phi * phi);
  m.H << 0.0, 0.0, 1.0, 1.0;
  m.R << 4e-4;
  return m;
}

/// Difference of two states, in standard deviations of the second.
template <int N>
double distance(const Mat<N>& a, const Gaussian<N>& b) {
  return ((a - b.mean).array() / b.cov.diagonal().array().sqrt()).abs().maxCoeff();
}

/// Difference of two covariances, entry by entry, relative to the standard deviations of the
/// second.
template <int N>
double distance(const Mat<N, N>& A, const Mat<N, N>& B) {
  const Mat<N> std = B.diagonal().cwiseSqrt();
  return ((A - B).array() / (std * std.transpose()).array()).abs().maxCoeff();
}

}  // namespace proofmass::estimate::test
