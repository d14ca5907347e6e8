#pragma once

#include <optional>
#include <vector>

#include "proofmass/estimate/drive.hpp"

// Clocks of the recordings of one drive, related by the motion that all of them show. Private to
// the module.
namespace proofmass::estimate::drive {

/// A motion signal on its own clock: speed, or yaw rate.
struct Signal {
  std::vector<double> time_s, values;
};

struct Alignment {
  double offset_s = 0.0;     ///< second clock's reading minus the first's
  double std_s = 0.0;        ///< of the offset, from the changes that the signals do not share
  double correlation = 0.0;  ///< of the signals' changes over one second, at the best offset
};

/// The logarithm of a wheel's speed, with a floor: its changes are largest where the vehicle starts
/// and stops, which both of its sides do at the same time, unlike changes of speed in a turn.
[[nodiscard]] Signal log_speed(const Signal& speed);

/// The offset at which the changes of two signals correlate best.
/// Outside its recording a signal is constant: vehicles are mostly recorded from rest to rest.
/// With `expected_s`, offsets within half a second of it are preferred unless the correlation at
/// another one is significantly larger. Source: R. A. Fisher, Metron 1 (1921) 3, for artanh(r).
/// Cost: O(n²) with n at most 8000 points.
[[nodiscard]] Alignment align(const Signal& first,
                              const Signal& second,
                              std::optional<double> expected_s = {});

/// Distance from the first fix on a plane tangent there (WGS 84), by fix.
struct LocalFixes {
  std::vector<double> time_s, east_m, north_m, std_m;
  double latitude_rad = 0.0, longitude_rad = 0.0;  ///< of the origin
};

[[nodiscard]] LocalFixes local_fixes(const GnssFixes& fixes);

/// Speed from differences of fixes that are some seconds apart.
[[nodiscard]] Signal speed_of(const LocalFixes& fixes);

/// Seconds for each second of the fixes' stamps, a power of ten: the one whose speed correlates
/// best with the wheels'. Some exports stamp tenths or milliseconds as seconds.
struct ScaledAlignment {
  double scale = 1.0;
  Alignment alignment;
};
[[nodiscard]] ScaledAlignment align_fixes(const Signal& wheels, const LocalFixes& fixes);

}  // namespace proofmass::estimate::drive
