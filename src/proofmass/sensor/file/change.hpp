#pragma once

#include <functional>
#include <string>

#include "proofmass/core/result.hpp"
#include "proofmass/sensor/sensor_model.hpp"

namespace proofmass::sensor {

/// Reads the sensor file, changes its model and writes it back; if there is not a file, starts with
/// an empty model named after it. Errors: those of reading, of `change` (with the path) and of
/// writing. The file is then unchanged.
[[nodiscard]] Status change_sensor_file(const std::string& path,
                                        const std::function<Status(SensorModel&)>& change);

}  // namespace proofmass::sensor
