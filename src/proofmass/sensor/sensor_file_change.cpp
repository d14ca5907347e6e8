#include "proofmass/sensor/sensor_file_change.hpp"

#include <filesystem>
#include <system_error>
#include <utility>

#include "proofmass/sensor/sensor_file.hpp"

namespace proofmass::sensor {

Status change_sensor_file(const std::string& path,
                          const std::function<Status(SensorModel&)>& change) {
  SensorModel model;
  std::error_code unknown;
  // Where it cannot be told whether there is a file, there may be one that must not be lost.
  if (std::filesystem::exists(path, unknown) || unknown) {
    auto file = read_sensor_file(path);
    if (!file) return file.error();
    model = std::move(file).value().model;
  } else {
    model.name = std::filesystem::path(path).stem().string();
  }
  if (const Status done = change(model); !done) return done.error().at(path);
  return write_sensor_file(model, path);
}

}  // namespace proofmass::sensor
