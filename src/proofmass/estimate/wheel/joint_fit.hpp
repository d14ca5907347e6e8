#pragma once

#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/estimate/wheel/clock.hpp"
#include "proofmass/estimate/wheel/encoder.hpp"
#include "proofmass/estimate/wheel/fit.hpp"
#include "proofmass/estimate/wheel/plane.hpp"

// From the sensors' data to their fits: each alone, then both in one filter.
namespace proofmass::estimate {

/// A sensor prepared for the filter.
struct Prepared {
  Screened screened;
  WheelPlane plane;
};

struct Single {
  Prepared prepared;
  WheelReadings readings;
  WheelFit fit;
  std::optional<EncoderTrack> encoder{};
};

/// The single fits of a pair, the second with its axis reversed if needed so that both rotate in
/// the same direction.
struct Pair {
  std::vector<Single> singles;
  ClockFit clocks;
};

/// Each sensor alone, and the second's phase relative to the first. Errors: as for
/// estimate_wheel().
[[nodiscard]] Result<Pair> fit_singles(const std::vector<WheelSensor>& sensors,
                                       const WheelOptions& options);

/// Both sensors in one filter, started from the single fits. The memory of both arguments is freed
/// as soon as the measurements are on one time line.
struct Joint {
  WheelReadings readings;
  WheelFit fit;
};

[[nodiscard]] Joint fit_jointly(std::vector<WheelSensor> sensors,
                                Pair pair,
                                const WheelOptions& options);

/// (u, v) of each sensor.
[[nodiscard]] Eigen::VectorXd places_in(const WheelFit& fit, std::size_t sensors);

/// Standard deviation of the given radius.
[[nodiscard]] double radius_std_m(const WheelOptions& options);

/// Checks the options for this number of sensors.
[[nodiscard]] Status check_wheel(std::size_t sensors, const WheelOptions& options);

}  // namespace proofmass::estimate
