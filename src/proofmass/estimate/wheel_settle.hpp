#pragma once

#include "proofmass/estimate/wheel_passes.hpp"

// The rounds in which noise, ripple, places and path of a wheel settle about each other. Private to
// the module's wheel_*.cpp.
namespace proofmass::estimate {

/// What the rounds end with.
template <int S>
struct Settled {
  WheelNoise noise;
  WheelPrior prior;
  Eigen::MatrixXd places_cov;
  Eigen::VectorXd widened;  ///< of all that stands, see widening()
  PlacesPrior belief;       ///< of the places, about where they are likeliest
  double log_likelihood = 0.0;
};

/// How many epochs a path has before it is a turn away from its start.
[[nodiscard]] std::size_t instants_of_first_turn(const WheelPath& path);

/// The model of the settled passes: linear about a path, the places held.
template <int S>
[[nodiscard]] WheelModel<S> held_model(const WheelReadings& readings,
                                       const WheelNoise& noise,
                                       const WheelPath& about) {
  auto model = wheel_model<S>(readings, noise);
  model.about = &about;
  model.first_turn = instants_of_first_turn(about);
  model.places_held = true;
  model.with_ripple = true;
  return model;
}

/// Orders 1 and 2 and the two others, up to highest_order, that explain most of what a path without
/// ripple leaves of the measurements.
template <int S>
[[nodiscard]] RippleOrders orders_in(const WheelReadings& readings, const WheelPath& path);

/// Moves the track to the smoother's under the settled figures.
template <int S>
void improve(const WheelReadings& readings, const Settled<S>& settled, WheelTrack& track);

/// Rounds until the likelihood has settled, at most `most`.
template <int S>
[[nodiscard]] Settled<S> settle_rounds(WheelReadings& readings,
                                       WheelTrack& track,
                                       const PlacesPrior& belief,
                                       int most,
                                       const Progress& progress);

}  // namespace proofmass::estimate
