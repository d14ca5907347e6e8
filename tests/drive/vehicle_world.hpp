#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/estimate/drive.hpp"

// A vehicle on a plane, for the coverage of the intervals of estimate_drive(). It shares no formula
// with the estimator: wheels and sensors are moved as rigid bodies in inertial coordinates, and
// what a sensor measures is the second difference of its position and the difference of its
// rotation matrices.
namespace proofmass::drive_world {

/// One vehicle, its sensors and what is wrong with them.
struct Scenario {
  std::string name;
  bool gyroscopes = true, fixes = false, frame = false, encoders = false;
  bool right = true, left = true;
  bool front_axle = false;  ///< the wheels of the steered axle, too
  bool steered_known = true;
  bool circumference_known = true, track_known = true;
  bool own_clocks = false;  ///< each side has a clock of its own
  bool stops = false;       ///< stands for some seconds twice on the way
  double duration_s = 80.0;
  double slip_m_per_rtm = 0.004;
  double wander_m = 0.8, wander_s = 25.0;
  double fix_noise_m = 0.1, fix_noise_s = 1.0;  ///< the receiver filters its noise over that time
  double steering = 1.0;                        ///< of the usual curvature
};

/// The scenarios of docs/methods/drive.md.
[[nodiscard]] const std::vector<Scenario>& scenarios();

struct Truth {
  double distance_m = 0.0, heading_change_rad = 0.0, heading_start_rad = 0.0;
  std::array<double, 2> end_m{};  ///< in the frame that the solution has
  double track_m = 0.0, wheelbase_m = 0.0;
  std::vector<double> circumference_m, clock_offset_s;  ///< of each wheel
};

struct World {
  std::vector<estimate::DriveWheel> wheels;
  std::optional<estimate::DriveFrame> frame;
  std::optional<estimate::GnssFixes> fixes;
  estimate::DriveOptions options;
  Truth truth;
};

/// The recordings of one drive; the same seed gives the same.
[[nodiscard]] World make_world(const Scenario& scenario, std::uint64_t seed);

}  // namespace proofmass::drive_world
