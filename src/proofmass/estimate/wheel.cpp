#include "proofmass/estimate/wheel.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "proofmass/core/statistics.hpp"
#include "proofmass/estimate/unmeasured.hpp"
#include "proofmass/estimate/wheel/baseline_methods.hpp"
#include "proofmass/estimate/wheel/findings.hpp"
#include "proofmass/estimate/wheel/joint_fit.hpp"
#include "proofmass/estimate/wheel/plane.hpp"

namespace proofmass::estimate {
namespace {

// Without a gyroscope's rates or an encoder, which counts on, the wheel may have turned any number
// of times in a long gap.
Status check_gaps(const std::vector<WheelSensor>& sensors, const WheelOptions& options) {
  constexpr double longest_s = 60.0;
  if (options.encoder) return Done{};
  std::optional<UnmeasuredInterval> gap;
  for (const WheelSensor& sensor : sensors) {
    gap = unmeasured_interval(sensor.time_s, sensor.accel_mps2[0], longest_s);
    if (gap && !sensor.rate_radps[0].empty())
      gap = unmeasured_interval(sensor.time_s, sensor.rate_radps[0], longest_s);
    if (!gap) return Done{};
  }
  std::array<char, 200> words{};
  std::snprintf(
      words.data(), words.size(),
      "no measurements from %.1f to %.1f s: the wheel may have turned any number of times "
      "in this gap, or the clock was set; analyse the parts before and after it",
      gap->from_s, gap->to_s);
  return Error{Errc::not_observable, words.data(), {Advice{"from"}, Advice{"to"}}};
}

Status check(const std::vector<WheelSensor>& sensors, const WheelOptions& options) {
  for (const WheelSensor& sensor : sensors)
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (sensor.accel_mps2[axis].size() != sensor.time_s.size() &&
          !(axis == 2 && sensor.accel_mps2[axis].empty()))
        return Error{Errc::invalid_argument, sensor.name + ": channels of different lengths"};
  for (const WheelSensor& sensor : sensors)
    for (const auto& axis : sensor.rate_radps)
      if (axis.size() != sensor.rate_radps[0].size() ||
          (!axis.empty() && axis.size() != sensor.time_s.size()))
        return Error{Errc::invalid_argument,
                     sensor.name + ": the gyroscope's channels are of other lengths"};
  if (Status valid = check_wheel(sensors.size(), options); !valid) return valid;
  return check_gaps(sensors, options);
}

/// Path along the circle in radians: every reversal counts, the noise at rest does not. A turning
/// point is one from which the angle has departed by four standard deviations and a thousandth.
double angular_path_rad(const WheelSeries& series) {
  double path = 0.0, turned_at = series.angle_rad.front(), furthest = turned_at;
  double way = 0.0;  // +1, −1; 0 while none is clear
  for (std::size_t k = 0; k < series.angle_rad.size(); ++k) {
    const double angle = series.angle_rad[k];
    const double clear = 4.0 * series.angle_std_rad[k] + 1e-3;
    if (way == 0.0) {
      if (std::abs(angle - turned_at) > clear) way = angle > turned_at ? 1.0 : -1.0;
      furthest = angle;
    } else if (way * (angle - furthest) > 0.0) {
      furthest = angle;
    } else if (way * (furthest - angle) > clear) {
      path += std::abs(furthest - turned_at);
      turned_at = furthest;
      furthest = angle;
      way = -way;
    }
  }
  return way == 0.0 ? 0.0 : path + std::abs(furthest - turned_at);
}

void add_distance(const WheelOptions& options, WheelSolution& solution) {
  const double path_rad = angular_path_rad(solution.series);
  const double path_std_rad = solution.turns->std * rad_per_turn;
  std::optional<Uncertain> radius;
  const double rim_m = options.rim_radius_m.value_or(options.rolling_radius_m.value_or(0.0));
  if (rim_m > 0.0) {
    radius = Uncertain{rim_m, 0.0};
    solution.distance_of = "rim";
  } else if (solution.rolling_radius_m) {
    radius = solution.rolling_radius_m;
    solution.distance_of = "rim";
  } else {
    radius = solution.sensors.front().radius_m;
    solution.distance_of = solution.sensors.front().name;
  }
  if (!radius) {
    solution.notes.push_back({Severity::warning,
                              "no distance: no rim radius was given, and the recording does not "
                              "determine the sensor's own",
                              {Advice{"rim-radius"}}});
    return;
  }
  solution.distance_m = Uncertain{path_rad * radius->value,
                                  std::hypot(path_rad * radius->std, path_std_rad * radius->value)};
}

void add_peak_speed(WheelSolution& solution) {
  const WheelSeries& series = solution.series;
  std::size_t at = 0;
  for (std::size_t k = 1; k < series.speed_radps.size(); ++k)
    if (std::abs(series.speed_radps[k]) > std::abs(series.speed_radps[at])) at = k;
  solution.peak_speed_radps =
      Uncertain{std::abs(series.speed_radps[at]), series.speed_std_radps[at]};
}

void add_methods(const WheelReadings& readings, const WheelFit& fit, WheelSolution& solution) {
  WheelSeries& series = solution.series;
  solution.smoother.turns = fit.turns;
  solution.ekf.turns = Uncertain{fit.ekf_turns, fit.turns.std};
  const double filter_start_std = series.filtered_angle_std_rad.front() / rad_per_turn;
  solution.ekf.turns->std = std::hypot(fit.turns.std, filter_start_std);
  solution.ekf.note =
      "calibrated by the whole recording; counts from its first guess of the angle, from one "
      "reading";
  series.atan2_angle_rad = atan2_angle(readings);
  const auto first =
      std::ranges::find_if(series.atan2_angle_rad, [](double angle) { return !std::isnan(angle); });
  if (first != series.atan2_angle_rad.end())
    solution.atan2.turns = Uncertain{(series.atan2_angle_rad.back() - *first) / rad_per_turn, 0.0};
  solution.atan2.note = "raw measurements: includes bias and centripetal acceleration";
  const auto plain = plain_places(solution.sensors, readings.phase_rad);
  if (plain)
    series.double_integral_angle_rad = double_integral_angle(
        readings, plain->places_m, series.angle_rad.front(), series.speed_radps.front());
  if (series.double_integral_angle_rad.empty()) {
    solution.double_integration.note =
        "needs the radius of every sensor, which this recording does not determine: state it";
    return;
  }
  solution.double_integration.turns = Uncertain{
      (series.double_integral_angle_rad.back() - series.double_integral_angle_rad.front()) /
          rad_per_turn,
      0.0};
  solution.double_integration.note =
      "starts from the smoother's first angle and speed; an error of b m/s² grows as b t² / (2 "
      "r)";
  if (plain->taken)
    solution.double_integration.note += "; the sensors' first axes are assumed radial";
}

void note_gyroscope(const PlanarReadings& readings, WheelSensorFit& fit, WheelSolution& solution) {
  fit.has_gyro = !readings.speed_radps.empty();
  if (readings.constant_gyroscope)
    solution.notes.push_back(
        {Severity::warning, fit.name + ": the gyroscope's output is constant, and is not used"});
}

void add_sensor(const WheelSensor& sensor,
                const Single& single,
                bool axis_given,
                WheelSolution& solution) {
  WheelSensorFit& fit = solution.sensors.emplace_back();
  fit.name = sensor.name;
  fit.spin_axis = single.prepared.plane.axis;
  fit.spin_axis_given = axis_given;
  fit.samples = sensor.time_s.size();
  note_gyroscope(single.readings.sensors.front(), fit, solution);
  fit.unusable = single.prepared.screened.unusable;
  solution.rejected_samples += fit.unusable;
  for (Stretch stretch : single.prepared.screened.rejected) {
    stretch.reason = sensor.name + ": " + stretch.reason;
    solution.rejected.push_back(std::move(stretch));
  }
  if (single.prepared.plane.assumed)
    solution.notes.push_back({Severity::warning,
                              sensor.name +
                                  ": the wheel hardly turned, so its axle cannot be found; "
                                  "the most level of the sensor's axes is assumed",
                              {Advice{"spin-axis"}}});
}

void add_encoder(const EncoderTrack& along, WheelSolution& solution) {
  solution.encoder.emplace();
  solution.encoder->name = along.encoder.name;
  solution.encoder->missed = along.missed;
  if (along.missed.empty()) return;
  char first[32];
  std::snprintf(first, sizeof first, "%.1f", along.missed.front().time_s);
  const std::string times =
      along.missed.size() == 1 ? "" : std::to_string(along.missed.size()) + " times, first ";
  solution.notes.push_back({Severity::warning, along.encoder.name + ": counts were missed " +
                                                   times + "at " + first +
                                                   " s, as gravity shows; they are added again"});
}

/// Epochs at which the gate rejected every available channel, as intervals.
void add_gated(WheelSolution& solution) {
  const WheelSeries& series = solution.series;
  bool open = false;
  for (std::size_t k = 0; k < series.time_s.size(); ++k) {
    const bool gated = series.channels_gated[k] > 0;
    if (gated && !open)
      solution.rejected.push_back(
          {series.time_s[k], series.time_s[k], 0, "innovation beyond the gate"});
    if (gated) {
      solution.rejected.back().end_s = series.time_s[k];
      ++solution.rejected.back().rows;
      ++solution.rejected_samples;
    }
    open = gated;
  }
}

/// "from 12.3 to 14.1 s and from …"
std::string stretches_of(const WheelFit& fit) {
  std::string text;
  const auto seconds = [&](std::size_t k) {
    const double time_s = fit.series.time_s[k];
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, "%.1f", time_s);
    return std::string(buffer);
  };
  constexpr std::size_t most = 3;
  for (std::size_t i = 0; i < std::min(fit.doubts.size(), most); ++i)
    text += (i == 0 ? "from " : ", from ") +
            seconds(std::max<std::size_t>(fit.doubts[i].first, 1) - 1) + " to " +
            seconds(fit.doubts[i].last) + " s";
  if (fit.doubts.size() > most)
    text += " and " + std::to_string(fit.doubts.size() - most) + " times more";
  return text;
}

void judge_turns(const WheelFit& fit, const std::string& where, WheelSolution& solution) {
  if (fit.doubts.empty()) return;
  solution.turns.reset();
  solution.turns_candidates = fit.turns_candidates;
  solution.angle_final_rad.reset();
  solution.distance_m.reset();
  solution.peak_speed_radps.reset();
  solution.rolling_radius_m.reset();
  for (WheelSensorFit& sensor : solution.sensors) {
    sensor.radius_m = fit.given_radius_m;
    for (auto* figure : {&sensor.mounting_rad, &sensor.skew_rad, &sensor.phase_rad,
                         &sensor.gyro_scale, &sensor.gyro_bias_radps})
      figure->reset();
    for (auto* pair : {&sensor.bias_mps2, &sensor.scale}) pair->fill(std::nullopt);
  }
  solution.smoother.turns.reset();
  solution.smoother.note = "the angle was lost " + where;
  solution.notes.push_back(
      {Severity::bad,
       "turns: measurements are missing, corrupt or too disturbed to show gravity " + where +
           ", for so long that the angle is uncertain by more than 45 degrees: the number of turns "
           "is ambiguous"});
}

/// The rolling radius that the results are for; with a gyroscope as estimated.
Uncertain rolling_radius_of(const WheelReadings& readings, const WheelFit& fit) {
  const auto has_gyro = [](const PlanarReadings& sensor) { return !sensor.speed_radps.empty(); };
  if (std::ranges::none_of(readings.sensors, has_gyro)) return readings.rolling_radius_m;
  const auto count = static_cast<int>(readings.sensors.size());
  const Eigen::Index at = wheel::rolling(count) - wheel::first_of(0);
  return {readings.rolling_radius_m.value + fit.constants(at),
          std::sqrt(fit.constants_cov(at, at))};
}

/// The rolling radius, if the recording shows that the wheel rolls and how.
std::optional<Uncertain> estimated_rolling_radius(const WheelReadings& readings,
                                                  const WheelFit& fit) {
  constexpr double significant = 3.0;
  if (readings.given_rolling_radius_m) return std::nullopt;
  if (readings.found_rolling_radius_m) return readings.rolling_radius_m;
  const Uncertain estimated = rolling_radius_of(readings, fit);
  if (!(estimated.value > significant * estimated.std)) return std::nullopt;
  return estimated;
}

/// A wheel that vibrates is most likely on a vehicle, whose acceleration tilts the apparent
/// gravity.
void note_travel(const WheelReadings& readings, const WheelFit& fit, WheelSolution& solution) {
  if (readings.given_rolling_radius_m || !readings.shakes) return;
  double strongest = 0.0;
  for (const double accel : solution.series.accel_radps2)
    strongest = std::max(strongest, std::abs(accel));
  const Uncertain rolling = rolling_radius_of(readings, fit);
  const double lean_deg = rolling.std * strongest / readings.gravity_mps2 / rad_per_deg;
  solution.notes.push_back(
      {Severity::info,
       "the wheel vibrates like a vehicle's, whose acceleration and braking tilt the "
       "apparent gravity by rolling radius x angular acceleration / g: the rolling radius is " +
           std::string(solution.rolling_radius_m ? "estimated" : "assumed") + " as " +
           std::to_string(std::lround(rolling.value * 1e3)) + " mm ± " +
           std::to_string(std::lround(rolling.std * 1e3)) +
           " mm, which makes the angle uncertain by up to " +
           std::to_string(static_cast<int>(std::ceil(lean_deg))) +
           " degrees during acceleration; the rolling radius reduces this (0 for a bench)",
       {Advice{"rolling-radius"}}});
}

/// Errors: invalid_argument (a radius so far from the recording's that its unit must be wrong).
Status check_radius(const WheelFit& fit, const WheelOptions& options, WheelSolution& solution) {
  constexpr double another_unit = 20.0;
  for (std::size_t s = 0; s < fit.free_radius_m.size(); ++s) {
    const Uncertain& found = fit.free_radius_m[s];
    const double off = std::abs(found.value - *options.radius_m);
    const double given_std = radius_std_m(options);
    if (off < 4.0 * std::hypot(found.std, given_std)) continue;
    const auto in_mm = [](double value_m) {
      return std::to_string(std::lround(std::ceil(value_m * 1e3)));
    };
    const std::string text = solution.sensors[s].name + ": the given radius of " +
                             std::to_string(std::lround(*options.radius_m * 1e3)) + " mm ± " +
                             in_mm(given_std) + " mm contradicts the recording's " +
                             std::to_string(std::lround(found.value * 1e3)) + " mm ± " +
                             in_mm(found.std) + " mm: ";
    if (*options.radius_m > another_unit * (std::abs(found.value) + 4.0 * found.std))
      return Error{Errc::invalid_argument, text + "it is expected in metres, 0.1 for 100 mm"};
    solution.notes.push_back({Severity::bad, text + "omit or correct it"});
  }
  return Done{};
}

/// Per sample and axis, at rest or in the quietest part.
double noise_mps2(const WheelReadings& readings, std::size_t sensor) {
  std::vector<double> variance;
  for (const WheelEpoch& epoch : readings.epochs)
    if (const std::int64_t row = epoch.row[sensor]; row != WheelEpoch::no_row)
      variance.push_back(readings.sensors[sensor].variance_m2ps4[static_cast<std::size_t>(row)]);
  return std::sqrt(*quantile(variance, 0.05));
}

/// The time span of the first sensor's rows, usable or not.
struct RecordedSpan {
  double begin_s, end_s;
};

/// Turns before the first usable measurement and after the last are not counted; bad if the wheel
/// was turning there.
void note_ends(const RecordedSpan& recorded, WheelSolution& solution) {
  constexpr double least_s = 0.1;
  const std::vector<double>& time_s = solution.series.time_s;
  const auto note = [&](const char* which, double missing_s, const char* counted, std::size_t k) {
    if (missing_s < least_s) return;
    constexpr double clearly = 4.0;
    const bool turns =
        std::abs(solution.series.speed_radps[k]) > clearly * solution.series.speed_std_radps[k];
    char text[200];
    std::snprintf(text, sizeof text,
                  "the %s %.1f s have no usable measurements: turns and angles count %s %.1f s%s",
                  which, missing_s, counted, time_s[k],
                  turns ? ", when the wheel was turning" : "");
    solution.notes.push_back({turns ? Severity::bad : Severity::warning, text});
  };
  note("first", time_s.front() - recorded.begin_s, "from", 0);
  note("last", recorded.end_s - time_s.back(), "until", time_s.size() - 1);
}

Result<WheelSolution> conclude(const WheelReadings& readings,
                               WheelFit fit,
                               const WheelOptions& options,
                               const RecordedSpan& recorded,
                               WheelSolution solution) {
  describe_sensors(fit, readings.phase_rad, solution.sensors);
  for (std::size_t s = 0; s < solution.sensors.size(); ++s)
    solution.sensors[s].noise_mps2 = noise_mps2(readings, s);
  const std::string doubtful = stretches_of(fit);
  solution.series = std::move(fit.series);
  solution.turns = fit.turns;
  solution.delay_s = readings.delay_s;
  for (std::vector<double>* std :
       {&solution.series.angle_std_rad, &solution.series.filtered_angle_std_rad})
    for (double& value : *std) value = std::hypot(value, options.alignment_std_rad);
  solution.angle_final_rad =
      Uncertain{solution.series.angle_rad.back(), solution.series.angle_std_rad.back()};
  add_methods(readings, fit, solution);
  solution.rolling_radius_m = estimated_rolling_radius(readings, fit);
  add_distance(options, solution);
  add_peak_speed(solution);
  solution.consistency = std::move(fit.consistency);
  constexpr std::array names{" along u", " along v", " gyroscope"};
  auto& channels = solution.consistency.channels;
  std::size_t of_sensors = channels.size();
  if (readings.encoder) {
    describe_encoder(fit, *readings.encoder, solution.sensors.size(), *solution.encoder);
    channels[--of_sensors].name = solution.encoder->name;
  }
  const std::size_t each = of_sensors / solution.sensors.size();
  for (std::size_t i = 0; i < of_sensors; ++i)
    channels[i].name = solution.sensors[i / each].name + names[i % each];
  solution.not_observable = say_not_observable(fit, solution.sensors);
  add_gated(solution);
  note_travel(readings, fit, solution);
  if (const Status radius = check_radius(fit, options, solution); !radius) return radius.error();
  judge_turns(fit, doubtful, solution);
  note_ends(recorded, solution);
  return solution;
}

}  // namespace

Result<WheelSolution> estimate_wheel(std::vector<WheelSensor> sensors,
                                     const WheelOptions& options) {
  if (const Status status = check(sensors, options); !status) return status.error();
  auto pair = fit_singles(sensors, options);
  if (!pair) return pair.error();
  const RecordedSpan recorded{sensors.front().time_s.front(), sensors.front().time_s.back()};
  WheelSolution solution;
  if (const auto& along = pair->singles[0].encoder) add_encoder(*along, solution);
  for (std::size_t s = 0; s < sensors.size(); ++s)
    add_sensor(sensors[s], pair->singles[s], options.spin_axis.has_value(), solution);
  if (sensors.size() == 1)
    return conclude(pair->singles[0].readings, pair->singles[0].fit, options, recorded,
                    std::move(solution));
  if (pair->clocks.offset_s.value != 0.0)
    solution.sensors[1].clock_offset_s = pair->clocks.offset_s;
  Joint joint = fit_jointly(std::move(sensors), std::move(pair).value(), options);
  return conclude(joint.readings, std::move(joint.fit), options, recorded, std::move(solution));
}

}  // namespace proofmass::estimate
