#include "proofmass/simulate/procedure/slide_series.hpp"

#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "proofmass/core/random.hpp"
#include "proofmass/simulate/procedure/pose_plan.hpp"
#include "proofmass/simulate/procedure/sensor_error_model.hpp"
#include "proofmass/simulate/procedure/slide_motion.hpp"

namespace proofmass::simulate {
namespace {

using Samples = std::array<std::vector<double>, 3>;

Samples reserved(std::size_t samples) {
  Samples three;
  for (std::vector<double>& axis : three) axis.reserve(samples);
  return three;
}

void append(Recording& recording,
            const std::string& name,
            std::string_view unit_symbol,
            Samples values) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    recording.channels.push_back(
        {name + "_" + "xyz"[axis], unit(unit_symbol), std::move(values[axis])});
}

/// For the second sensor everything is drawn anew.
ProcedureOptions with_another_seed(ProcedureOptions options) {
  options.seed ^= 0xD1B54A32D192ED03U;
  return options;
}

/// One accelerometer on the carriage.
class Accelerometer {
 public:
  Accelerometer(const ProcedureOptions& options, const Axes& place_m, std::size_t samples)
      : options_(options),
        place_m_(place_m.data()),
        sensor_(options_),
        drifts_{BenchDrift(options_, 0, 0), BenchDrift(options_, 1, 0), BenchDrift(options_, 2, 0)},
        white_{Random(session_seed(options_), "bench white noise", 0),
               Random(session_seed(options_), "bench white noise", 1),
               Random(session_seed(options_), "bench white noise", 2)},
        read(reserved(samples)),
        force(reserved(samples)),
        drift(reserved(samples)) {}
  Accelerometer(const Accelerometer&) = delete;  // the drifts hold references to the options
  Accelerometer& operator=(const Accelerometer&) = delete;

  void take(double t_s, const SlideState& state) {
    SensorMotion motion = state.motion;
    motion.force_mps2 += motion.omega_dot_radps2.cross(place_m_) +
                         motion.omega_radps.cross(motion.omega_radps.cross(place_m_));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto i = static_cast<Eigen::Index>(axis);
      const double drift_mps2 = drifts_[axis].at(t_s);
      const double noise = options_.sensor.noise_rms_mps2[axis] * white_[axis].normal();
      const double value =
          sensor_.recorded(axis, sensor_.reading_mps2(axis, motion) + drift_mps2, noise);
      read[axis].push_back(options_.slide.gravity_removed ? value - state.gravity_mps2(i) : value);
      force[axis].push_back(motion.force_mps2(i));
      drift[axis].push_back(drift_mps2);
      if (state.rest > 0) rest_drift_[axis] += drift_mps2;
    }
    if (state.rest > 0) rested_ += 1.0;
  }

  void describe(ProcedureTruth& truth) const {
    truth.equations = sensor_.recorded_equations();
    truth.sensor = sensor_.model();
    for (std::size_t axis = 0; axis < 3; ++axis)
      truth.mean_drift_mps2[axis] = rest_drift_[axis] / rested_;
  }

 private:
  ProcedureOptions options_;
  Eigen::Vector3d place_m_;
  SensorErrorModel sensor_;
  std::array<BenchDrift, 3> drifts_;
  std::array<Random, 3> white_;
  Axes rest_drift_{};
  double rested_ = 0.0;

 public:
  Samples read, force, drift;
};

/// Its bias is a random walk: one draw of the bias for the sensor, the walk for the session.
class Gyro {
 public:
  Gyro(const ProcedureOptions& options, std::size_t samples)
      : slide_(options.slide), step_s_(1.0 / options.rate_hz), read(reserved(samples)) {
    Random spread(options.seed, "gyro bias");
    for (std::size_t axis = 0; axis < 3; ++axis) {
      bias_radps_[axis] =
          slide_.gyro_bias_radps[axis] + slide_.gyro_bias_spread_radps * spread.uniform();
      noise_.emplace_back(session_seed(options), "gyro noise", axis);
      walks_.emplace_back(BiasNoise::Strength{0.0, slide_.gyro_walk_radps_rts},
                          Random(session_seed(options), "gyro walk", axis));
    }
  }

  void take(const SlideState& state) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!read[axis].empty()) walks_[axis].pass(step_s_);
      read[axis].push_back(state.motion.omega_radps(static_cast<Eigen::Index>(axis)) +
                           bias_radps_[axis] + walks_[axis].value_mps2() +
                           slide_.gyro_noise_rms_radps * noise_[axis].normal());
    }
  }

 private:
  const ProcedureSlide& slide_;
  double step_s_;
  Axes bias_radps_{};
  std::vector<Random> noise_;
  std::vector<BiasNoise> walks_;

 public:
  Samples read;
};

/// The truth's columns along the line.
struct Line {
  std::vector<double> rest, stroke, along_m, velocity_mps, accel_mps2, turn_rad;

  void take(const SlideState& state) {
    rest.push_back(state.rest > 0 ? 1.0 : 0.0);
    stroke.push_back(static_cast<double>(state.stroke));
    along_m.push_back(state.along_m);
    velocity_mps.push_back(state.velocity_mps);
    accel_mps2.push_back(state.accel_mps2);
    turn_rad.push_back(state.turn_rad);
  }
  void append_to(Recording& truth) {
    const auto add = [&](const char* name, const char* symbol, std::vector<double>& values) {
      truth.channels.push_back({name, unit(symbol), std::move(values)});
    };
    add("displacement", "m", along_m);
    add("velocity", "m/s", velocity_mps);
    add("acceleration", "m/s^2", accel_mps2);
    add("turn", "rad", turn_rad);
    truth.channels.push_back({"rest", {}, std::move(rest)});
    truth.channels.push_back({"stroke", {}, std::move(stroke)});
  }
};

}  // namespace

void record_slide(const ProcedureOptions& options,
                  std::size_t samples,
                  ProcedureResult& result,
                  const Progress& progress) {
  const ProcedureSlide& slide = options.slide;
  const SlideMotion motion(options);
  Accelerometer first(options, {}, samples);
  std::optional<Accelerometer> second;
  if (slide.second_sensor)
    second.emplace(with_another_seed(options), slide.second_place_m, samples);
  std::optional<Gyro> gyro;
  if (slide.gyro) gyro.emplace(options, samples);
  Line line;
  for (std::size_t k = 0; k < samples; ++k) {
    if (progress && k % 4096 == 0)
      progress("simulating", static_cast<double>(k) / static_cast<double>(samples));
    const double t_s = static_cast<double>(k) / options.rate_hz;
    const SlideState state = motion.at(t_s);
    first.take(t_s, state);
    if (second) second->take(t_s, state);
    if (gyro) gyro->take(state);
    line.take(state);
  }
  first.describe(result.truth);
  result.truth.strokes = motion.strokes();
  result.truth.line = motion.line();
  append(result.recording, "acc", unit_of(options.output), std::move(first.read));
  if (gyro) append(result.recording, "gyro", "rad/s", std::move(gyro->read));
  if (second) append(result.recording, "acc2", unit_of(options.output), std::move(second->read));
  append(result.truth_series, "force", "m/s^2", std::move(first.force));
  append(result.truth_series, "bias", "m/s^2", std::move(first.drift));
  line.append_to(result.truth_series);
}

}  // namespace proofmass::simulate
