#include "proofmass/estimate/wheel.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "proofmass/core/statistics.hpp"
#include "proofmass/estimate/wheel_clock.hpp"
#include "proofmass/estimate/wheel_findings.hpp"
#include "proofmass/estimate/wheel_fit.hpp"
#include "proofmass/estimate/wheel_plain.hpp"
#include "proofmass/estimate/wheel_plane.hpp"

namespace proofmass::estimate {
namespace {

/// Above this share of unexplained readings there is no wheel turning in gravity to be seen.
constexpr double not_a_wheel = 0.5;
/// Rows of two sensors this close share one instant: 50 rad/s move the phase by 0.25 mrad
/// meanwhile.
constexpr double same_instant_s = 5e-6;

Status check(const std::vector<WheelSensor>& sensors, const WheelOptions& options) {
  if (sensors.empty() || sensors.size() > 2)
    return Error{Errc::invalid_argument,
                 "a wheel takes one or two sensors, not " + std::to_string(sensors.size())};
  for (const WheelSensor& sensor : sensors)
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (sensor.accel_mps2[axis].size() != sensor.time_s.size() &&
          !(axis == 2 && sensor.accel_mps2[axis].empty()))
        return Error{Errc::invalid_argument, sensor.name + ": channels of different lengths"};
  const bool positive = options.gravity_mps2 > 0.0 && options.radius_m.value_or(0.0) >= 0.0 &&
                        options.rim_radius_m.value_or(1.0) > 0.0 &&
                        options.rolling_radius_m.value_or(1.0) > 0.0 &&
                        options.alignment_std_rad >= 0.0;
  if (!positive)
    return Error{Errc::invalid_argument,
                 "gravity and radii must be positive (the sensor's may be 0)"};
  return Done{};
}

/// A sensor made ready for the filter.
struct Prepared {
  Screened screened;
  WheelPlane plane;
};

/// The time line of one or two sensors; the second's stamps are late by offset_s.
WheelReadings merge(const std::vector<const WheelSensor*>& sensors,
                    const std::vector<const Prepared*>& prepared,
                    double offset_s,
                    const WheelOptions& options) {
  WheelReadings readings;
  double level2 = options.gravity_mps2 * options.gravity_mps2;
  const double axial = prepared.front()->plane.axial_mps2;
  readings.gravity_mps2 = std::sqrt(std::max(level2 - axial * axial, 0.01 * level2));
  readings.rolling_radius_m = options.rolling_radius_m.value_or(0.0);
  for (std::size_t s = 0; s < sensors.size(); ++s)
    readings.sensors.push_back(project(*sensors[s], prepared[s]->screened, prepared[s]->plane));
  std::array<std::size_t, 2> next{};
  const auto skip_unusable = [&](std::size_t s) {
    while (next[s] < sensors[s]->time_s.size() && !prepared[s]->screened.usable[next[s]]) ++next[s];
    return next[s] < sensors[s]->time_s.size();
  };
  const auto time_of = [&](std::size_t s) {
    return sensors[s]->time_s[next[s]] - (s == 0 ? 0.0 : offset_s);
  };
  for (;;) {
    std::array<bool, 2> has{};
    for (std::size_t s = 0; s < sensors.size(); ++s) has[s] = skip_unusable(s);
    if (!has[0] && !has[1]) return readings;
    const double t = has[0] && has[1] ? std::min(time_of(0), time_of(1)) : time_of(has[0] ? 0 : 1);
    WheelInstant instant;
    instant.dt_s = readings.time_s.empty() ? 0.0 : t - readings.time_s.back();
    for (std::size_t s = 0; s < sensors.size(); ++s)
      if (has[s] && time_of(s) - t < same_instant_s)
        instant.row[s] = static_cast<std::int64_t>(next[s]++);
    readings.time_s.push_back(t);
    readings.instants.push_back(instant);
  }
}

/// What is believed of the places: nothing but their size, or the radius that was given, outward
/// along the direction that the recording shows, else along u.
PlacesPrior places_prior(const WheelOptions& options, const Eigen::VectorXd& seen) {
  PlacesPrior prior{Eigen::VectorXd::Zero(seen.size())};
  if (!options.radius_m) return prior;
  prior.std_m = std::max(0.02 * *options.radius_m, 2e-4);
  for (Eigen::Index s = 0; s < seen.size(); s += 2) {
    const Eigen::Vector2d direction = seen.segment<2>(s);
    prior.mean.segment<2>(s) = direction.norm() > std::max(0.3 * *options.radius_m, 1e-6)
                                   ? Eigen::Vector2d(direction.normalized() * *options.radius_m)
                                   : Eigen::Vector2d(*options.radius_m, 0.0);
  }
  return prior;
}

Eigen::VectorXd places_in(const WheelFit& fit, std::size_t sensors) {
  return fit.constants.tail(static_cast<Eigen::Index>(2 * sensors));
}

Uncertain radius_in(const WheelFit& fit, std::size_t sensors, std::size_t sensor) {
  const auto at = fit.constants.size() - static_cast<Eigen::Index>(2 * (sensors - sensor));
  const Eigen::Vector2d place = fit.constants.segment<2>(at);
  const Eigen::Vector2d outward = place / std::max(place.norm(), 1e-9);
  return {place.norm(), std::sqrt(outward.dot(fit.constants_cov.block<2, 2>(at, at) * outward))};
}

/// Fits once without the radius and, where one is given, again with it.
WheelFit fit_with_radius(WheelReadings& readings,
                         const WheelTrack& track,
                         const WheelOptions& options) {
  const std::size_t sensors = readings.sensors.size();
  const auto count = static_cast<Eigen::Index>(2 * sensors);
  WheelFit free =
      fit_wheel(readings, track, PlacesPrior{Eigen::VectorXd::Zero(count)}, options.progress);
  if (!options.radius_m) return free;
  WheelFit held = fit_wheel(readings, free.track, places_prior(options, places_in(free, sensors)),
                            options.progress);
  for (std::size_t s = 0; s < sensors; ++s)
    held.free_radius_m.push_back(radius_in(free, sensors, s));
  return held;
}

struct Single {
  Prepared prepared;
  WheelReadings readings;
  WheelFit fit;
};

Result<Single> fit_single(const WheelSensor& sensor,
                          Prepared prepared,
                          const WheelOptions& options) {
  Single single{std::move(prepared), {}, {}};
  single.readings = merge({&sensor}, {&single.prepared}, 0.0, options);
  if (single.readings.instants.size() < 10)
    return Error{Errc::too_few_samples, sensor.name + ": fewer than 10 usable rows"};
  if (options.progress) options.progress("looking for the wheel's phase", 0.0);
  const WheelTrack track = find_track(single.readings);
  if (track.lost > not_a_wheel)
    return Error{Errc::not_observable,
                 sensor.name +
                     ": no gravity turning in the plane of the wheel (axle upright, "
                     "readings not in m/s^2, or not a wheel); check --unit and --spin-axis"};
  single.fit = fit_with_radius(single.readings, track, options);
  return single;
}

Result<Single> fit_single(const WheelSensor& sensor, const WheelOptions& options) {
  Prepared prepared{screen_rows(sensor), {}};
  const auto plane = find_plane(sensor, prepared.screened, options.spin_axis);
  if (!plane) return plane.error();
  prepared.plane = *plane;
  return fit_single(sensor, std::move(prepared), options);
}

/// The single fits of a pair, the second seen from the side from which both turn the same way.
struct Pair {
  std::vector<Single> singles;
  ClockFit clocks;
};

WheelMotion motion_of(const WheelFit& fit) {
  return {&fit.series.time_s, &fit.series.angle_rad, &fit.series.speed_radps};
}

Result<Pair> fit_singles(const std::vector<WheelSensor>& sensors, const WheelOptions& options) {
  Pair pair;
  for (const WheelSensor& sensor : sensors) {
    auto single = fit_single(sensor, options);
    if (!single) return single.error();
    pair.singles.push_back(std::move(single).value());
  }
  if (pair.singles.size() == 1) return pair;
  const double way = pair.singles[0].fit.turns.value * pair.singles[1].fit.turns.value;
  if (way < 0.0 && !options.spin_axis) {
    Prepared other = pair.singles[1].prepared;
    other.plane = turned_over(other.plane);
    auto again = fit_single(sensors[1], std::move(other), options);
    if (!again) return again.error();
    pair.singles[1] = std::move(again).value();
  }
  const auto clocks = fit_clocks(motion_of(pair.singles[0].fit), motion_of(pair.singles[1].fit),
                                 options.clocks_shared);
  if (!clocks) return clocks.error().at("two sensors");
  pair.clocks = *clocks;
  // On one clock an offset has to show clearly before the stamps are called wrong.
  if (options.clocks_shared &&
      std::abs(pair.clocks.offset_s.value) < std::max(5.0 * pair.clocks.offset_s.std, 2e-4))
    pair.clocks.offset_s.value = 0.0;
  return pair;
}

/// Both sensors in one filter, started from what each alone found.
struct Joint {
  WheelReadings readings;
  WheelFit fit;
};

Joint fit_jointly(const std::vector<WheelSensor>& sensors,
                  const Pair& pair,
                  const WheelOptions& options) {
  const Single &one = pair.singles[0], &two = pair.singles[1];
  Joint joint;
  joint.readings = merge({&sensors[0], &sensors[1]}, {&one.prepared, &two.prepared},
                         pair.clocks.offset_s.value, options);
  joint.readings.phase_rad = pair.clocks.phase_rad;
  for (std::size_t s = 0; s < 2; ++s)
    joint.readings.sensors[s].variance_m2ps4 = pair.singles[s].readings.sensors[0].variance_m2ps4;
  WheelTrack track = one.fit.track;
  track.path.moving.clear();
  const auto& times = one.fit.series.time_s;
  std::size_t at = 0;
  for (const double t : joint.readings.time_s) {
    while (at + 1 < times.size() && times[at + 1] <= t) ++at;
    Mat<wheel::moving> moving = one.fit.track.path.moving[at];
    const double dt = t - times[at];
    moving(wheel::angle) += dt * moving(wheel::speed);
    track.path.moving.push_back(moving);
  }
  const Eigen::VectorXd &first = one.fit.track.path.standing, &second = two.fit.track.path.standing;
  track.path.standing.resize(wheel::standing(2));
  track.path.standing << first.head<5>(), second.head<5>(), 0.0, first.tail<2>(), second.tail<2>();
  track.beginning.angle_rad = track.path.moving.front()(wheel::angle);
  joint.fit = fit_with_radius(joint.readings, track, options);
  return joint;
}

/// Path along the circle in radians: every way there and back counts, the noise at rest does not. A
/// turning point is one that the angle has left by four standard deviations and a thousandth.
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
  if (options.rim_radius_m || options.rolling_radius_m) {
    radius = Uncertain{options.rim_radius_m.value_or(options.rolling_radius_m.value_or(0.0)), 0.0};
    solution.distance_of = "rim";
  } else {
    radius = solution.sensors.front().radius_m;
    solution.distance_of = solution.sensors.front().name;
  }
  if (!radius) {
    solution.notes.push_back({Severity::warning,
                              "distance_m: neither a rim radius was given (--rim-radius) nor can "
                              "the sensor's own be told from this recording"});
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
  solution.atan2.note = "readings as they are: bias and centripetal force stay in";
  const bool radii_known = std::ranges::all_of(
      solution.sensors, [](const WheelSensorFit& s) { return s.radius_m.has_value(); });
  if (radii_known)
    series.double_integral_angle_rad =
        double_integral_angle(readings, places_in(fit, readings.sensors.size()),
                              series.angle_rad.front(), series.speed_radps.front());
  if (series.double_integral_angle_rad.empty()) {
    solution.double_integration.note =
        "needs the radius of every sensor, which this recording does not show: give --radius";
    return;
  }
  solution.double_integration.turns = Uncertain{
      (series.double_integral_angle_rad.back() - series.double_integral_angle_rad.front()) /
          rad_per_turn,
      0.0};
  solution.double_integration.note =
      "starts from the smoother's first angle and speed; an error of b m/s^2 grows as b t^2 / (2 "
      "r)";
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
  fit.unusable = single.prepared.screened.unusable;
  std::vector<double> variance;
  for (std::size_t row = 0; row < sensor.time_s.size(); ++row)
    if (single.prepared.screened.usable[row])
      variance.push_back(single.readings.sensors.front().variance_m2ps4[row]);
  fit.noise_mps2 = std::sqrt(*quantile(variance, 0.05));
  solution.rejected_samples += fit.unusable;
  for (Stretch stretch : single.prepared.screened.rejected) {
    stretch.reason = sensor.name + ": " + stretch.reason;
    solution.rejected.push_back(std::move(stretch));
  }
  if (single.prepared.plane.assumed)
    solution.notes.push_back(
        {Severity::warning, sensor.name +
                                ": the wheel hardly turned, so its axle cannot be found; "
                                "took the most level of the sensor's axes (--spin-axis)"});
}

/// Instants at which the gate shut out every channel there was, in stretches.
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

void judge_turns(const WheelFit& fit, WheelSolution& solution) {
  if (fit.widest_prediction_rad < 0.8) return;
  solution.turns.reset();
  solution.smoother.turns.reset();
  solution.smoother.note = "the angle was lost in between";
  solution.notes.push_back(
      {Severity::bad,
       "turns: readings are missing or spoilt for so long that the angle is unknown by "
       "more than 45 degrees in between: a turn more or less cannot be told"});
}

/// A wheel that shakes more when it turns is most likely under a vehicle, whose speeding up leans
/// on the apparent gravity.
void note_travel(const WheelReadings& readings,
                 const WheelOptions& options,
                 WheelSolution& solution) {
  const auto& variance = readings.sensors.front().variance_m2ps4;
  const auto loud = quantile(variance, 0.9), quiet = quantile(variance, 0.05);
  if (options.rolling_radius_m || !loud || *loud < 9.0 * *quiet) return;
  double strongest = 0.0;
  for (const double accel : solution.series.accel_radps2)
    strongest = std::max(strongest, std::abs(accel));
  const double lean_deg = 0.3 * strongest / options.gravity_mps2 / rad_per_deg;
  solution.notes.push_back({Severity::info,
                            "the wheel shakes as if it carried a vehicle: while that speeds up or "
                            "brakes, the angle leans by "
                            "rolling radius x acceleration / g, at most " +
                                std::to_string(static_cast<int>(std::ceil(lean_deg))) +
                                " degrees here for 0.3 m, and comes back; --rolling-radius takes "
                                "it out. The turns between "
                                "two rests do not change"});
}

void check_radius(const WheelFit& fit, const WheelOptions& options, WheelSolution& solution) {
  for (std::size_t s = 0; s < fit.free_radius_m.size(); ++s) {
    const Uncertain& found = fit.free_radius_m[s];
    const double off = std::abs(found.value - *options.radius_m);
    if (off < 5.0 * std::hypot(found.std, 0.02 * *options.radius_m)) continue;
    solution.notes.push_back(
        {Severity::bad, solution.sensors[s].name +
                            ": --radius contradicts the recording, which says " +
                            std::to_string(std::lround(found.value * 1e3)) + " mm +- " +
                            std::to_string(std::lround(std::ceil(found.std * 1e3))) +
                            " mm: leave it out or mend it"});
  }
}

WheelSolution conclude(const WheelReadings& readings,
                       WheelFit fit,
                       const WheelOptions& options,
                       WheelSolution solution) {
  describe_sensors(fit, readings.phase_rad, solution.sensors);
  solution.series = std::move(fit.series);
  solution.turns = fit.turns;
  for (std::vector<double>* std :
       {&solution.series.angle_std_rad, &solution.series.filtered_angle_std_rad})
    for (double& value : *std) value = std::hypot(value, options.alignment_std_rad);
  solution.angle_final_rad =
      Uncertain{solution.series.angle_rad.back(), solution.series.angle_std_rad.back()};
  add_methods(readings, fit, solution);
  add_distance(options, solution);
  add_peak_speed(solution);
  solution.consistency = std::move(fit.consistency);
  for (std::size_t i = 0; i < solution.consistency.channels.size(); ++i)
    solution.consistency.channels[i].name =
        solution.sensors[i / 2].name + (i % 2 == 0 ? " along u" : " along v");
  solution.not_observable = say_not_observable(fit, solution.sensors);
  add_gated(solution);
  note_travel(readings, options, solution);
  check_radius(fit, options, solution);
  judge_turns(fit, solution);
  return solution;
}

}  // namespace

Result<WheelSolution> estimate_wheel(const std::vector<WheelSensor>& sensors,
                                     const WheelOptions& options) {
  if (const Status status = check(sensors, options); !status) return status.error();
  auto pair = fit_singles(sensors, options);
  if (!pair) return pair.error();
  WheelSolution solution;
  for (std::size_t s = 0; s < sensors.size(); ++s)
    add_sensor(sensors[s], pair->singles[s], options.spin_axis.has_value(), solution);
  if (sensors.size() == 1)
    return conclude(pair->singles[0].readings, pair->singles[0].fit, options, std::move(solution));
  if (pair->clocks.offset_s.value != 0.0)
    solution.sensors[1].clock_offset_s = pair->clocks.offset_s;
  Joint joint = fit_jointly(sensors, *pair, options);
  return conclude(joint.readings, std::move(joint.fit), options, std::move(solution));
}

}  // namespace proofmass::estimate
