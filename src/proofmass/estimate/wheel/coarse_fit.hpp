#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "proofmass/estimate/wheel/settle.hpp"

// All passes of a fit but the last, on averages of the measurements.
namespace proofmass::estimate {

/// Turn of the wheel during an average of measurements. On a road longer averages hide vibration,
/// which an encoder's errors resemble, too; on a bench the model of an average is accurate to 2e-5
/// m/s² over long_average_rad.
inline constexpr double average_rad = 0.05, long_average_rad = 0.25;

/// Number of measurements to average for every pass but the last ones: those of average_rad or, in
/// a long recording, as many as leave `enough` averages, but no more than those of `most_rad`.
[[nodiscard]] inline std::size_t averaging_factor(const WheelReadings& readings,
                                                  const WheelTrack& track,
                                                  double most_rad) {
  constexpr double enough = 20'000.0;
  double fastest_radps = 1e-9;
  for (const Mat<wheel::moving>& at : track.path.moving)
    fastest_radps = std::max(fastest_radps, std::abs(at(wheel::speed)));
  const auto epochs = static_cast<double>(readings.epochs.size());
  const double step_rad = fastest_radps / readings.rate_hz();
  const double angle_rad = std::clamp(step_rad * epochs / enough, average_rad, most_rad);
  // A short recording keeps at least 50 averages.
  const double most = std::clamp(epochs / 50.0, 1.0, 64.0);
  return static_cast<std::size_t>(std::clamp(angle_rad / step_rad, 1.0, most));
}

/// A track of the averaged measurements, on the time line of all of them.
[[nodiscard]] inline WheelTrack spread_track(const WheelTrack& track,
                                             const WheelReadings& averaged,
                                             const WheelReadings& readings) {
  WheelTrack out = track;
  out.path.moving = moving_at(readings.time_s, averaged.time_s, track.path.moving);
  return out;
}

/// Assigns each measurement the estimated variance of its average, times the averaging factor.
inline void spread_variance(const WheelReadings& averaged,
                            std::size_t each,
                            WheelReadings& readings) {
  for (std::size_t s = 0; s < readings.sensors.size(); ++s) {
    readings.sensors[s].speed_variance =
        static_cast<double>(each) * averaged.sensors[s].speed_variance;
    for (std::size_t k = 0; k < readings.epochs.size(); ++k) {
      const std::int64_t row = readings.epochs[k].row[s];
      const std::int64_t block = averaged.epochs[k / each].row[s];
      if (row == WheelEpoch::no_row || block == WheelEpoch::no_row) continue;
      readings.sensors[s].variance_m2ps4[static_cast<std::size_t>(row)] =
          static_cast<double>(each) *
          averaged.sensors[s].variance_m2ps4[static_cast<std::size_t>(block)];
    }
  }
}

/// Passes on averages of `each` measurements.
template <int S>
struct CoarseFit {
  std::size_t each = 1;
  WheelReadings readings;
  WheelTrack track;
  Settled<S> settled;
};

/// A vehicle and an encoder keep averages of average_rad.
template <int S>
[[nodiscard]] CoarseFit<S> settle_on_averages(const WheelReadings& readings,
                                              const WheelTrack& track,
                                              const PlacesPrior& belief,
                                              FitDepth depth,
                                              const Progress& progress) {
  const bool alone = S == 1 && depth != FitDepth::track;
  const int rounds = (alone ? 4 : 2) / (depth == FitDepth::again ? 2 : 1);
  const auto on_averages = [&](std::size_t each) {
    CoarseFit<S> fit{each, averaged(readings, each), {}, {}};
    fit.track = spread_track(track, readings, fit.readings);
    fit.settled = settle_rounds<S>(fit.readings, fit.track, belief, rounds, progress);
    return fit;
  };
  const std::size_t each = averaging_factor(readings, track, average_rad);
  const std::size_t most =
      readings.encoder ? each : averaging_factor(readings, track, long_average_rad);
  CoarseFit<S> fit = on_averages(most);
  if (fit.readings.shakes && most > each) return on_averages(each);
  return fit;
}

}  // namespace proofmass::estimate
