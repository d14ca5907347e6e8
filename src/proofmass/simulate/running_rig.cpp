#include "proofmass/simulate/running_rig.hpp"

#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "proofmass/simulate/rig/converter.hpp"
#include "proofmass/simulate/rig/rig_state.hpp"
#include "proofmass/simulate/rig/sensor_twin.hpp"

namespace proofmass::simulate {
namespace {

/// State of a sensor at one time, shared by its axes.
class SensorNow {
 public:
  SensorNow(const RigOptions& options, std::size_t index) : twin(options, index) {}

  void move_to(const Instant& now) {
    if (t_s_ == now.t_s) return;
    t_s_ = now.t_s;
    force_mps2 = twin.R_sensor_wheel * now.force_mps2(twin.position_m);
    warm_up = twin.warm_up(now.t_s);
  }

  SensorTwin twin;
  Eigen::Vector3d force_mps2 = Eigen::Vector3d::Zero();  ///< in its own axes
  double warm_up = 0.0;                                  ///< fraction of it reached

 private:
  double t_s_ = std::numeric_limits<double>::quiet_NaN();
};

/// One axis of one sensor, from scan to scan.
class ChannelTwin {
 public:
  ChannelTwin(SensorNow& sensor, const RigOptions& o, std::size_t number, std::size_t axis)
      : sensor_(sensor),
        axis_(sensor.twin, o, number, axis),
        row_(static_cast<Eigen::Index>(axis)),
        filter_(sensor.twin.sensor.bandwidth_hz),
        nominal_v_(o.supply.nominal_v),
        output_{o.output, o.daq, sensor.twin.sensor.zero_g_fraction * o.supply.nominal_v,
                sensor.twin.sensor.sensitivity_v_per_mps2} {}

  void step_walk() { axis_.step_walk(); }
  [[nodiscard]] bool is_filtered() const { return sensor_.twin.sensor.filter_signal; }

  /// The filter's input is linear between the given times.
  void filter_to(const Instant& now) { filtered_mps2_ = filter_.next(now.t_s, reading_mps2(now)); }

  [[nodiscard]] double recorded(const Instant& now) {
    const double reading = is_filtered() ? filtered_mps2_ : reading_mps2(now);
    return output_.recorded(volts(reading, axis_.next_noise_mps2(), now.supply_v));
  }

  [[nodiscard]] double bias_mps2(const Instant& now) {
    sensor_.move_to(now);
    return axis_.bias_mps2(sensor_.warm_up);
  }

 private:
  [[nodiscard]] double reading_mps2(const Instant& now) {
    sensor_.move_to(now);
    return axis_.reading_mps2(sensor_.twin.M.row(row_).dot(sensor_.force_mps2), sensor_.warm_up);
  }

  /// Zero and sensitivity scale with the supply, the noise does not.
  [[nodiscard]] double volts(double reading_mps2, double noise_mps2, double supply_v) const {
    const RigSensor& s = sensor_.twin.sensor;
    const double ratio = supply_v / nominal_v_;
    return s.zero_g_fraction * supply_v +
           s.sensitivity_v_per_mps2 * (ratio * reading_mps2 + noise_mps2);
  }

  SensorNow& sensor_;
  AxisTwin axis_;
  Eigen::Index row_;
  OnePole filter_;
  double filtered_mps2_ = 0.0;
  double nominal_v_;
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

/// "1_x"
std::string place_of(std::size_t sensor, std::size_t axis) {
  return std::to_string(sensor + 1) + "_" + "xyz"[axis];
}

/// Extends the columns by `rows`.
void lengthen(RunningRig::Columns& columns, std::size_t count, std::size_t rows) {
  columns.resize(count);
  for (std::vector<double>& column : columns) column.resize(column.size() + rows);
}

}  // namespace

class RunningRig::Scans {
 public:
  explicit Scans(const RigOptions& o)
      : options(o),
        recording(empty_recording(o, "simulated rig")),
        truth(empty_recording(o, "simulated rig, truth")),
        surroundings_(o) {
    truth.channels = {{"angle", unit("rad"), {}},
                      {"speed", unit("rad/s"), {}},
                      {"acceleration", unit("rad/s^2"), {}}};
    const auto axes = static_cast<std::size_t>(o.axes);
    sensors_.reserve(o.sensors.size());  // the channels refer to them
    for (std::size_t i = 0; i < o.sensors.size(); ++i) {
      SensorNow& sensor = sensors_.emplace_back(o, i);
      models.push_back(model_of(sensor.twin, o, i));
      for (std::size_t axis = 0; axis < axes; ++axis) {
        recording.channels.push_back({"acc" + place_of(i, axis), unit(unit_of(o.output)), {}});
        truth.channels.push_back({"bias" + place_of(i, axis), unit("m/s^2"), {}});
        channels_.emplace_back(sensor, options, i, axis);
        filters_ = filters_ || channels_.back().is_filtered();
      }
    }
    if (o.supply.recorded) recording.channels.push_back({"supply", unit("V"), {}});
  }

  [[nodiscard]] std::uint64_t of_profile() const {
    return static_cast<std::uint64_t>(std::llround(surroundings_.duration_s() * options.rate_hz));
  }

  void run(std::size_t scans, Columns& recorded, Columns* truths) {
    lengthen(recorded, recording.channels.size(), scans);
    if (truths != nullptr) lengthen(*truths, truth.channels.size(), scans);
    for (std::size_t left = scans; left > 0; --left, ++next) {
      if (next > 0)
        for (ChannelTwin& channel : channels_) channel.step_walk();
      if (truths != nullptr) report(*truths, truths->front().size() - left);
      if (filters_) filter();
      record(recorded, recorded.front().size() - left);
    }
  }

  const RigOptions options;
  Recording recording, truth;
  std::vector<sensor::SensorModel> models;
  std::uint64_t next = 0;

 private:
  /// Time at which the card samples a channel; `scans` counts from the first.
  [[nodiscard]] double time_s(double scans, std::size_t channel) const {
    return scans / options.rate_hz + options.daq.skew_s * static_cast<double>(channel);
  }

  // Channel by channel at each time, so that all share one time if there is no skew.
  void filter() {
    constexpr std::size_t substeps = 8;
    for (std::size_t i = next == 0 ? substeps : 1; i <= substeps; ++i) {
      const double scans = static_cast<double>(next) - 1.0 + static_cast<double>(i) / substeps;
      for (std::size_t c = 0; c < channels_.size(); ++c)
        if (channels_[c].is_filtered()) channels_[c].filter_to(surroundings_.at(time_s(scans, c)));
    }
  }

  void record(Columns& recorded, std::size_t row) {
    const auto scan = static_cast<double>(next);
    for (std::size_t c = 0; c < channels_.size(); ++c)
      recorded[c][row] = channels_[c].recorded(surroundings_.at(time_s(scan, c)));
    if (!options.supply.recorded) return;
    const Instant& now = surroundings_.at(time_s(scan, channels_.size()));
    recorded.back()[row] = converted_v(now.supply_v, options.daq);
  }

  /// The wheel's angle (from the first sensor's x axis), speed and acceleration, and the biases.
  void report(Columns& truths, std::size_t row) {
    const Instant& now = surroundings_.at(static_cast<double>(next) / options.rate_hz);
    truths[0][row] = now.wheel.angle_rad + options.sensors.front().mounting_rad;
    truths[1][row] = now.wheel.speed_radps;
    truths[2][row] = now.wheel.accel_radps2;
    for (std::size_t c = 0; c < channels_.size(); ++c)
      truths[3 + c][row] = channels_[c].bias_mps2(now);
  }

  RigState surroundings_;
  std::vector<SensorNow> sensors_;
  std::vector<ChannelTwin> channels_;
  bool filters_ = false;
};

Result<RunningRig> RunningRig::start(const RigOptions& options) {
  if (const Status checked = check(options); !checked) return checked.error();
  return RunningRig(options);
}

RunningRig::RunningRig(const RigOptions& options) : scans_(std::make_unique<Scans>(options)) {}
RunningRig::RunningRig(RunningRig&&) noexcept = default;
RunningRig& RunningRig::operator=(RunningRig&&) noexcept = default;
RunningRig::~RunningRig() = default;

const Recording& RunningRig::recording() const {
  return scans_->recording;
}
const Recording& RunningRig::truth() const {
  return scans_->truth;
}
const std::vector<sensor::SensorModel>& RunningRig::sensors() const {
  return scans_->models;
}
std::uint64_t RunningRig::scan() const {
  return scans_->next;
}
std::uint64_t RunningRig::profile_scans() const {
  return scans_->of_profile();
}

void RunningRig::run(std::size_t scans, Columns& recorded, Columns* truth) {
  scans_->run(scans, recorded, truth);
}

}  // namespace proofmass::simulate
