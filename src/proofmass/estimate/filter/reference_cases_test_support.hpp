#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "proofmass/estimate/filter/linear_gaussian.hpp"
#include "proofmass/estimate/filter/reference_smoother_test_support.hpp"
#include "proofmass/estimate/motion_models.hpp"
#include "proofmass/estimate/wheel_test_support.hpp"

// The benchmark problem of the smoothers: position, velocity and acceleration driven by white jerk
// of density 1, an accelerometer whose bias is a Gauss–Markov process of 100 s, 200 measurements a
// second with a standard deviation of 0.02.
namespace proofmass::estimate::test {

enum class Measured { acceleration, position };

struct ReferenceCase {
  std::size_t epochs;
  Measured measured;
  bool missing = false;  ///< a tenth of the measurements at random, and one gap of 1 s
  Smoother smoother = Smoother::bryson_frazier;
};

/// Largest differences from the 128-bit results over all epochs and states.
struct WorstError {
  double mean_stds = 0.0;      ///< of smoothed means, in standard deviations
  double cov_share = 0.0;      ///< of smoothed covariances, relative to √(Pii Pjj)
  double lag_one_share = 0.0;  ///< of lag-one covariances, likewise
};

[[nodiscard]] inline std::vector<Epoch<1, 1>> reference_epochs(const ReferenceCase& c) {
  Normal normal(7);
  std::vector<Epoch<1, 1>> epochs(c.epochs, Epoch<1, 1>{0.005, Mat<1>::Zero()});
  for (std::size_t k = 0; k < c.epochs; ++k) {
    const double t_s = 0.005 * static_cast<double>(k);
    epochs[k].z(0) = std::sin(1.3 * t_s) + 0.02 * normal();
    if (c.missing && (k % 1000 >= 800 || normal.uniform() < 0.1))
      epochs[k].z(0) = std::numeric_limits<double>::quiet_NaN();
  }
  return epochs;
}

[[nodiscard]] inline WorstError worst_error(const ReferenceCase& c) {
  const auto epochs = reference_epochs(c);
  const auto model_at = [&](double dt_s) {
    auto m = pva_bias_model({.motion = {dt_s, 1.0, 0.02 * 0.02},
                             .time_constant_s = 100.0,
                             .bias_psd_m2ps5 = 2.0 * 0.05 * 0.05 / 100.0});
    if (c.measured == Measured::position) m.H << 1.0, 0.0, 0.0, 0.0;
    return m;
  };
  const auto series = LinearSeries<4, 1, 1>::make(epochs, model_at).value();
  Gaussian<4> prior;
  prior.cov.diagonal() << 1e-4, 1e-4, 1.0, 0.05 * 0.05;
  const auto run = smooth_linear(series, prior, {.smoother = c.smoother, .lag_one = true});
  const QuadRun exact = quad_smoother(series, epochs, prior);
  WorstError worst;
  const auto at = [](const QuadMatrix& m, int i, int j) {
    return m(static_cast<std::size_t>(i), static_cast<std::size_t>(j));
  };
  const auto std = [&](std::size_t k, int i) {
    return std::sqrt(static_cast<double>(at(exact.smoothed[k].cov, i, i)));
  };
  const auto off = [](double ours, Quad theirs) {
    return std::abs(static_cast<double>(Quad(ours) - theirs));
  };
  for (std::size_t k = 0; k < c.epochs; ++k) {
    const auto& x = run.steps[k].smoothed;
    for (int i = 0; i < 4; ++i) {
      worst.mean_stds =
          std::max(worst.mean_stds, off(x.mean(i), at(exact.smoothed[k].mean, i, 0)) / std(k, i));
      for (int j = 0; j < 4; ++j) {
        worst.cov_share =
            std::max(worst.cov_share,
                     off(x.cov(i, j), at(exact.smoothed[k].cov, i, j)) / (std(k, i) * std(k, j)));
        if (k + 1 < c.epochs)
          worst.lag_one_share =
              std::max(worst.lag_one_share, off(run.lag_one[k](i, j), at(exact.lag_one[k], i, j)) /
                                                (std(k + 1, i) * std(k, j)));
      }
    }
  }
  return worst;
}

}  // namespace proofmass::estimate::test
