#pragma once

#include "proofmass/core/units.hpp"

namespace proofmass::sensor {

/// Location of a recording on Earth.
struct Place {
  double latitude_rad = 0.0;  ///< geodetic, north positive
  double height_m = 0.0;      ///< above the ellipsoid; above sea level is within 100 m of it
};

/// Normal gravity of the ellipsoid WGS 84: Somigliana's closed formula on the ellipsoid, and the
/// second-order formula above it,
///
///     γ(φ) = γ_e (1 + k sin²φ) / √(1 − e² sin²φ),
///     γ(φ, h) = γ(φ) (1 − (2/a)(1 + f + m − 2 f sin²φ) h + (3/a²) h²).
///
/// Actual local gravity differs by the gravity anomaly, seldom more than 1e-3 m/s².
/// Source: NIMA TR8350.2, Department of Defense World Geodetic System 1984, 3rd ed. (2000),
/// equations 4-1 and 4-3. Range: −500 m … 20 km.
[[nodiscard]] double gravity_mps2(const Place& place);

/// Standard deviation of local gravity about gravity_mps2: that of free-air anomalies worldwide,
/// about 40 mGal. Source: C. C. Tscherning, R. H. Rapp, Closed covariance expressions for gravity
/// anomalies, Report 208, Ohio State University (1974): 1795 mGal² (42.4 mGal).
inline constexpr double gravity_anomaly_std_mps2 = 4e-4;

/// Standard deviation of the standard gravity if the location is unknown: uniform between 9.78
/// (equator) and 9.832 m/s^2 (pole).
inline constexpr double gravity_std_on_earth_mps2 = 0.015;

}  // namespace proofmass::sensor
