#pragma once

#include "proofmass/estimate/pva_axis.hpp"

// How hard a motion jerks. Private to the module's track*.cpp.
namespace proofmass::estimate {

struct JerkDensity {
  double psd_m2ps5 = 1.0;  ///< to be used
  double std_m2ps5 = 0.0;
  bool told = false;  ///< by the measurements: they have a maximum
};

/// The density of white jerk that maximises the likelihood of the measurements, all other noise as
/// it stands in `axis`; its std is θ/√(−∂²L/∂ln θ²). By a scan over 18 decades and a golden
/// section. Cost: about thirty passes of the filter.
[[nodiscard]] JerkDensity likeliest_jerk(PvaAxis<1> axis, double speed_std_mps);

}  // namespace proofmass::estimate
