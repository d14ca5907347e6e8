#pragma once

#include <string>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/estimate/motor.hpp"
#include "proofmass/report/document.hpp"

namespace proofmass::report {

struct MotorReport {
  std::vector<std::string> inputs;
  std::vector<Note> notes;
  estimate::MotorSolution solution;
};

/// Figures of the drive, its friction curve, and what the recording does not determine. Holds a
/// reference to the report, which must outlive it.
[[nodiscard]] Document describe(const MotorReport& report);

/// Angles of motor and load, speed, friction and contact against time; the content of `--output`.
[[nodiscard]] Recording motor_series(const MotorReport& report);

}  // namespace proofmass::report
