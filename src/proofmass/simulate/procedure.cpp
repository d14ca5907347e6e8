#include "proofmass/simulate/procedure.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>

#include "proofmass/core/random.hpp"
#include "proofmass/simulate/procedure/pose_motion.hpp"
#include "proofmass/simulate/procedure/pose_plan.hpp"
#include "proofmass/simulate/procedure/sensor_error_model.hpp"
#include "proofmass/simulate/procedure/slide_series.hpp"

namespace proofmass::simulate {
namespace {

constexpr std::array<std::pair<Procedure, std::string_view>, 5> names{
    {{Procedure::tumble, "tumble"},
     {Procedure::four_position, "four-position"},
     {Procedure::six_position, "six-position"},
     {Procedure::multi_position, "multi-position"},
     {Procedure::slide, "slide"}}};

Recording empty_recording(const ProcedureOptions& options, const char* what) {
  Recording recording;
  recording.source = "simulated " + std::string(name_of(options.procedure)) + what;
  recording.format = "simulation";
  recording.time.source = TimeSource::given_rate;
  recording.time.rate_hz = options.rate_hz;
  return recording;
}

std::vector<Channel> triad(const char* name, std::string_view unit_symbol, std::size_t samples) {
  std::vector<Channel> channels;
  for (const char letter : {'x', 'y', 'z'}) {
    channels.push_back({std::string(name) + "_" + letter, unit(unit_symbol), {}});
    channels.back().values.edit().reserve(samples);
  }
  return channels;
}

/// The channels of the sensor and the truth series.
class Series {
 public:
  Series(const ProcedureOptions& options, std::vector<PlannedPose> plan)
      : options_(options),
        sensor_(options),
        motion_(options, std::move(plan), sensor_.feels_rates()),
        drifts_{BenchDrift(options, 0, 0), BenchDrift(options, 1, 0), BenchDrift(options, 2, 0)},
        white_{Random(session_seed(options), "bench white noise", 0),
               Random(session_seed(options), "bench white noise", 1),
               Random(session_seed(options), "bench white noise", 2)} {}

  void run(std::size_t samples, ProcedureResult& result, const Progress& progress) {
    std::vector<Channel> read = triad("acc", unit_of(options_.output), samples);
    std::vector<Channel> force = triad("force", "m/s^2", samples);
    std::vector<Channel> bias = triad("bias", "m/s^2", samples);
    Channel rest{"rest", {}, {}}, position{"position", {}, {}};
    for (std::size_t k = 0; k < samples; ++k) {
      if (progress && k % 4096 == 0)
        progress("simulating", static_cast<double>(k) / static_cast<double>(samples));
      const double t_s = static_cast<double>(k) / options_.rate_hz;
      const SensorMotion motion = motion_.at(t_s);
      const std::size_t number = motion_.rest_at(t_s);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double drift = drifts_[axis].at(t_s);
        const double noise = options_.sensor.noise_rms_mps2[axis] * white_[axis].normal();
        read[axis].values.edit().push_back(
            sensor_.recorded(axis, sensor_.reading_mps2(axis, motion) + drift, noise));
        force[axis].values.edit().push_back(motion.force_mps2(static_cast<Eigen::Index>(axis)));
        bias[axis].values.edit().push_back(drift);
        if (number > 0) drift_sums_[axis] += drift;
      }
      rest.values.edit().push_back(number > 0 ? 1.0 : 0.0);
      position.values.edit().push_back(static_cast<double>(number));
      if (number > 0) rested_ += 1.0;
    }
    append(result.recording, read);
    append(result.truth_series, force);
    append(result.truth_series, bias);
    result.truth_series.channels.push_back(std::move(rest));
    result.truth_series.channels.push_back(std::move(position));
  }

  void add_table(std::size_t samples, ProcedureResult& result) const {
    Channel commanded{"angle", unit("deg"), {}}, plane{"plane", {}, {}},
        mount{"mount", unit("deg"), {}}, angle{"angle", unit("rad"), {}};
    for (std::size_t k = 0; k < samples; ++k) {
      const double t_s = static_cast<double>(k) / options_.rate_hz;
      const PlannedPose& aim = motion_.aimed_at(t_s);
      const double shown_rad = options_.table.angle_follows
                                   ? motion_.moving_rad(&PlannedPose::commanded_rad, t_s)
                                   : aim.commanded_rad;
      commanded.values.edit().push_back(shown_rad / rad_per_deg);
      plane.values.edit().push_back(aim.plane);
      mount.values.edit().push_back(aim.mount_rad / rad_per_deg);
      angle.values.edit().push_back(motion_.moving_rad(&PlannedPose::angle_rad, t_s));
    }
    const ProcedureTable& table = options_.table;
    std::vector<Channel>& recorded = result.recording.channels;
    if (table.angle_recorded) recorded.push_back(std::move(commanded));
    if (table.planes > table.first_plane) recorded.push_back(std::move(plane));
    if (table.remounted) recorded.push_back(std::move(mount));
    result.truth_series.channels.push_back(std::move(angle));
  }

  void describe(ProcedureTruth& truth) const {
    truth.equations = sensor_.recorded_equations();
    truth.sensor = sensor_.model();
    for (std::size_t axis = 0; axis < 3; ++axis)
      truth.mean_drift_mps2[axis] = rested_ > 0.0 ? drift_sums_[axis] / rested_ : 0.0;
  }

 private:
  static void append(Recording& recording, std::vector<Channel>& channels) {
    std::ranges::move(channels, std::back_inserter(recording.channels));
  }

  const ProcedureOptions& options_;
  SensorErrorModel sensor_;
  PoseMotion motion_;
  std::array<BenchDrift, 3> drifts_;
  std::array<Random, 3> white_;
  Axes drift_sums_{};
  double rested_ = 0.0;
};

/// The axis that points upwards or downwards: "x_up"; the number for other positions.
std::string label_of(const ProcedureOptions& options, const TruePose& pose) {
  if (options.procedure == Procedure::multi_position)
    return "position_" + std::to_string(pose.number);
  if (options.procedure == Procedure::slide) return "rest_" + std::to_string(pose.number);
  Eigen::Index axis = 0;
  pose.force_mps2.cwiseAbs().maxCoeff(&axis);
  if (options.procedure == Procedure::six_position || options.procedure == Procedure::four_position)
    return std::string(1, "xyz"[axis]) + (pose.force_mps2(axis) > 0.0 ? "_up" : "_down");
  return "angle_" + std::to_string(std::lround(pose.commanded_rad / rad_per_deg));
}

/// Labels the rests in the recording, as a user who takes notes would.
void label(const ProcedureOptions& options, ProcedureResult& result) {
  const double last = static_cast<double>(result.recording.samples() - 1);
  for (const TruePose& pose : result.truth.poses)
    result.recording.labels.push_back(
        {label_of(options, pose),
         static_cast<std::size_t>(std::ceil(pose.start_s * options.rate_hz)),
         static_cast<std::size_t>(std::min(last, std::ceil(pose.end_s * options.rate_hz) - 1.0))});
  result.recording.label_channel = "label";
}

void record_poses(const ProcedureOptions& options,
                  const std::vector<PlannedPose>& plan,
                  std::size_t samples,
                  ProcedureResult& result,
                  const Progress& progress) {
  Series series(options, plan);
  series.run(samples, result, progress);
  if (is_on_table(options.procedure)) series.add_table(samples, result);
  series.describe(result.truth);
}

}  // namespace

std::string_view name_of(Procedure procedure) {
  for (const auto& [value, name] : names)
    if (value == procedure) return name;
  return {};
}

std::optional<Procedure> procedure_named(std::string_view name) {
  for (const auto& [value, known] : names)
    if (known == name) return value;
  return std::nullopt;
}

ProcedureOptions default_options(Procedure procedure) {
  ProcedureOptions o;
  o.procedure = procedure;
  switch (procedure) {
    case Procedure::four_position:
      o.table.positions = 4;
      o.table.closing = false;
      o.timing.dwell_s = 10.0;
      [[fallthrough]];
    case Procedure::tumble:
      o.timing.settle_mps2 = 0.05;
      break;
    case Procedure::six_position:
      o.timing.dwell_s = 10.0;
      o.hand.initial_rest_s = 0.0;
      o.hand.placement_std_rad = 0.5 * rad_per_deg;
      [[fallthrough]];
    case Procedure::multi_position:
      o.timing.dwell_jitter = 0.2;
      o.timing.move_jitter = 0.3;
      break;
    case Procedure::slide:
      o.timing = {.dwell_s = 2.0,
                  .move_s = 1.0,
                  .dwell_jitter = 0.2,
                  .move_jitter = 0.1,
                  .settle_s = 0.0,
                  .settle_mps2 = 0.0};
      break;
  }
  return o;
}

Result<ProcedureResult> simulate_procedure(const ProcedureOptions& options,
                                           const Progress& progress) {
  if (const Status checked = check(options); !checked) return checked.error();
  const std::vector<PlannedPose> plan = plan_poses(options);
  const auto samples = static_cast<std::size_t>(plan.back().end_s * options.rate_hz);
  ProcedureResult result{empty_recording(options, ""), empty_recording(options, ", truth"), {}};
  if (options.procedure == Procedure::slide)
    record_slide(options, samples, result, progress);
  else
    record_poses(options, plan, samples, result, progress);
  if (options.supply.recorded)
    result.recording.channels.push_back(
        {"supply", unit("V"),
         std::vector<double>(samples, converted_v(options.supply.actual_v, options.daq))});
  result.truth.poses = true_poses(plan);
  if (options.labelled) label(options, result);
  if (progress) progress("simulating", 1.0);
  return result;
}

}  // namespace proofmass::simulate
