// Uses the private dependencies of every exported library (fmt, zlib, lzma, toml++,
// nlohmann), so that a dependency missing from the package is a link error here.
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <iostream>
#include <span>
#include <string>
#include <vector>

#include "proofmass/calibrate/multi_position.hpp"
#include "proofmass/core/version.hpp"
#include "proofmass/estimate/wheel.hpp"
#include "proofmass/fit/curve.hpp"
#include "proofmass/io/read_recording.hpp"
#include "proofmass/report/wheel/report.hpp"
#include "proofmass/sensor/sensor_file.hpp"
#include "proofmass/signal/audit.hpp"
#include "proofmass/simulate/rig.hpp"

namespace pm = proofmass;

int main() {
  const std::string table = "time (s),ax (g)\n0,1\n0.01,2\n0.02,1\n";
  const auto recording =
      pm::io::read_recording(std::as_bytes(std::span(table)), "table.csv", {}).value();
  const auto audit = pm::signal::audit(recording);
  const auto sensor = pm::sensor::parse_sensor_file("[sensor]\nname = \"A1\"\n", "a1.toml").value();

  const std::vector<double> x{0.0, 1.0, 2.0, 3.0}, y{5.0, 2.5, 1.25, 0.625};
  const auto decay =
      pm::fit::fit_curve(
          x, y, [](double t, pm::View<double> p) { return p[0] * std::exp(-t / p[1]); },
          std::vector{1.0, 1.0})
          .value();

  std::vector<pm::calibrate::Pose> poses;
  for (int side = 0; side < 6; ++side) {
    const double up = side < 3 ? 10.1 : -9.9;
    poses.emplace_back().mean = Eigen::Vector3d::Constant(0.1);
    poses.back().mean(side % 3) = up;
  }
  const auto turned = pm::calibrate::calibrate_positions(poses, {.gravity_mps2 = 10.0}).value();

  pm::simulate::RigOptions options;
  options.wheel.profile.front().duration_s = 15.0;
  const auto rig = pm::simulate::simulate_rig(options).value();
  std::vector<pm::estimate::WheelSensor> sensors(1);
  for (std::size_t k = 0; k < rig.recording.samples(); ++k)
    sensors[0].time_s.push_back(rig.recording.time.at(k));
  sensors[0].accel_mps2 = {
      rig.recording.find("acc1_x")->values.copy(), rig.recording.find("acc1_y")->values.copy(), {}};
  pm::report::WheelReport report;
  report.inputs = {"rig.csv"};
  report.solution = pm::estimate::estimate_wheel(sensors, {}).value();
  const pm::estimate::WheelSolution& wheel = report.solution;
  std::cout << pm::version() << '\n' << pm::report::describe(report).page.conclusion << '\n';

  const bool right = std::abs(turned.bias[2]->value - 0.1) < 1e-9 && audit.samples == 3 &&
                     sensor.model.name == "A1" && decay.converged &&
                     std::abs(decay.parameters[1] * std::log(2.0) - 1.0) < 1e-9 && wheel.turns &&
                     std::abs(wheel.turns->value - 2.75) < 0.1;
  return right ? EXIT_SUCCESS : EXIT_FAILURE;
}
