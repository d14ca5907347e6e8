#include "proofmass/servo/loop/run.hpp"

#include <algorithm>
#include <cmath>
#include <deque>

#include "proofmass/core/units.hpp"
#include "proofmass/servo/loop/feedback.hpp"

namespace proofmass::servo {
namespace {

constexpr double rest_s = 2.0, step_s = 6.0;
constexpr double position_band_rad = 2.0 * rad_per_deg;
constexpr double set_speed_radps = 11.0 * radps_per_rpm, set_turn_rad = 30.0 * rad_per_deg;

using Reference = double (*)(double);

double speed_reference(double t_s) {
  if (t_s < rest_s) return 0.0;
  return t_s < rest_s + step_s ? set_speed_radps : -set_speed_radps;
}

// 30° up, twice, and back, relative to the start.
double position_reference(double t_s) {
  if (t_s < rest_s) return 0.0;
  constexpr std::array levels{1.0, 2.0, 1.0, 0.0};
  const auto k = static_cast<std::size_t>((t_s - rest_s) / step_s);
  return set_turn_rad * levels[std::min(k, levels.size() - 1)];
}

struct Task {
  bool of_angle;
  Reference reference;
  double duration_s;
};
constexpr Task speed_task{false, speed_reference, rest_s + 2.0 * step_s};
constexpr Task position_task{true, position_reference, rest_s + 4.0 * step_s};

class Controller {
 public:
  Controller(const Task& task, const Gains& gains, const MotorModel& model, bool compensated)
      : task_(task),
        gains_(gains),
        model_(model),
        compensated_(compensated),
        under_way_(static_cast<std::size_t>(gains.delay_samples), 0.0) {}

  // The voltage that is applied `delay` samples later.
  double next(const FedBack& seen, double reference, double step, double limit_v) {
    const double wanted_speed = task_.of_angle ? 0.0 : reference;
    const double error = task_.of_angle ? seen.angle_rad - reference : seen.speed_radps - reference;
    const Eigen::Index d = gains_.delay_samples;
    double v = -gains_.K(1) * (seen.speed_radps - wanted_speed) - gains_.K(2) * seen.current_a;
    if (task_.of_angle) v -= gains_.K(0) * error;
    for (Eigen::Index k = 0; k < d; ++k)
      v -= gains_.K(3 + k) * under_way_[static_cast<std::size_t>(k)];
    v -= gains_.K(3 + d) * integral_;
    const double fed = compensation(error, wanted_speed);
    const double total = std::clamp(v + fed, -limit_v, limit_v);
    // No windup while the supply limits.
    if (std::abs(v + fed) < limit_v) integral_ += step * error;
    if (d > 0) {
      under_way_.pop_front();
      under_way_.push_back(total - fed);
    }
    return total;
  }

 private:
  // Voltage that balances friction in the direction in which the load is to move; for a position
  // fading over half a degree, or the sign of the error would be a limit cycle of its own.
  [[nodiscard]] double compensation(double error, double wanted_speed) const {
    if (!compensated_) return 0.0;
    constexpr double fade_rad = 0.5 * rad_per_deg;
    const double to_volts = model_.resistance_ohm / model_.torque_constant_nmpa;
    if (!task_.of_angle) return to_volts * model_.dry_friction_nm(wanted_speed);
    return -to_volts * model_.coulomb_nm * std::tanh(error / fade_rad);
  }

  const Task& task_;
  const Gains& gains_;
  const MotorModel& model_;
  bool compensated_;
  std::deque<double> under_way_;
  double integral_ = 0.0;
};

Result<ServoTrace> trace_of(const ServoOptions& options,
                            const MotorModel& model,
                            const Gains& gains,
                            const ServoRun& kind,
                            const Task& task) {
  simulate::MotorOptions rig_options{.seed = kind.seed,
                                     .rate_hz = options.rate_hz,
                                     .drive = options.drive,
                                     .encoder_lines = options.encoder_lines};
  Result<simulate::MotorRig> started = simulate::MotorRig::start(rig_options);
  if (!started) return started.error();
  simulate::MotorRig rig = std::move(started).value();
  const auto source = source_of(kind.feedback, model, rig_options);
  Controller controller(task, gains, model, kind.compensated);
  std::deque<double> commands(static_cast<std::size_t>(options.delay_samples), 0.0);
  ServoTrace out{.feedback = kind.feedback, .compensated = kind.compensated};
  const double step = 1.0 / options.rate_hz, start_rad = rig.angle_rad();
  std::vector<double> row;
  double applied = 0.0, origin = 0.0;
  for (int k = 0; k < static_cast<int>(task.duration_s * options.rate_hz); ++k) {
    const double t = k * step;
    rig.measure(row);
    FedBack seen = source->take(row, applied);
    if (t < rest_s - 0.5 * step) origin = seen.angle_rad;
    seen.angle_rad -= origin;
    const double reference = task.reference(t);
    const bool waiting = t < rest_s - 0.5 * step;
    commands.push_back(
        waiting ? 0.0 : controller.next(seen, reference, step, rig_options.supply_limit_v));
    applied = commands.front();
    commands.pop_front();
    out.time_s.push_back(t);
    out.reference.push_back(reference);
    out.truth.push_back(task.of_angle ? rig.angle_rad() - start_rad : rig.state().load_radps);
    out.fed_back.push_back(task.of_angle ? seen.angle_rad : seen.speed_radps);
    out.voltage_v.push_back(applied);
    rig.advance(applied);
  }
  return out;
}

// The samples of each step: from one change of the reference to the next.
std::vector<std::array<std::size_t, 2>> steps_of(const ServoTrace& trace) {
  std::vector<std::array<std::size_t, 2>> out;
  std::size_t first = 0;
  for (std::size_t k = 1; k <= trace.reference.size(); ++k) {
    if (k < trace.reference.size() && trace.reference[k] == trace.reference[k - 1]) continue;
    if (trace.time_s[first] >= rest_s - 1e-9) out.push_back({first, k});
    first = k;
  }
  return out;
}

// Time after which the truth stays within the band, for the last second at least.
std::optional<double> settling_s(const ServoTrace& trace,
                                 const std::array<std::size_t, 2>& step,
                                 double band) {
  constexpr double kept_s = 1.0;
  std::size_t last = step[0];
  for (std::size_t k = step[0]; k < step[1]; ++k)
    if (std::abs(trace.truth[k] - trace.reference[k]) > band) last = k + 1;
  if (last >= step[1] || trace.time_s[step[1] - 1] - trace.time_s[last] < kept_s)
    return std::nullopt;
  return trace.time_s[last] - trace.time_s[step[0]];
}

struct Tail {
  double mean = 0.0, std = 0.0, spread = 0.0, largest = 0.0;
};

Tail tail_of(const ServoTrace& trace, const std::array<std::size_t, 2>& step, double duration_s) {
  Tail out;
  double low = 1e9, high = -1e9, squares = 0.0;
  std::size_t n = 0;
  for (std::size_t k = step[0]; k < step[1]; ++k) {
    if (trace.time_s[step[1] - 1] - trace.time_s[k] > duration_s) continue;
    const double e = trace.truth[k] - trace.reference[k];
    out.mean += e;
    squares += e * e;
    low = std::min(low, e);
    high = std::max(high, e);
    ++n;
  }
  out.mean /= static_cast<double>(n);
  out.std = std::sqrt(std::max(0.0, squares / static_cast<double>(n) - out.mean * out.mean));
  out.spread = high - low;
  out.largest = std::max(std::abs(low), std::abs(high));
  return out;
}

}  // namespace

std::optional<double> longer(const std::optional<double>& a, const std::optional<double>& b) {
  return a && b ? std::optional(std::max(*a, *b)) : std::nullopt;
}

Controllers design_controllers(const MotorModel& model, const ServoOptions& options) {
  const double step = 1.0 / options.rate_hz;
  return {
      .speed = design(model, step, options.delay_samples,
                      {.angle_rad = 0.0, .speed_radps = 0.3, .integral = 0.03, .voltage_v = 6.0}),
      .position =
          design(model, step, options.delay_samples,
                 {.angle_rad = 0.03, .speed_radps = 1.0, .integral = 0.02, .voltage_v = 6.0})};
}

Result<ServoRun> run_loop(const ServoOptions& options,
                          const MotorModel& model,
                          const Controllers& controllers,
                          const ServoRun& kind,
                          Traces* traces) {
  Result<ServoTrace> speed = trace_of(options, model, controllers.speed, kind, speed_task);
  if (!speed) return speed.error();
  Result<ServoTrace> position = trace_of(options, model, controllers.position, kind, position_task);
  if (!position) return position.error();
  ServoRun out = kind;
  out.speed_settling_s = out.position_settling_s = 0.0;
  for (const auto& step : steps_of(*speed)) {
    out.speed_settling_s =
        longer(out.speed_settling_s, settling_s(*speed, step, 0.05 * set_speed_radps));
    const Tail tail = tail_of(*speed, step, 3.0);
    out.speed_ripple_radps = std::max(out.speed_ripple_radps, tail.std);
    out.speed_error_radps = std::max(out.speed_error_radps, std::abs(tail.mean));
  }
  for (const auto& step : steps_of(*position)) {
    out.position_settling_s =
        longer(out.position_settling_s, settling_s(*position, step, position_band_rad));
    const Tail tail = tail_of(*position, step, 2.0);
    out.position_error_rad = std::max(out.position_error_rad, tail.largest);
    out.limit_cycle_rad = std::max(out.limit_cycle_rad, tail.spread);
  }
  if (traces != nullptr) *traces = {std::move(speed).value(), std::move(position).value()};
  return out;
}

}  // namespace proofmass::servo
