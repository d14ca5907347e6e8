#include "proofmass/simulate/rig.hpp"

#include <Eigen/Core>
#include <cmath>
#include <string>
#include <utility>

#include "proofmass/core/random.hpp"
#include "proofmass/simulate/band_limited_noise.hpp"
#include "proofmass/simulate/converter.hpp"
#include "proofmass/simulate/sensor_twin.hpp"

namespace proofmass::simulate {
namespace {

/// All that moves and supplies the sensors, as functions of time.
class Surroundings {
 public:
  explicit Surroundings(const RigOptions& o)
      : motion(o.wheel.start_angle_rad, o.wheel.profile, o.wheel.ripple, o.seed),
        gravity_mps2_(o.gravity_mps2),
        tilt_rad_(o.wheel.axle_tilt_rad),
        rolling_radius_m_(o.wheel.rolling_radius_m),
        shake_horizontal_(o.wheel.shake_horizontal_rms_mps2,
                          o.wheel.shake_bandwidth_hz,
                          Random(o.seed, "horizontal shake")),
        shake_vertical_(o.wheel.shake_vertical_rms_mps2,
                        o.wheel.shake_bandwidth_hz,
                        Random(o.seed, "vertical shake")),
        supply_(o.supply),
        supply_phase_rad_(Random(o.seed, "supply ripple").phase()) {}

  /// Force at p on the wheel, in the wheel's axes; the equation stands in rig.hpp.
  [[nodiscard]] Eigen::Vector3d force_mps2(const Eigen::Vector3d& p, double t_s) const {
    const WheelState s = motion.at(t_s);
    const double sine = std::sin(s.angle_rad), cosine = std::cos(s.angle_rad);
    const double level = std::cos(tilt_rad_);
    const double up = gravity_mps2_ + shake_vertical_.at(t_s);
    const double along = shake_horizontal_.at(t_s) - rolling_radius_m_ * s.accel_radps2;
    return up * Eigen::Vector3d(sine * level, cosine * level, std::sin(tilt_rad_)) +
           along * Eigen::Vector3d(cosine, -sine, 0.0) - s.speed_radps * s.speed_radps * p +
           s.accel_radps2 * Eigen::Vector3d(-p.y(), p.x(), 0.0);
  }

  [[nodiscard]] double supply_v(double t_s) const {
    return supply_.nominal_v +
           std::numbers::sqrt2 * supply_.ripple_rms_v *
               std::sin(rad_per_turn * supply_.ripple_hz * t_s + supply_phase_rad_);
  }

  WheelMotion motion;

 private:
  double gravity_mps2_, tilt_rad_, rolling_radius_m_;
  BandLimitedNoise shake_horizontal_, shake_vertical_;
  RigSupply supply_;
  double supply_phase_rad_;
};

struct Columns {
  std::vector<double> recorded, bias_mps2;
};

/// One axis of one sensor from the first scan to the last.
class ChannelTwin {
 public:
  ChannelTwin(const SensorTwin& twin, const RigOptions& options, const Surroundings& surroundings)
      : twin_(twin),
        options_(options),
        surroundings_(surroundings),
        output_{options.output, options.daq, twin.sensor.zero_g_fraction * options.supply.nominal_v,
                twin.sensor.sensitivity_v_per_mps2} {}

  [[nodiscard]] Columns run(std::size_t sensor, std::size_t axis, std::size_t samples) const {
    AxisTwin state(twin_, options_, sensor, axis);
    OnePole filter(twin_.sensor.bandwidth_hz);
    const std::size_t axes = static_cast<std::size_t>(options_.axes);
    const double late_s = options_.daq.skew_s * static_cast<double>(sensor * axes + axis);
    Columns columns;
    columns.recorded.reserve(samples);
    columns.bias_mps2.reserve(samples);
    for (std::size_t k = 0; k < samples; ++k) {
      if (k > 0) state.step_walk();
      const double scan_s = static_cast<double>(k) / options_.rate_hz;
      const double t_s = scan_s + late_s;
      const double reading = twin_.sensor.filter_signal ? filtered(state, filter, axis, k, late_s)
                                                        : reading_at(state, axis, t_s);
      columns.recorded.push_back(output_.recorded(volts(reading, state.next_noise_mps2(), t_s)));
      columns.bias_mps2.push_back(state.bias_mps2(scan_s));
    }
    return columns;
  }

 private:
  [[nodiscard]] double reading_at(const AxisTwin& state, std::size_t axis, double t_s) const {
    const Eigen::Vector3d force =
        twin_.R_sensor_wheel * surroundings_.force_mps2(twin_.position_m, t_s);
    return state.reading_mps2(twin_.M.row(static_cast<Eigen::Index>(axis)).dot(force), t_s);
  }

  /// The same behind the RC filter, whose input is linear between eight instants of each sample.
  [[nodiscard]] double filtered(const AxisTwin& state,
                                OnePole& filter,
                                std::size_t axis,
                                std::size_t k,
                                double late_s) const {
    constexpr std::size_t substeps = 8;
    double output = 0.0;
    for (std::size_t i = k == 0 ? substeps : 1; i <= substeps; ++i) {
      const double samples = static_cast<double>(k) - 1.0 + static_cast<double>(i) / substeps;
      const double t_s = samples / options_.rate_hz + late_s;
      output = filter.next(t_s, reading_at(state, axis, t_s));
    }
    return output;
  }

  /// Zero and sensitivity follow the supply, the noise does not.
  [[nodiscard]] double volts(double reading_mps2, double noise_mps2, double t_s) const {
    const RigSensor& s = twin_.sensor;
    const double supply_v = surroundings_.supply_v(t_s);
    const double ratio = supply_v / options_.supply.nominal_v;
    return s.zero_g_fraction * supply_v +
           s.sensitivity_v_per_mps2 * (ratio * reading_mps2 + noise_mps2);
  }

  const SensorTwin& twin_;
  const RigOptions& options_;
  const Surroundings& surroundings_;
  RecordedOutput output_;
};

Recording empty_recording(const RigOptions& options, std::string source) {
  Recording recording;
  recording.source = std::move(source);
  recording.format = "simulation";
  recording.time.source = TimeSource::given_rate;
  recording.time.rate_hz = options.rate_hz;
  return recording;
}

/// The wheel's angle (from the first sensor's x axis), speed and acceleration at each scan.
void add_motion(const RigOptions& options,
                const WheelMotion& motion,
                std::size_t samples,
                Recording& truth) {
  truth.channels = {{"angle", unit("rad"), {}},
                    {"speed", unit("rad/s"), {}},
                    {"acceleration", unit("rad/s^2"), {}}};
  for (std::size_t k = 0; k < samples; ++k) {
    const WheelState s = motion.at(static_cast<double>(k) / options.rate_hz);
    truth.channels[0].values.push_back(s.angle_rad + options.sensors.front().mounting_rad);
    truth.channels[1].values.push_back(s.speed_radps);
    truth.channels[2].values.push_back(s.accel_radps2);
  }
}

void add_supply(const RigOptions& options,
                const Surroundings& surroundings,
                std::size_t samples,
                Recording& recording) {
  const std::size_t before = recording.channels.size();
  const double late_s = options.daq.skew_s * static_cast<double>(before);
  Channel& supply = recording.channels.emplace_back(Channel{"supply", unit("V"), {}});
  for (std::size_t k = 0; k < samples; ++k)
    supply.values.push_back(converted_v(
        surroundings.supply_v(static_cast<double>(k) / options.rate_hz + late_s), options.daq));
}

}  // namespace

Result<RigResult> simulate_rig(const RigOptions& options, const Progress& progress) {
  if (const Status checked = check(options); !checked) return checked.error();
  const Surroundings surroundings(options);
  const auto samples =
      static_cast<std::size_t>(std::llround(surroundings.motion.duration_s() * options.rate_hz));
  RigResult result{empty_recording(options, "simulated rig"),
                   empty_recording(options, "simulated rig, truth"),
                   {}};
  add_motion(options, surroundings.motion, samples, result.truth);
  const auto axes = static_cast<std::size_t>(options.axes);
  for (std::size_t i = 0; i < options.sensors.size(); ++i) {
    const SensorTwin twin(options, i);
    const ChannelTwin channel(twin, options, surroundings);
    for (std::size_t axis = 0; axis < axes; ++axis) {
      if (progress)
        progress("simulating the rig", static_cast<double>(i * axes + axis) /
                                           static_cast<double>(axes * options.sensors.size()));
      Columns columns = channel.run(i, axis, samples);
      const std::string number = std::to_string(i + 1), letter(1, "xyz"[axis]);
      result.recording.channels.push_back({"acc" + number + "_" + letter,
                                           unit(unit_of(options.output)),
                                           std::move(columns.recorded)});
      result.truth.channels.push_back(
          {"bias" + number + "_" + letter, unit("m/s^2"), std::move(columns.bias_mps2)});
    }
    result.sensors.push_back(model_of(twin, options, i));
  }
  if (options.supply.recorded) add_supply(options, surroundings, samples, result.recording);
  if (progress) progress("simulating the rig", 1.0);
  return result;
}

}  // namespace proofmass::simulate
