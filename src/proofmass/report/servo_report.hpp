#pragma once

#include <string>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/report/document.hpp"
#include "proofmass/servo/study.hpp"

namespace proofmass::report {

/// `simulate --procedure servo`.
struct ServoReport {
  std::string output{};  ///< the traces, if written
  const servo::ServoStudy& study;
};

/// The closed loops in a table: settling, ripple, errors and limit cycles.
[[nodiscard]] Document describe(const ServoReport& report);

/// Speed and position steps with each feedback, friction compensated, against time.
[[nodiscard]] Recording servo_series(const servo::ServoStudy& study);

/// The speed steps with each feedback.
[[nodiscard]] Figure servo_speed_figure(const servo::ServoStudy& study);

}  // namespace proofmass::report
