#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <vector>

#include "proofmass/estimate/filter/diffuse_moments.hpp"
#include "proofmass/estimate/filter/linear_series.hpp"
#include "proofmass/estimate/filter/smoother.hpp"
#include "proofmass/estimate/filter/symmetric.hpp"

// Results of a run of a linear model.
namespace proofmass::estimate {

/// Results of one epoch.
template <int N, int M>
struct LinearStep {
  PackedGaussian<N> filtered;  ///< given z[0] … z[k]
  PackedGaussian<N> smoothed;  ///< given every measurement; filter_linear() leaves it equal to
                               /// `filtered`
  /// Innovation of channel i given all earlier epochs and channels 0 … i−1 of this one, and its
  /// variance under the model: uncorrelated. NaN without a measurement; the variance is infinite if
  /// the measurement determined a diffuse direction.
  Mat<M> innovation, innovation_variance;
  /// Channels measured and accepted by the gate, without those that determined a diffuse direction.
  int readings = 0;
  /// Normalised innovation squared, yᵀ S⁻¹ y over these measurements: χ² with `readings` degrees of
  /// freedom.
  double nis = 0.0;
  int diffuse_directions = 0;  ///< number not yet determined by the measurements
};

template <int N, int M>
struct LinearRun {
  std::vector<LinearStep<N, M>> steps;
  /// ln p of the accepted measurements, −½ Σ (ln 2π + ln S + y²/S). A measurement that determines a
  /// diffuse direction adds −½ ln F∞ (0 if F∞ = hᵀ A Aᵀ h = 1) and no ln 2π, as in the package
  /// KFAS; Durbin & Koopman (2012), section 7.2.2, include ln 2π for it too: theirs is
  /// `log_likelihood − ½ diffuse_readings ln 2π`, which does not change the maximum.
  double log_likelihood = 0.0;
  double nis = 0.0;  ///< sum over all epochs
  std::size_t readings = 0;
  std::size_t diffuse_readings = 0;  ///< number that determined a diffuse direction
  /// [k] is cov(x[k+1], x[k]) given every measurement, row of the later state first; one less than
  /// epochs; empty unless requested. Infinite where it is not determined.
  std::vector<Mat<N, N>> lag_one;
};

namespace detail {

/// Counts one measurement accepted by the gate.
template <int N, int M>
void count_reading(LinearStep<N, M>& out,
                   LinearRun<N, M>& run,
                   double innovation,
                   double expected) {
  const double nis = innovation * innovation / expected;
  ++out.readings;
  ++run.readings;
  out.nis += nis;
  run.log_likelihood -= 0.5 * (std::log(2.0 * std::numbers::pi * expected) + nis);
}

template <int N, int M, int U>
void note(const LinearSeries<N, M, U>& series,
          std::size_t k,
          const Step<N, N, M>& step,
          LinearRun<N, M>& run) {
  LinearStep<N, M>& out = run.steps[k];
  out.filtered = out.smoothed = PackedGaussian<N>::of(step.filtered);
  out.innovation.setConstant(std::numeric_limits<double>::quiet_NaN());
  out.innovation_variance = out.innovation;
  for (int i = 0; i < step.count; ++i) {
    const Update<N>& update = step.updates[static_cast<std::size_t>(i)];
    const int channel = series.channel_of(k, i);
    out.innovation(channel) = update.innovation;
    out.innovation_variance(channel) = update.expected;
    if (update.used) count_reading(out, run, update.innovation, update.expected);
  }
  run.nis += out.nis;
}

template <int N, int M, int U>
void note(const LinearSeries<N, M, U>& series,
          std::size_t k,
          const DiffuseStep<N, M>& step,
          LinearRun<N, M>& run) {
  LinearStep<N, M>& out = run.steps[k];
  out.filtered = out.smoothed =
      with_diffuse(step.step.filtered, diffuse_part<N>(step.moved, step.moved, step.knowledge));
  out.diffuse_directions = step.knowledge.directions - step.knowledge.found;
  out.innovation.setConstant(std::numeric_limits<double>::quiet_NaN());
  out.innovation_variance = out.innovation;
  for (int i = 0; i < step.step.count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const int channel = series.channel_of(k, i);
    out.innovation(channel) = step.innovation[at];
    out.innovation_variance(channel) = step.expected[at];
    if (step.F_inf[at] > 0.0) {
      ++run.diffuse_readings;
      run.log_likelihood -= 0.5 * std::log(step.F_inf[at]);
    } else if (step.step.updates[at].used) {
      count_reading(out, run, step.innovation[at], step.expected[at]);
    }
  }
  run.nis += out.nis;
}

}  // namespace detail

}  // namespace proofmass::estimate
