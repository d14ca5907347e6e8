#include "proofmass/sensor/datasheet.hpp"

#include <cmath>

namespace proofmass::sensor {

double filtered_noise_rms(double density_rthz, double bandwidth_hz) {
  return density_rthz * std::sqrt(0.5 * std::numbers::pi * bandwidth_hz);
}

double angle_random_walk(double density_radps_rthz) {
  return density_radps_rthz / std::numbers::sqrt2;
}

}  // namespace proofmass::sensor
