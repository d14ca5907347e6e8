#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "proofmass/core/progress.hpp"
#include "proofmass/core/quantity.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/servo/motor_model.hpp"
#include "proofmass/simulate/motor_rig.hpp"

// The thesis's question of section 6.2: can the estimate from the wheel's accelerometers drive the
// motor? A closed loop on the twin of the drive with four kinds of feedback.
namespace proofmass::servo {

enum class Feedback { live_estimate, double_integration, atan2, encoder };
inline constexpr std::array feedbacks{Feedback::live_estimate, Feedback::double_integration,
                                      Feedback::atan2, Feedback::encoder};
[[nodiscard]] std::string_view name_of(Feedback feedback);  ///< "live_estimate", …

struct ServoOptions {
  std::uint64_t seed = 1;
  int seeds = 5;  ///< runs of each kind, each with other biases and noise
  double rate_hz = 200.0;
  int delay_samples = 2;  ///< from the sample to the voltage that it causes
  int encoder_lines = 1024;
  simulate::GearMotorParameters drive{};
  Progress progress{};
};

/// One kind of loop, of the load's true motion; over several runs the worst of each figure.
struct ServoRun {
  Feedback feedback = Feedback::live_estimate;
  bool compensated = false;  ///< with a voltage that balances the friction
  std::uint64_t seed = 0;    ///< of a single run
  /// Speed steps 0 → 11 → −11 rpm: time until the speed stays within 5 % of 11 rpm, nullopt where
  /// it does not; standard deviation over the last 3 s of each step, and the mean error there.
  std::optional<double> speed_settling_s{};
  double speed_ripple_radps = 0.0, speed_error_radps = 0.0;
  /// Position steps of 30°: time until the angle stays within 2°; largest error over the last 2 s
  /// of a step, and the motion there from peak to peak: a limit cycle.
  std::optional<double> position_settling_s{};
  double position_error_rad = 0.0, limit_cycle_rad = 0.0;
};

/// A run against time.
struct ServoTrace {
  Feedback feedback = Feedback::live_estimate;
  bool compensated = false;
  std::vector<double> time_s{}, reference{}, truth{}, fed_back{}, voltage_v{};
};

struct ServoStudy {
  ServoOptions options;
  MotorModel model;  ///< as identified from a recording of the drive
  std::vector<ServoRun> runs;
  std::vector<ServoRun> worst;  ///< of each kind, in the order of `feedbacks`, compensated last
  std::vector<ServoTrace> speed_traces, position_traces;  ///< of the first seed
};

/// Identifies the drive from a recording of its twin, designs the controllers from the result, and
/// runs them. Errors: invalid_argument (rate, delay or number of runs), those of estimate_motor().
[[nodiscard]] Result<ServoStudy> study_servo(const ServoOptions& options);

}  // namespace proofmass::servo
