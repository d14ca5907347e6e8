#pragma once

#include <string>
#include <vector>

#include "proofmass/report/document.hpp"
#include "proofmass/simulate/motor_rig.hpp"
#include "proofmass/simulate/procedure.hpp"
#include "proofmass/simulate/rig.hpp"

namespace proofmass::report {

struct SimulateReport {
  std::vector<std::string> inputs;  ///< description of the rig, if read from a file
  std::string output, truth;        ///< files written
  const simulate::RigOptions& options;
  const simulate::RigResult& result;
};

/// What was simulated, and the files that contain it.
[[nodiscard]] Document describe(const SimulateReport& report);

struct ProcedureReport {
  std::vector<std::string> inputs{};      ///< the description, if read from a file
  std::string output, truth{}, sensor{};  ///< files written
  const simulate::ProcedureOptions& options;
  const simulate::ProcedureResult& result;
};

/// The same for a calibration procedure or a slide, with the figures of the true sensor.
[[nodiscard]] Document describe(const ProcedureReport& report);

struct MotorRigReport {
  std::vector<std::string> inputs{};
  std::string output, truth{};  ///< files written
  const simulate::MotorOptions& options;
  const simulate::MotorResult& result;
};

/// The same for the drive, with its true figures.
[[nodiscard]] Document describe(const MotorRigReport& report);

}  // namespace proofmass::report
