#pragma once

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

/// Number of epochs of a path before it is a turn away from its start.
[[nodiscard]] std::size_t epochs_of_first_turn(const WheelPath& path);

/// The model of the final passes: linearised about a path, with the lever arms held.
template <int S>
[[nodiscard]] WheelModel<S> held_model(const WheelReadings& readings,
                                       const WheelNoise& noise,
                                       const WheelPath& about) {
  auto model = wheel_model<S>(readings, noise);
  model.about = &about;
  model.first_turn = epochs_of_first_turn(about);
  model.places_held = true;
  model.with_ripple = true;
  return model;
}

/// Orders 1 and 2 and the two others, up to highest_order, that explain most of the residual of a
/// path without ripple.
template <int S>
[[nodiscard]] RippleOrders orders_in(const WheelReadings& readings, const WheelPath& path);

/// Updates the track to the smoother's with the current parameters.
template <int S>
void improve(const WheelReadings& readings, const Settled<S>& settled, WheelTrack& track);

/// Iterates until the likelihood converges, at most `most` times.
template <int S>
[[nodiscard]] Settled<S> settle_rounds(WheelReadings& readings,
                                       WheelTrack& track,
                                       const PlacesPrior& belief,
                                       int most,
                                       const Progress& progress);

}  // namespace proofmass::estimate
