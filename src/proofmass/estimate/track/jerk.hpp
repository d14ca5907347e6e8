#pragma once

#include "proofmass/estimate/models/pva_axis.hpp"

// Jerk density of a motion.
namespace proofmass::estimate {

struct JerkDensity {
  double psd_m2ps5 = 1.0;  ///< value to use
  double std_m2ps5 = 0.0;
  bool determined = false;  ///< the likelihood has a maximum
};

/// The white-jerk density that maximises the likelihood of the measurements, with all other noise
/// as in `axis`; its std is θ/√(−∂²L/∂ln θ²). By a scan over 18 decades and a golden section. Cost:
/// about thirty passes of the filter.
[[nodiscard]] JerkDensity likeliest_jerk(PvaAxis<1> axis, double speed_std_mps);

}  // namespace proofmass::estimate
