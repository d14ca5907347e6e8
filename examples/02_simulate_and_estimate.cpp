// Simulates the thesis's wheel at two speeds, estimates its angle from the two accelerometers
// alone, and compares it with the truth. Fails if the error does not match the stated uncertainty.
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "proofmass/core/statistics.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/estimate/wheel.hpp"
#include "proofmass/simulate/rig.hpp"

namespace pm = proofmass;

namespace {

/// The x and y axes of sensor "acc1" or "acc2", which lie in the plane of the wheel.
pm::estimate::WheelSensor sensor_of(const pm::Recording& recording, const std::string& name) {
  pm::estimate::WheelSensor sensor;
  sensor.name = name;
  for (std::size_t k = 0; k < recording.samples(); ++k)
    sensor.time_s.push_back(recording.time.at(k));
  sensor.accel_mps2 = {
      recording.find(name + "_x")->values.copy(), recording.find(name + "_y")->values.copy(), {}};
  return sensor;
}

}  // namespace

int main() {
  pm::simulate::RigOptions options;
  options.seed = 7;
  options.axes = 2;
  options.wheel.profile = {
      {.duration_s = 20.0, .speed_radps = 11.0 * pm::radps_per_rpm, .ramp_s = 2.0},
      {.duration_s = 20.0, .speed_radps = 21.0 * pm::radps_per_rpm, .ramp_s = 5.0}};
  const auto rig = pm::simulate::simulate_rig(options).value();

  const auto wheel = pm::estimate::estimate_wheel(
                         {sensor_of(rig.recording, "acc1"), sensor_of(rig.recording, "acc2")}, {})
                         .value();

  const auto& truth = rig.truth.find("angle")->values;
  const double turns = (truth.back() - truth.front()) / pm::rad_per_turn;
  pm::Moments error;
  for (std::size_t k = 0; k < truth.size(); ++k) error.add(wheel.series.angle_rad[k] - truth[k]);
  std::printf("turns: %.5f, standard deviation %.5f; in truth %.5f\n", wheel.turns->value,
              wheel.turns->std, turns);
  std::printf("error of the angle: %.4f deg rms about its mean\n", error.std() / pm::rad_per_deg);
  const bool as_promised = std::abs(wheel.turns->value - turns) < 4.0 * wheel.turns->std;
  return as_promised ? 0 : 1;
}
