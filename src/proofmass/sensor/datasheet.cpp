#include "proofmass/sensor/datasheet.hpp"

#include <cmath>

namespace proofmass::sensor {

double filtered_noise_rms(double density_rthz, double bandwidth_hz) {
  return density_rthz * std::sqrt(0.5 * std::numbers::pi * bandwidth_hz);
}

}  // namespace proofmass::sensor
