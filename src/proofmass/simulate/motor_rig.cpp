#include "proofmass/simulate/motor_rig.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>

#include "proofmass/core/random.hpp"
#include "proofmass/simulate/rig/converter.hpp"
#include "proofmass/simulate/rig/rig_state.hpp"
#include "proofmass/simulate/rig/sensor_twin.hpp"

namespace proofmass::simulate {
namespace {

constexpr double voltage_range_v = 100.0, current_range_a = 4.0;

RigOptions sensor_options(const MotorOptions& o) {
  RigOptions rig;
  rig.seed = o.seed;
  rig.rate_hz = o.rate_hz;
  rig.gravity_mps2 = o.gravity_mps2;
  rig.bias_spread_mps2 = o.bias_spread_mps2;
  rig.sensors = o.sensors;
  return rig;
}

double quantised(double value, double range, int bits) {
  if (bits == 0) return value;
  const double step = std::ldexp(2.0 * range, -bits);
  return std::clamp(step * std::round(value / step), -range, range);
}

Recording empty(const MotorOptions& options, const char* source) {
  Recording recording;
  recording.source = source;
  recording.format = "simulation";
  recording.time.source = TimeSource::given_rate;
  recording.time.rate_hz = options.rate_hz;
  return recording;
}

}  // namespace

double exploring_voltage(double t_s) {
  constexpr double turn = 2.0 * std::numbers::pi;
  const double swell = 0.6 + 0.4 * std::sin(turn * 0.037 * t_s);
  return 26.0 * swell * std::sin(turn * 0.2 * t_s) + 10.0 * std::sin(turn * 0.03 * t_s) +
         5.0 * std::sin(turn * 1.3 * t_s);
}

class MotorRig::Parts {
 public:
  explicit Parts(const MotorOptions& o)
      : options(o), rig(sensor_options(o)), drive(o.drive), noise_(o.seed, "drive measurements") {
    channels.push_back({"voltage", unit("V"), {}});
    channels.push_back({"current", unit("A"), {}});
    if (o.encoder_lines > 0) channels.push_back({"encoder", unit("rad"), {}});
    for (std::size_t s = 0; s < o.sensors.size(); ++s) {
      twins_.push_back(std::make_unique<SensorTwin>(rig, s));
      for (std::size_t axis = 0; axis < 2; ++axis) {
        channels.push_back({"acc" + std::to_string(s + 1) + "_" + "xy" [axis], unit("m/s^2"), {}});
        axes_.emplace_back(*twins_.back(), rig, s, axis);
      }
    }
  }

  void measure(std::vector<double>& row) {
    row.clear();
    const GearMotorState& at = drive.state();
    row.push_back(quantised(voltage_v + options.voltage_noise_v * noise_.normal(), voltage_range_v,
                            options.adc_bits));
    row.push_back(quantised(at.current_a + options.current_noise_a * noise_.normal(),
                            current_range_a, options.adc_bits));
    if (options.encoder_lines > 0) {
      const double count = rad_per_turn / (4.0 * options.encoder_lines);
      row.push_back(count * std::floor(at.load_rad / count));
    }
    Instant now{.t_s = time_s,
                .wheel = {options.start_angle_rad + at.load_rad, at.load_radps, at.load_radps2},
                .still_mps2 = {}};
    const double angle = now.wheel.angle_rad;
    now.still_mps2 = options.gravity_mps2 * Eigen::Vector3d(std::sin(angle), std::cos(angle), 0.0);
    for (std::size_t k = 0; k < axes_.size(); ++k) {
      const SensorTwin& twin = *twins_[k / 2];
      const Eigen::Vector3d force = twin.R_sensor_wheel * now.force_mps2(twin.position_m);
      const double u = twin.M.row(static_cast<Eigen::Index>(k % 2)).dot(force);
      row.push_back(axes_[k].reading_mps2(u, twin.warm_up(time_s)) + axes_[k].next_noise_mps2());
    }
  }

  MotorOptions options;
  RigOptions rig;
  GearMotor drive;
  std::vector<Channel> channels;
  double time_s = 0.0, voltage_v = 0.0;

 private:
  Random noise_;
  std::vector<std::unique_ptr<SensorTwin>> twins_;
  std::vector<AxisTwin> axes_;
};

Result<MotorRig> MotorRig::start(const MotorOptions& options) {
  const GearMotorParameters& p = options.drive;
  if (!(options.rate_hz >= 10.0 && options.rate_hz <= 20e3))
    return Error{Errc::invalid_argument, "rate_hz must be between 10 and 20000"};
  if (!(options.duration_s > 0.0 && options.duration_s * options.rate_hz <= 1e8))
    return Error{Errc::invalid_argument, "duration_s must be positive, for at most 1e8 samples"};
  if (options.adc_bits < 0 || options.adc_bits > 24)
    return Error{Errc::invalid_argument, "adc_bits must be between 0 and 24"};
  if (!(p.resistance_ohm > 0.0) || !(p.motor_inertia_kgm2 > 0.0) || !(p.load_inertia_kgm2 > 0.0) ||
      !(p.stribeck_speed_radps > 0.0) || p.backlash_rad < 0.0 || p.coulomb_nm < 0.0 ||
      p.breakaway_nm < p.coulomb_nm)
    return Error{Errc::invalid_argument,
                 "the drive's resistance, inertias and Stribeck speed must be positive, its "
                 "backlash and friction not negative, and breakaway at least the Coulomb friction"};
  if (const Status good = check(sensor_options(options)); !good) return good.error();
  return MotorRig(options);
}

MotorRig::MotorRig(const MotorOptions& options) : parts_(std::make_unique<Parts>(options)) {}
MotorRig::MotorRig(MotorRig&&) noexcept = default;
MotorRig& MotorRig::operator=(MotorRig&&) noexcept = default;
MotorRig::~MotorRig() = default;

const std::vector<Channel>& MotorRig::channels() const {
  return parts_->channels;
}

void MotorRig::measure(std::vector<double>& row) {
  parts_->measure(row);
}

void MotorRig::advance(double voltage_v) {
  advance(voltage_v, 1.0 / parts_->options.rate_hz);
}

void MotorRig::advance(double voltage_v, double duration_s) {
  const double limit = parts_->options.supply_limit_v;
  parts_->voltage_v = std::clamp(voltage_v, -limit, limit);
  parts_->drive.advance(parts_->voltage_v, duration_s);
  parts_->time_s += duration_s;
}

const GearMotorState& MotorRig::state() const {
  return parts_->drive.state();
}

double MotorRig::angle_rad() const {
  return parts_->options.start_angle_rad + parts_->drive.state().load_rad;
}

Result<MotorResult> simulate_motor(const MotorOptions& options) {
  Result<MotorRig> started = MotorRig::start(options);
  if (!started) return started.error();
  MotorRig rig = std::move(started).value();
  MotorResult out{.recording = empty(options, "simulated drive"),
                  .truth = empty(options, "simulated drive, truth")};
  out.recording.channels = rig.channels();
  out.truth.channels = {{"angle", unit("rad"), {}},
                        {"speed", unit("rad/s"), {}},
                        {"acceleration", unit("rad/s^2"), {}},
                        {"motor_angle", unit("rad"), {}},
                        {"motor_speed", unit("rad/s"), {}},
                        {"contact", {}, {}}};
  std::vector<double> row;
  const auto samples = static_cast<std::size_t>(std::llround(options.duration_s * options.rate_hz));
  // The voltage changes four times as often as it is recorded, as a controller's does.
  constexpr int parts = 4;
  for (std::size_t k = 0; k < samples; ++k) {
    rig.measure(row);
    for (std::size_t c = 0; c < row.size(); ++c)
      out.recording.channels[c].values.edit().push_back(row[c]);
    const GearMotorState& at = rig.state();
    const std::array truth{rig.angle_rad(), at.load_radps,  at.load_radps2,
                           at.motor_rad,    at.motor_radps, static_cast<double>(at.contact)};
    for (std::size_t c = 0; c < truth.size(); ++c)
      out.truth.channels[c].values.edit().push_back(truth[c]);
    for (int j = 1; j <= parts; ++j) {
      const double t = (static_cast<double>(k) + static_cast<double>(j) / parts) / options.rate_hz;
      rig.advance(exploring_voltage(t), 1.0 / (options.rate_hz * parts));
    }
  }
  return out;
}

}  // namespace proofmass::simulate
