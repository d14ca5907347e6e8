#pragma once

#include <memory>
#include <vector>

#include "proofmass/servo/study.hpp"

namespace proofmass::servo {

/// What the controller is given.
struct FedBack {
  double angle_rad = 0.0, speed_radps = 0.0, current_a = 0.0;
};

/// Angle and speed of the load from the samples of a MotorRig.
class Source {
 public:
  Source() = default;
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;
  virtual ~Source() = default;
  /// A row of the rig, and the voltage since the last.
  virtual FedBack take(const std::vector<double>& row, double voltage_v) = 0;
};

[[nodiscard]] std::unique_ptr<Source> source_of(Feedback feedback,
                                                const MotorModel& model,
                                                const simulate::MotorOptions& rig);

}  // namespace proofmass::servo
