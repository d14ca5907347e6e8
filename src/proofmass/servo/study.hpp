#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "proofmass/core/progress.hpp"
#include "proofmass/core/quantity.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/estimate/drive_observer.hpp"
#include "proofmass/simulate/drive_rig.hpp"

// The thesis's question of section 6.2: can the estimate from the wheel's accelerometers drive the
// motor? A closed loop on the twin of the drive with four kinds of feedback.
namespace proofmass::servo {

enum class Feedback { live_estimate, double_integration, atan2, encoder };
inline constexpr std::array feedbacks{Feedback::live_estimate, Feedback::double_integration,
                                      Feedback::atan2, Feedback::encoder};
[[nodiscard]] std::string_view name_of(Feedback feedback);  ///< "live_estimate", …

struct ServoOptions {
  std::uint64_t seed = 1;
  int seeds = 5;          ///< runs of each kind, each with other biases and noise
  double rate_hz = 200.0;
  int delay_samples = 2;  ///< from the sample to the voltage that it causes
  int encoder_lines = 1024;
  simulate::DriveParameters drive;
  Progress progress{};
};

/// What one run shows, of the load's true motion.
struct ServoRun {
  Feedback feedback = Feedback::live_estimate;
  bool compensated = false;
  std::uint64_t seed = 0;
  /// Speed steps 0 → 11 → −11 rpm: longest time to stay within 5 % of 11 rpm; −1: never. Standard
  /// deviation over the last 3 s of each step, and mean error there.
  double speed_settling_s = -1.0, speed_ripple_radps = 0.0, speed_error_radps = 0.0;
  /// Position steps of 30°: longest time to stay within 0.5°; −1: never. Largest error at the end,
  /// and peak to peak motion over the last 2 s of a step: a limit cycle.
  double position_settling_s = -1.0, position_error_rad = 0.0, limit_cycle_rad = 0.0;
};

/// A run against time.
struct ServoTrace {
  Feedback feedback = Feedback::live_estimate;
  bool compensated = false;
  std::vector<double> time_s, reference, truth, fed_back, voltage_v;
};

struct ServoStudy {
  ServoOptions options;
  estimate::DriveModel model;  ///< as identified from a recording of the drive
  std::vector<ServoRun> runs;
  std::vector<ServoTrace> speed_traces, position_traces;  ///< of the first seed
};

/// Identifies the drive from a recording of its twin, designs the controllers from the result, and
/// runs them. Errors: those of estimate_motor().
[[nodiscard]] Result<ServoStudy> run_servo_study(const ServoOptions& options);

}  // namespace proofmass::servo
