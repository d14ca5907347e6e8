#include "proofmass/estimate/wheel/joint_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "proofmass/core/in_parallel.hpp"
#include "proofmass/core/linalg.hpp"
#include "proofmass/core/statistics.hpp"
#include "proofmass/estimate/wheel/doubts.hpp"
#include "proofmass/estimate/wheel/gyro_jerk.hpp"
#include "proofmass/estimate/wheel/rests.hpp"

namespace proofmass::estimate {
namespace {

/// Above this share of unexplained measurements no wheel rotating in gravity is visible.
constexpr double not_a_wheel = 0.5;
/// Rows of two sensors this close share one epoch: 50 rad/s move the phase by 0.25 mrad meanwhile.
constexpr double same_epoch_s = 5e-6;

/// A given pole is accurate to a tenth, as resistors and capacitors are. Otherwise it is
/// log-uniform between two corners.
Uncertain delay_of(const WheelOptions& options, double rate_hz) {
  const auto delay_s = [](double corner_hz) { return 1.0 / (rad_per_turn * corner_hz); };
  if (options.bandwidth_hz) {
    const double delay = delay_s(*options.bandwidth_hz);
    return {delay, 0.1 * delay};
  }
  const double longest = delay_s(std::min(6.0, 0.06 * rate_hz)), shortest = delay_s(2.5 * rate_hz);
  const double octaves = std::log(longest / shortest);
  const double mean = (longest - shortest) / octaves;
  const double square = 0.5 * (longest * longest - shortest * shortest) / octaves;
  return {mean, std::sqrt(square - mean * mean)};
}

/// The usable rows of one sensor in order of time. Its stamps are late by late_s.
class UsableRows {
 public:
  UsableRows(const WheelSensor& sensor, const Screened& screened, double late_s)
      : time_s_(sensor.time_s), usable_(screened.usable), late_s_(late_s) {
    skip_unusable();
  }
  [[nodiscard]] bool ended() const { return next_ == time_s_.size(); }
  [[nodiscard]] double time_s() const { return time_s_[next_] - late_s_; }
  std::int64_t take() {
    const auto row = static_cast<std::int64_t>(next_++);
    skip_unusable();
    return row;
  }

 private:
  void skip_unusable() {
    while (!ended() && !usable_[next_]) ++next_;
  }

  const std::vector<double>& time_s_;
  const std::vector<bool>& usable_;
  double late_s_;
  std::size_t next_ = 0;
};

/// The time of the earliest row that was not taken; infinite after the last.
double next_time_s(const std::vector<UsableRows>& sensors) {
  double t = std::numeric_limits<double>::infinity();
  for (const UsableRows& rows : sensors)
    if (!rows.ended()) t = std::min(t, rows.time_s());
  return t;
}

/// The epochs of one or two sensors on one time line.
void merge_rows(std::vector<UsableRows> sensors, WheelReadings& readings) {
  for (double t = next_time_s(sensors); std::isfinite(t); t = next_time_s(sensors)) {
    WheelEpoch epoch;
    epoch.dt_s = readings.time_s.empty() ? 0.0 : t - readings.time_s.back();
    for (std::size_t s = 0; s < sensors.size(); ++s)
      if (!sensors[s].ended() && sensors[s].time_s() - t < same_epoch_s)
        epoch.row[s] = sensors[s].take();
    readings.time_s.push_back(t);
    readings.epochs.push_back(epoch);
  }
}

/// The time line of one or two sensors; the second's stamps are late by offset_s.
WheelReadings merge(const std::vector<const WheelSensor*>& sensors,
                    const std::vector<const Prepared*>& prepared,
                    double offset_s,
                    const WheelOptions& options) {
  WheelReadings readings;
  const Uncertain gravity =
      gravity_in_plane(prepared.front()->plane, !sensors.front()->accel_mps2[2].empty(),
                       options.gravity_mps2, options.axle_tilt_std_rad);
  readings.gravity_mps2 = gravity.value;
  readings.gravity_std_mps2 = gravity.std;
  readings.given_rolling_radius_m = options.rolling_radius_m;
  std::vector<UsableRows> rows;
  std::size_t most = 0;
  for (std::size_t s = 0; s < sensors.size(); ++s) {
    const WheelPlane& plane = prepared[s]->plane;
    readings.sensors.push_back(project(*sensors[s], prepared[s]->screened, plane));
    if (!sensors[s]->accel_mps2[2].empty())
      readings.sensors.back().axle_slope = plane.axial_mps2 / readings.gravity_mps2;
    rows.emplace_back(*sensors[s], prepared[s]->screened, s == 0 ? 0.0 : offset_s);
    most = std::max(most, sensors[s]->time_s.size());
  }
  readings.time_s.reserve(most);  // of sensors with common stamps
  readings.epochs.reserve(most);
  merge_rows(std::move(rows), readings);
  if (!readings.epochs.empty()) {
    mark_standing(readings);
    mark_jerks(readings);
  }
  return readings;
}

/// A prior of the lever arms with only their size.
PlacesPrior anywhere(std::size_t sensors, double std_m) {
  const auto count = static_cast<Eigen::Index>(2 * sensors);
  return {Eigen::VectorXd::Zero(count), Eigen::MatrixXd::Identity(count, count) * (std_m * std_m)};
}

/// Whether the recording determines the direction of the lever arm in the sensor's axes.
bool shows_direction(const WheelFit& fit, Eigen::Index at) {
  const double trace = fit.constants_cov.block<2, 2>(at, at).trace();
  return fit.constants.segment<2>(at).squaredNorm() > 25.0 * trace;
}

/// With the radius given, each sensor is on its circle; its direction comes from the recording,
/// since at one speed a rotation of that direction is equivalent to a bias. If the recording does
/// not determine it, the sensor may be anywhere within, with the variance along each axis of the
/// points on a circle.
PlacesPrior on_circles(const WheelFit& free, std::size_t sensors, const Uncertain& radius_m) {
  PlacesPrior prior =
      anywhere(sensors, std::max(radius_m.value / std::numbers::sqrt2, radius_m.std));
  const Eigen::Index count = prior.mean.size(), first = free.constants.size() - count;
  for (Eigen::Index at = 0; at < count; at += 2) {
    if (!shows_direction(free, first + at)) continue;
    const Eigen::Vector2d outward = free.constants.segment<2>(first + at).normalized();
    const double across2 = prior.cov(at, at);
    prior.mean.segment<2>(at) = radius_m.value * outward;
    prior.cov.block<2, 2>(at, at) +=
        (radius_m.std * radius_m.std - across2) * outward * outward.transpose();
  }
  return prior;
}

Uncertain radius_in(const WheelFit& fit, std::size_t sensors, std::size_t sensor) {
  const auto at = fit.constants.size() - static_cast<Eigen::Index>(2 * (sensors - sensor));
  const Eigen::Vector2d place = fit.constants.segment<2>(at);
  const Eigen::Matrix2d cov = fit.constants_cov.block<2, 2>(at, at);
  // A sensor estimated at the axle has no defined direction, and the uncertainty of its worst one.
  const double widest = std::sqrt(symmetric_eigen(cov).values.maxCoeff());
  if (place.norm() < widest) return {place.norm(), widest};
  const Eigen::Vector2d outward = place.normalized();
  return {place.norm(), std::sqrt(outward.dot(cov * outward))};
}

/// Fits once without the radius and, where one is given, again with it.
WheelFit fit_with_radius(WheelReadings& readings,
                         WheelTrack track,
                         FitDepth depth,
                         const WheelOptions& options) {
  const std::size_t sensors = readings.sensors.size();
  const bool again = options.radius_m && depth == FitDepth::whole;
  WheelFit free = fit_wheel(readings, std::move(track), anywhere(sensors, ConstantsPrior{}.place_m),
                            again ? FitDepth::constants : depth, options.progress);
  if (!again) return free;
  const Uncertain radius_m{*options.radius_m, radius_std_m(options)};
  WheelFit held = fit_wheel(readings, std::move(free.track), on_circles(free, sensors, radius_m),
                            FitDepth::again, options.progress);
  held.given_radius_m = radius_m;
  for (std::size_t s = 0; s < sensors; ++s)
    held.free_radius_m.push_back(radius_in(free, sensors, s));
  return held;
}

double top_speed_radps(const WheelFit& fit) {
  double top = 0.0;
  for (const double speed : fit.series.speed_radps) top = std::max(top, std::abs(speed));
  return top;
}

/// Whether the final fit explains much less than an initial track, `begun_lost` of whose
/// measurements are unexplained: a variance that grows with the misfit can decouple a filter from
/// the wheel.
bool has_lost(const WheelFit& fit, double begun_lost) {
  return fit.track.lost > 0.1 + 1.5 * begun_lost;
}

/// Mean square of the force in the plane of the wheel, m²/s⁴.
double mean_square(const PlanarReadings& readings) {
  Moments squares;
  for (std::size_t row = 0; row < readings.u_mps2.size(); ++row)
    if (readings.has(row)) squares.add(square(readings.u_mps2[row]) + square(readings.v_mps2[row]));
  return squares.mean;
}

Error no_gravity_in(const WheelSensor& sensor) {
  const bool has_gyro = !sensor.rate_radps[0].empty();
  std::vector<Advice> advice{Advice{"unit"}, Advice{"spin-axis"}};
  if (has_gyro) advice.insert(advice.begin(), {Advice{"rate-unit"}, Advice{"no-gyro"}});
  return {Errc::not_observable,
          sensor.name + ": no rotation of gravity in the plane of the wheel (axle vertical, data " +
              (has_gyro ? "not in m/s² and rad/s" : "not in m/s²") + ", or not a wheel)",
          std::move(advice)};
}

Error angle_lost_in(const WheelSensor& sensor) {
  return {Errc::not_observable,
          sensor.name +
              ": the angle was lost: the wheel turns by more than an eighth of a turn "
              "between samples, or vibrates too strongly; record at a higher rate, or "
              "analyse a part of the recording",
          {Advice{"from"}, Advice{"to"}}};
}

/// Fits from the track that the encoder shows.
Result<Single> fit_along_encoder(const WheelSensor& sensor,
                                 Single single,
                                 FitDepth depth,
                                 const WheelOptions& options) {
  auto along = encoder_track(*options.encoder, single.readings);
  if (!along) return along.error();
  if (!(along->track.lost <= not_a_wheel)) return no_gravity_in(sensor);
  single.fit = fit_with_radius(single.readings, along->track, depth, options);
  if (has_lost(single.fit, along->track.lost)) return angle_lost_in(sensor);
  drop_counted_doubts(single.readings, along->missed, single.fit);
  single.encoder = std::move(along).value();
  return single;
}

/// A fit, and the share of measurements that its initial track did not explain.
struct Sought {
  WheelFit fit;
  double begun_lost = 0.0;
};

/// Fits from the track found by one of the searches; nullopt if that is not a wheel in gravity.
std::optional<Sought> fit_from_search(WheelReadings& readings,
                                      std::size_t seek,
                                      FitDepth depth,
                                      const WheelOptions& options) {
  WheelTrack track = find_track(readings, seek);
  const double begun_lost = track.lost;
  const bool explained = begun_lost <= not_a_wheel;
  if (!explained && !shows_gravity(readings, track)) return std::nullopt;
  Sought sought{fit_with_radius(readings, std::move(track), depth, options), begun_lost};
  // A smoothed track follows white noise, too, but a fit with ripple does not explain it.
  if (!explained && sought.fit.track.lost > not_a_wheel) return std::nullopt;
  return sought;
}

/// Fits from the phase of gravity, searched for in several ways until a fit is certain.
Result<Single> fit_along_gravity(const WheelSensor& sensor,
                                 Single single,
                                 FitDepth depth,
                                 const WheelOptions& options) {
  const double fastest = fastest_radps(single.readings.rate_hz());
  bool followed = false;
  double least_lost = 1.0;
  std::optional<Single> unsure;
  for (std::size_t seek = 0; seek < wheel_seeks; ++seek) {
    auto sought = fit_from_search(single.readings, seek, depth, options);
    if (!sought) break;
    single.fit = std::move(sought->fit);
    followed = true;
    least_lost = std::min(least_lost, sought->begun_lost);
    if (top_speed_radps(single.fit) > fastest || has_lost(single.fit, least_lost)) continue;
    // A fit that explains more but whose turns are uncertain outweighs a certain one.
    const bool explains_less = unsure && unsure->fit.track.lost < single.fit.track.lost;
    const bool outweighed =
        explains_less && std::abs(unsure->fit.turns.value - single.fit.turns.value) > 0.5;
    if (single.fit.doubts.empty() && !outweighed) return single;
    if (!explains_less) unsure = single;
  }
  if (unsure) return *std::move(unsure);
  return followed ? angle_lost_in(sensor) : no_gravity_in(sensor);
}

Result<Single> fit_single(const WheelSensor& sensor,
                          Prepared prepared,
                          FitDepth depth,
                          const WheelOptions& options) {
  Single single{std::move(prepared), {}, {}, {}};
  single.readings = merge({&sensor}, {&single.prepared}, 0.0, options);
  if (single.readings.epochs.size() < 10)
    return Error{Errc::too_few_samples, sensor.name + ": fewer than 10 usable rows"};
  if (mean_square(single.readings.sensors.front()) < square(0.05 * standard_gravity_mps2))
    return no_gravity_in(sensor);
  single.readings.delay_s = delay_of(options, single.readings.rate_hz());
  if (options.progress) options.progress("looking for the wheel's phase", 0.0);
  return options.encoder ? fit_along_encoder(sensor, std::move(single), depth, options)
                         : fit_along_gravity(sensor, std::move(single), depth, options);
}

Result<Single> fit_single(const WheelSensor& sensor, FitDepth depth, const WheelOptions& options) {
  Prepared prepared{screen_rows(sensor), {}};
  const auto plane = find_plane(sensor, prepared.screened, options.spin_axis);
  if (!plane) return plane.error();
  prepared.plane = *plane;
  return fit_single(sensor, std::move(prepared), depth, options);
}

/// Frees what is merged anew for a pair.
void forget_measurements(WheelReadings& readings) {
  std::vector<WheelEpoch>().swap(readings.epochs);
  std::vector<double>().swap(readings.time_s);
  for (PlanarReadings& sensor : readings.sensors)
    for (std::vector<double>* axis : {&sensor.u_mps2, &sensor.v_mps2})
      std::vector<double>().swap(*axis);
}

WheelMotion motion_of(const WheelFit& fit) {
  const std::vector<double>& time_s = fit.series.time_s;
  WheelMotion motion{&time_s, &fit.series.angle_rad, &fit.series.speed_radps};
  for (const WheelDoubt& doubt : fit.doubts)
    motion.lost.push_back({time_s[doubt.first], time_s[doubt.last]});
  return motion;
}

/// The encoder is on the clock of the first sensor.
WheelOptions options_of_second(WheelOptions options) {
  if (!options.clocks_shared) options.encoder.reset();
  return options;
}

/// Each sensor alone, in parallel.
Result<std::vector<Single>> fit_each(const std::vector<WheelSensor>& sensors,
                                     const WheelOptions& options) {
  const FitDepth depth = sensors.size() == 1 ? FitDepth::whole : FitDepth::track;
  std::vector<std::optional<Result<Single>>> fits(sensors.size());
  in_parallel(sensors.size(), options.progress, [&](std::size_t s, Progress progress) {
    WheelOptions of_sensor = s == 0 ? options : options_of_second(options);
    if (sensors.size() > 1) of_sensor.progress = std::move(progress);  // else with its own stages
    fits[s] = fit_single(sensors[s], depth, of_sensor);
  });
  std::vector<Single> singles;
  singles.reserve(sensors.size());
  for (auto& single : fits) {
    if (!*single) return single->error();
    singles.push_back(std::move(*single).value());
  }
  return singles;
}

/// The clock and phase of the second sensor relative to the first.
Result<ClockFit> relate(const Single& first, const Single& second, const WheelOptions& options) {
  const WheelMotion one = motion_of(first.fit), two = motion_of(second.fit);
  // Two angles by one encoder agree whatever the stamps of the sensors: their small difference,
  // against the speed, would be a significant and wrong offset.
  const bool one_encoder = first.encoder && second.encoder;
  const auto found =
      one_encoder ? fit_phase(one, two) : fit_clocks(one, two, options.clocks_shared);
  if (!found) return found.error().at("two sensors");
  if (!options.clocks_shared) return found;
  ClockFit clocks = *found;
  // With a shared clock an offset must be clearly significant before the stamps are declared wrong,
  // which a small one is not if an angle was lost.
  Uncertain& offset_s = clocks.offset_s;
  const bool lost = !first.fit.doubts.empty() || !second.fit.doubts.empty();
  constexpr double small_s = 0.1, least_s = 2e-4;
  if (std::abs(offset_s.value) < std::max(5.0 * offset_s.std, lost ? small_s : least_s))
    offset_s.value = 0.0;
  return clocks;
}

}  // namespace

Status check_wheel(std::size_t sensors, const WheelOptions& options) {
  if (sensors == 0 || sensors > 2)
    return Error{Errc::invalid_argument,
                 "a wheel takes one or two sensors, not " + std::to_string(sensors)};
  const bool positive =
      options.gravity_mps2 > 0.0 && options.radius_m.value_or(0.0) >= 0.0 &&
      options.rim_radius_m.value_or(1.0) > 0.0 && options.rolling_radius_m.value_or(0.0) >= 0.0 &&
      options.alignment_std_rad >= 0.0 && options.radius_std_m.value_or(0.0) >= 0.0 &&
      options.bandwidth_hz.value_or(1.0) > 0.0 && options.axle_tilt_std_rad >= 0.0;
  if (!positive)
    return Error{Errc::invalid_argument,
                 "gravity, radii and bandwidth must be positive (the sensor's radius may be 0), "
                 "standard deviations not negative"};
  return Done{};
}

double radius_std_m(const WheelOptions& options) {
  return options.radius_std_m.value_or(std::max(0.02 * options.radius_m.value_or(0.0), 2e-4));
}

Eigen::VectorXd places_in(const WheelFit& fit, std::size_t sensors) {
  return fit.constants.tail(static_cast<Eigen::Index>(2 * sensors));
}

Result<Pair> fit_singles(const std::vector<WheelSensor>& sensors, const WheelOptions& options) {
  auto singles = fit_each(sensors, options);
  if (!singles) return singles.error();
  Pair pair{std::move(singles).value(), {}};
  if (pair.singles.size() == 1) return pair;
  // Less than a hundredth of a turn does not determine the direction.
  const double way = pair.singles[0].fit.turns.value * pair.singles[1].fit.turns.value;
  if (way < -1e-4 && !options.spin_axis) {
    Prepared other = pair.singles[1].prepared;
    other.plane = turned_over(other.plane);
    auto again =
        fit_single(sensors[1], std::move(other), FitDepth::track, options_of_second(options));
    if (!again) return again.error();
    pair.singles[1] = std::move(again).value();
  }
  for (Single& single : pair.singles) forget_measurements(single.readings);
  const auto clocks = relate(pair.singles[0], pair.singles[1], options);
  if (!clocks) return clocks.error();
  pair.clocks = *clocks;
  return pair;
}

Joint fit_jointly(std::vector<WheelSensor> sensors, Pair pair, const WheelOptions& options) {
  const Single &one = pair.singles[0], &two = pair.singles[1];
  Joint joint;
  joint.readings = merge({&sensors[0], &sensors[1]}, {&one.prepared, &two.prepared},
                         pair.clocks.offset_s.value, options);
  joint.readings.phase_rad = pair.clocks.phase_rad;
  joint.readings.orders = one.readings.orders;
  joint.readings.delay_s = one.readings.delay_s;
  if (one.readings.encoder) {
    joint.readings.encoder = encoder_readings(one.encoder->encoder, joint.readings.time_s);
    joint.readings.one_speed = one.readings.one_speed;
    joint.readings.found_rolling_radius_m = one.readings.found_rolling_radius_m;
    joint.readings.encoder->direction = one.readings.encoder->direction;
    joint.readings.encoder->zero_rad = one.readings.encoder->zero_rad;
    joint.readings.encoder->more = one.readings.encoder->more;
  }
  for (std::size_t s = 0; s < 2; ++s)
    joint.readings.sensors[s].variance_m2ps4 =
        std::move(pair.singles[s].readings.sensors[0].variance_m2ps4);
  WheelTrack track = one.fit.track;
  track.path.moving =
      moving_at(joint.readings.time_s, one.fit.series.time_s, one.fit.track.path.moving);
  const Eigen::VectorXd &first = one.fit.track.path.standing, &second = two.fit.track.path.standing;
  track.path.standing.resize(wheel::standing(2));
  constexpr int between = wheel::gyro(1) - wheel::ripple(1);
  constexpr int ripple = wheel::ripple(1) - wheel::first_of(0), gyro = ripple + between;
  constexpr int rolling = wheel::rolling(1) - wheel::first_of(0);
  track.path.standing << first.head<5>(), second.head<5>(), 0.0, first.segment<between>(ripple),
      first.segment<wheel::gyro_states>(gyro), second.segment<wheel::gyro_states>(gyro),
      first.segment<1 + wheel::encoder_states>(rolling), first.tail<2>(), second.tail<2>();
  track.beginning.angle_rad = track.path.moving.front()(wheel::angle);
  std::vector<signal::CountSlip> missed;
  if (one.encoder) missed = one.encoder->missed;
  pair.singles.clear();
  sensors.clear();
  joint.fit = fit_with_radius(joint.readings, std::move(track), FitDepth::whole, options);
  if (joint.readings.encoder) drop_counted_doubts(joint.readings, missed, joint.fit);
  return joint;
}

}  // namespace proofmass::estimate
