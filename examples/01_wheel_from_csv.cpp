// Wheel angle from a recording of the accelerometers mounted on it:
//
//   example_01_wheel_from_csv rig.csv
#include <cstddef>
#include <cstdio>
#include <optional>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/estimate/wheel.hpp"
#include "proofmass/io/read_recording.hpp"

namespace pm = proofmass;

namespace {

/// One axis of a sensor in SI; empty if it was not recorded.
std::vector<double> si_values(const pm::Recording& recording, std::optional<std::size_t> index) {
  if (!index) return {};
  const pm::Channel& channel = recording.channels[*index];
  std::vector<double> values;
  for (const double value : channel.values) values.push_back(channel.unit.si(value));
  return values;
}

std::vector<pm::estimate::WheelSensor> sensors_of(const pm::Recording& recording) {
  std::vector<pm::estimate::WheelSensor> sensors;
  for (const pm::Triad& triad : pm::accelerometer_triads(recording)) {
    pm::estimate::WheelSensor& sensor = sensors.emplace_back();
    sensor.name = triad.name;
    for (std::size_t k = 0; k < recording.samples(); ++k)
      sensor.time_s.push_back(recording.time.at(k));
    sensor.accel_mps2 = {si_values(recording, triad.x), si_values(recording, triad.y),
                         si_values(recording, triad.z)};
  }
  return sensors;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: %s RECORDING\n", argv[0]);
    return 2;
  }
  const auto recording = pm::io::read_recording(argv[1], {});
  if (!recording) {
    std::fprintf(stderr, "%s\n", recording.error().message.c_str());
    return 3;
  }
  const auto wheel = pm::estimate::estimate_wheel(sensors_of(*recording), {});
  if (!wheel) {
    std::fprintf(stderr, "%s\n", wheel.error().message.c_str());
    return 1;
  }
  if (wheel->turns)
    std::printf("turns: %.4f, standard deviation %.4f\n", wheel->turns->value, wheel->turns->std);
  for (const auto& sensor : wheel->sensors)
    if (sensor.radius_m)
      std::printf("%s sits %.1f mm from the axle, standard deviation %.1f mm\n",
                  sensor.name.c_str(), 1e3 * sensor.radius_m->value, 1e3 * sensor.radius_m->std);
  for (const auto& sentence : wheel->not_observable)
    std::printf("not shown: %s\n", sentence.c_str());
}
