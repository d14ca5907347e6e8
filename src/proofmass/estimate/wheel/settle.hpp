#pragma once

#include <memory>
#include <vector>

#include "proofmass/core/contract.hpp"
#include "proofmass/estimate/wheel/likelihood.hpp"

// Alternating estimation of noise, ripple, lever arms and path of a wheel.
namespace proofmass::estimate {

/// Result of the iteration.
template <int S>
struct Settled {
  WheelNoise noise;
  WheelPrior prior;
  Eigen::MatrixXd places_cov;
  Eigen::VectorXd widened;  ///< of all static states, see widening()
  PlacesPrior belief;       ///< of the lever arms, about their maximum likelihood
  double log_likelihood = 0.0;
};

/// The model of the final passes: linearised about a path, with the lever arms held.
template <int S>
[[nodiscard]] WheelModel<S> held_model(const WheelReadings& readings,
                                       const WheelNoise& noise,
                                       const WheelPath& about) {
  PM_EXPECTS(about.moving.size() == readings.epochs.size());
  auto model = wheel_model<S>(readings, noise);
  model.about = &about;
  model.first_turn = turned_after(about, 0);
  model.places_held = true;
  model.with_ripple = true;
  if (model.with_gyro)
    model.mean_accel = std::make_shared<const std::vector<double>>(
        mean_accel_radps2(readings.time_s, about.moving));
  return model;
}

/// Orders 1 and 2 and the two others, up to highest_order, that explain most of the residual of a
/// path without ripple.
template <int S>
[[nodiscard]] RippleOrders orders_in(const WheelReadings& readings, const WheelPath& path);

/// The static states of a wheel that the whole recording has calibrated: their estimates at its
/// first epoch, with their covariance at its last.
template <int S>
using Calibrated = Gaussian<wheel::standing(S)>;

/// Updates the track to the smoother's with the current parameters.
template <int S>
Calibrated<S> improve(const WheelReadings& readings, const Settled<S>& settled, WheelTrack& track);

/// Iterates until the likelihood converges, at most `most` times.
template <int S>
[[nodiscard]] Settled<S> settle_rounds(WheelReadings& readings,
                                       WheelTrack& track,
                                       const PlacesPrior& belief,
                                       int most,
                                       const Progress& progress);

}  // namespace proofmass::estimate
