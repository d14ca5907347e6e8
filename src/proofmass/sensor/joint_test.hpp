#pragma once

#include <optional>
#include <string_view>

#include "proofmass/core/result.hpp"
#include "proofmass/sensor/sensor_comparison.hpp"

// Joint test of all figures of two calibrations.
namespace proofmass::sensor {

/// The test of the figures that both calibrations measured independently, in the same units;
/// p_adjusted is not set. Errors: not_observable (nothing to test; the message gives the reason).
[[nodiscard]] Result<JointTest> joint_test(const SensorModel& before, const SensorModel& after);

/// Degrees of freedom of the calibration's standard deviations; absent: many.
[[nodiscard]] std::optional<double> dof_of(const SensorModel& model);

/// Degrees of freedom of a sum of two variances. Source: B. L. Welch, Biometrika 34 (1947) 28.
[[nodiscard]] std::optional<double> welch(double old_share,
                                          std::optional<double> old_dof,
                                          double new_share,
                                          std::optional<double> new_dof);

/// "OLD", "NEW" or "OLD and NEW".
[[nodiscard]] std::string_view whose(bool old_lacks, bool new_lacks);

}  // namespace proofmass::sensor
