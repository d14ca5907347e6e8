#include "vehicle_world.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "proofmass/core/random.hpp"

namespace proofmass::drive_world {
namespace {

using Vec = Eigen::Vector3d;
using Rot = Eigen::Matrix3d;

constexpr double step_s = 1e-3;
constexpr int rows_per_sample = 10;  // 100 Hz
constexpr double gravity = 9.80665, pi = std::numbers::pi;
constexpr double rest_s = 6.0;  // at either end

// Rotation about a unit axis. Source: O. Rodrigues, J. Math. Pures Appl. 5 (1840) 380.
Rot turned(const Vec& axis, double angle) {
  Rot cross;
  cross << 0, -axis.z(), axis.y(), axis.z(), 0, -axis.x(), -axis.y(), axis.x(), 0;
  return Rot::Identity() + std::sin(angle) * cross + (1.0 - std::cos(angle)) * cross * cross;
}

// The drive: speed of the rear axle's middle and yaw, at each step.
struct Course {
  std::vector<double> speed_mps, yaw_rad, path_m;
  std::vector<Vec> position_m;
};

Course make_course(const Scenario& scenario, std::uint64_t seed) {
  Random draw(seed, "course");
  const double top = 4.0 + 3.0 * draw.unit(), sway = draw.phase(), ripple = 0.2 * draw.unit();
  std::array<double, 5> size{}, rate{}, phase{};
  for (std::size_t i = 0; i < size.size(); ++i) {
    size[i] = scenario.steering * 0.035 * draw.normal();
    rate[i] = 0.05 + 0.12 * static_cast<double>(i) * draw.unit();
    phase[i] = draw.phase();
  }
  Course course;
  const auto steps = static_cast<std::size_t>(scenario.duration_s / step_s);
  Vec position = Vec::Zero();
  double yaw = 0.0, path = 0.0;
  for (std::size_t k = 0; k < steps; ++k) {
    const double t = static_cast<double>(k) * step_s;
    const double up = std::clamp((t - rest_s) / 8.0, 0.0, 1.0);
    const double down = std::clamp((scenario.duration_s - rest_s - t) / 8.0, 0.0, 1.0);
    const auto smooth = [](double s) { return s * s * s * (10.0 - s * (15.0 - 6.0 * s)); };
    double speed = top * smooth(up) * smooth(down) * (1.0 + ripple * std::sin(0.35 * t + sway));
    if (scenario.stops)
      for (const double third : {1.0, 2.0}) {
        const double off_s = std::abs(t - third * scenario.duration_s / 3.0);
        speed *= smooth(std::clamp((off_s - 2.0) / 4.0, 0.0, 1.0));
      }
    double curvature = 0.0;
    for (std::size_t i = 0; i < size.size(); ++i)
      curvature += size[i] * std::sin(rate[i] * t + phase[i]);
    course.speed_mps.push_back(speed);
    course.yaw_rad.push_back(yaw);
    course.path_m.push_back(path);
    course.position_m.push_back(position);
    const double middle = yaw + 0.5 * curvature * speed * step_s;
    position += speed * step_s * Vec(std::cos(middle), std::sin(middle), 0.0);
    yaw += curvature * speed * step_s;
    path += speed * step_s;
  }
  return course;
}

struct Imperfect {
  Rot mounting;  // sensor axes from wheel axes
  Vec lever, accel_bias, gyro_bias, accel_scale, gyro_scale;
  Rot g_sensitivity;  // of the gyroscope, rad/s per m/s²
  double accel_noise, gyro_noise;
};

Imperfect draw_sensor(std::uint64_t seed, std::size_t index, bool hub) {
  Random draw(seed, "sensor", index);
  Imperfect it;
  const Vec tilt(draw.uniform(), draw.uniform(), 0.0);
  const double tilt_rad = 5.0 * pi / 180.0 * std::min(1.0, tilt.norm());
  // Sensor z along the axle, tilted by up to five degrees.
  it.mounting = turned(tilt.normalized(), tilt_rad) * turned(Vec::UnitZ(), draw.phase());
  const double reach = hub ? 0.012 : 0.1, where = draw.phase();
  it.lever = Vec(reach * std::cos(where), reach * std::sin(where), 0.02);
  const auto three = [&](double size) {
    return Vec(size * draw.normal(), size * draw.normal(), size * draw.normal());
  };
  it.accel_bias = three(0.1);
  it.gyro_bias = three(0.004);
  it.accel_scale = Vec::Ones() + three(0.003);
  it.gyro_scale = Vec::Ones() + three(0.01);
  // 0.01 °/s per g, on every axis and between them.
  constexpr double usual_g_sensitivity = 0.01 * pi / 180.0 / gravity;
  for (Eigen::Index row = 0; row < 3; ++row)
    it.g_sensitivity.row(row) = three(usual_g_sensitivity).transpose();
  it.accel_noise = 0.1;
  it.gyro_noise = 0.003;
  return it;
}

// Position and orientation of a body at each step, as a sensor that is fixed to it measures them.
struct Motion {
  std::vector<Vec> position_m;
  std::vector<Rot> rotation;  // body to world
};

estimate::WheelSensor measure(const Motion& motion,
                              const Imperfect& it,
                              bool gyroscope,
                              std::uint64_t seed,
                              std::size_t index) {
  Random draw(seed, "noise", index);
  estimate::WheelSensor sensor;
  const std::size_t n = motion.position_m.size();
  const auto at = [&](std::size_t k) {
    return Vec(motion.position_m[k] + motion.rotation[k] * it.lever);
  };
  for (std::size_t k = 1; k + 1 < n; k += rows_per_sample) {
    const Vec acceleration = (at(k + 1) - 2.0 * at(k) + at(k - 1)) / (step_s * step_s);
    const Vec force =
        it.mounting * (motion.rotation[k].transpose() * (acceleration + Vec(0.0, 0.0, gravity)));
    const Rot change = motion.rotation[k - 1].transpose() * motion.rotation[k + 1];
    const Vec rate = it.mounting *
                         Vec(change(2, 1) - change(1, 2), change(0, 2) - change(2, 0),
                             change(1, 0) - change(0, 1)) /
                         (4.0 * step_s) +
                     it.g_sensitivity * force;
    sensor.time_s.push_back(static_cast<double>(k) * step_s);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<Eigen::Index>(axis);
      sensor.accel_mps2[axis].push_back(it.accel_scale(a) * force(a) + it.accel_bias(a) +
                                        it.accel_noise * draw.normal());
      if (gyroscope)
        sensor.rate_radps[axis].push_back(it.gyro_scale(a) * rate(a) + it.gyro_bias(a) +
                                          it.gyro_noise * draw.normal());
    }
  }
  return sensor;
}

// A wheel whose contact point is at `mount` of the vehicle rolls along its own plane; a steered one
// is turned to where its contact point moves.
struct WheelMotion {
  Motion motion;
  std::vector<double> angle_rad;
};

WheelMotion roll(const Course& course,
                 const Vec& mount,
                 double radius_m,
                 bool steered,
                 double slip_m_per_rtm,
                 Random& draw) {
  WheelMotion wheel;
  const std::size_t n = course.yaw_rad.size();
  const auto contact = [&](std::size_t k) {
    return Vec(course.position_m[k] + turned(Vec::UnitZ(), course.yaw_rad[k]) * mount);
  };
  double angle = draw.phase(), steer_yaw = course.yaw_rad[0];
  // A tyre follows its slip within some decimetres. White in each step of 1 ms it would be an
  // angular acceleration that no sensor on a wheel sees.
  constexpr double share = step_s / 0.02;
  double faster_m = 0.0, slip_m = 0.0;
  for (std::size_t k = 0; k < n; ++k) {
    const Vec moved = k + 1 < n ? Vec(contact(k + 1) - contact(k)) : Vec::Zero();
    double heading = course.yaw_rad[k];
    if (steered) {
      if (moved.norm() > 1e-5) steer_yaw = std::atan2(moved.y(), moved.x());
      heading = steer_yaw;
    }
    const Rot chassis = turned(Vec::UnitZ(), heading);
    // Wheel axes: z along the axle to the left, x and y in its plane.
    Rot upright;
    upright << 1, 0, 0, 0, 0, 1, 0, -1, 0;
    wheel.motion.rotation.push_back(chassis * upright * turned(Vec::UnitZ(), angle));
    wheel.motion.position_m.push_back(contact(k) + Vec(0.0, 0.0, radius_m));
    wheel.angle_rad.push_back(angle);
    const double along = moved.dot(chassis.col(0));
    const double white_m = slip_m_per_rtm * std::sqrt(std::abs(along)) * draw.normal();
    faster_m += share * (white_m - faster_m);
    slip_m += share * (faster_m - slip_m);
    angle += (along + slip_m) / radius_m;
  }
  return wheel;
}

struct VehicleDraw {
  double track_m, base_m, radius_m, antenna_x, antenna_y, heading_rad;
};

estimate::GnssFixes make_fixes(const Scenario& scenario,
                               const Course& course,
                               const VehicleDraw& vehicle,
                               double clock_s,
                               std::uint64_t seed) {
  Random draw(seed, "fixes");
  estimate::GnssFixes fixes{.name = "fixes", .fixes = {}};
  constexpr std::size_t every = 200;  // 5 Hz
  const double fade = std::exp(-static_cast<double>(every) * step_s / scenario.wander_s);
  const double noise_fade = std::exp(-static_cast<double>(every) * step_s / scenario.fix_noise_s);
  const auto step_of = [&](double size, double faded) -> Vec {
    return size * std::sqrt(1.0 - faded * faded) * Vec(draw.normal(), draw.normal(), 0.0);
  };
  Vec wander(scenario.wander_m * draw.normal(), scenario.wander_m * draw.normal(), 0.0);
  Vec noise(scenario.fix_noise_m * draw.normal(), scenario.fix_noise_m * draw.normal(), 0.0);
  const double lat0 = 0.8, earth_m = 6378137.0, e2 = 0.00669437999014;
  const double w = std::sqrt(1.0 - e2 * std::sin(lat0) * std::sin(lat0));
  const double north_m = earth_m * (1.0 - e2) / (w * w * w), east_m = earth_m / w * std::cos(lat0);
  for (std::size_t k = 0; k < course.yaw_rad.size(); k += every) {
    const Vec antenna = turned(Vec::UnitZ(), vehicle.heading_rad) *
                        (course.position_m[k] + turned(Vec::UnitZ(), course.yaw_rad[k]) *
                                                    Vec(vehicle.antenna_x, vehicle.antenna_y, 0.0));
    wander = fade * wander + step_of(scenario.wander_m, fade);
    noise = noise_fade * noise + step_of(scenario.fix_noise_m, noise_fade);
    const double east = antenna.x() + wander.x() + noise.x();
    const double north = antenna.y() + wander.y() + noise.y();
    fixes.fixes.push_back({.time_s = static_cast<double>(k) * step_s + clock_s,
                           .latitude_rad = lat0 + north / north_m,
                           .longitude_rad = 0.2 + east / east_m});
  }
  return fixes;
}

void add_wheels(const Scenario& scenario,
                const Course& course,
                const VehicleDraw& vehicle,
                std::uint64_t seed,
                World& world) {
  Random draw(seed, "wheels");
  const double clock_s = scenario.own_clocks ? 5.0 * draw.uniform() : 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    const bool left = i % 2 == 1, front = i >= 2;
    const double radius_m = vehicle.radius_m * (1.0 + 0.005 * draw.normal());
    if ((front && !scenario.front_axle) || (left ? !scenario.left : !scenario.right)) continue;
    const Vec mount(front ? vehicle.base_m : 0.0, (left ? 0.5 : -0.5) * vehicle.track_m, 0.0);
    const WheelMotion rolled = roll(course, mount, radius_m, front, scenario.slip_m_per_rtm, draw);
    estimate::DriveWheel wheel;
    wheel.side = left ? estimate::VehicleSide::left : estimate::VehicleSide::right;
    if (scenario.encoders) {
      constexpr double count_rad = 2.0 * pi / 256.0;
      for (std::size_t k = 1; k + 1 < rolled.angle_rad.size(); k += rows_per_sample) {
        wheel.sensor.time_s.push_back(static_cast<double>(k) * step_s);
        wheel.encoder_rad.push_back(count_rad * std::floor(rolled.angle_rad[k] / count_rad));
      }
    } else {
      wheel.sensor =
          measure(rolled.motion, draw_sensor(seed, i, true), scenario.gyroscopes, seed, i);
    }
    wheel.sensor.name = std::string(front ? "front " : "rear ") + (left ? "left" : "right");
    if (scenario.steered_known) wheel.steered = front;
    const double circumference_m = 2.0 * pi * radius_m;
    if (scenario.circumference_known)
      wheel.circumference_m =
          Uncertain{circumference_m * (1.0 + 0.002 * draw.normal()), 0.002 * circumference_m};
    const double own_clock_s = left ? clock_s : 0.0;
    if (left && scenario.own_clocks) wheel.clock = 1;
    for (double& t : wheel.sensor.time_s) t += own_clock_s;
    world.truth.circumference_m.push_back(circumference_m);
    world.truth.clock_offset_s.push_back(own_clock_s);
    world.wheels.push_back(std::move(wheel));
  }
}

void add_frame(const Course& course, std::uint64_t seed, World& world) {
  Motion motion;
  motion.position_m = course.position_m;
  for (const double yaw : course.yaw_rad) motion.rotation.push_back(turned(Vec::UnitZ(), yaw));
  Imperfect it = draw_sensor(seed, 9, true);
  it.lever = Vec(0.4, 0.1, 0.5);
  world.frame = estimate::DriveFrame{measure(motion, it, true, seed, 9), 0};
  world.frame->sensor.name = "frame";
}

}  // namespace

World make_world(const Scenario& scenario, std::uint64_t seed) {
  Random draw(seed, "vehicle");
  const VehicleDraw vehicle{.track_m = 1.5 + 0.1 * draw.uniform(),
                            .base_m = 2.6 + 0.2 * draw.uniform(),
                            .radius_m = 0.3 + 0.02 * draw.uniform(),
                            .antenna_x = 1.0 * draw.uniform(),
                            .antenna_y = 0.4 * draw.uniform(),
                            .heading_rad = draw.phase()};
  const Course course = make_course(scenario, seed);
  World world;
  add_wheels(scenario, course, vehicle, seed, world);
  if (scenario.frame) add_frame(course, seed, world);
  const double fix_clock_s = 3.0 * draw.uniform();
  if (scenario.fixes) world.fixes = make_fixes(scenario, course, vehicle, fix_clock_s, seed);
  Truth& truth = world.truth;
  truth.distance_m = course.path_m.back();
  truth.heading_change_rad = course.yaw_rad.back();
  truth.track_m = vehicle.track_m;
  truth.wheelbase_m = vehicle.base_m;
  truth.heading_start_rad = std::remainder(vehicle.heading_rad, 2.0 * pi);
  const Vec end = scenario.fixes
                      ? Vec(turned(Vec::UnitZ(), vehicle.heading_rad) * course.position_m.back())
                      : course.position_m.back();
  truth.end_m = {end.x(), end.y()};
  if (scenario.track_known)
    world.options.track_m =
        Uncertain{vehicle.track_m * (1.0 + 0.01 * draw.normal()), 0.01 * vehicle.track_m};
  world.options.wheelbase_m =
      Uncertain{vehicle.base_m * (1.0 + 0.01 * draw.normal()), 0.01 * vehicle.base_m};
  return world;
}

const std::vector<Scenario>& scenarios() {
  static const std::vector<Scenario> all{
      {.name = "encoder", .gyroscopes = false, .encoders = true},
      {.name = "encoder-frame", .gyroscopes = false, .frame = true, .encoders = true},
      {.name = "encoder-clocks",
       .gyroscopes = false,
       .frame = true,
       .encoders = true,
       .own_clocks = true},
      {.name = "encoder-steered",
       .gyroscopes = false,
       .frame = true,
       .encoders = true,
       .front_axle = true},
      {.name = "encoder-frame-gnss",
       .gyroscopes = false,
       .fixes = true,
       .frame = true,
       .encoders = true,
       .circumference_known = false,
       .track_known = false},
      {.name = "encoder-gnss-wander",
       .gyroscopes = false,
       .fixes = true,
       .frame = true,
       .encoders = true,
       .circumference_known = false,
       .track_known = false,
       .wander_m = 2.0,
       .wander_s = 8.0,
       .fix_noise_m = 0.3},
      {.name = "encoder-gnss-noise",
       .gyroscopes = false,
       .fixes = true,
       .frame = true,
       .encoders = true,
       .circumference_known = false,
       .track_known = false,
       .wander_m = 0.0,
       .fix_noise_m = 0.3,
       .fix_noise_s = 0.01},
      {.name = "encoder-gnss-only",
       .gyroscopes = false,
       .fixes = true,
       .encoders = true,
       .circumference_known = false,
       .track_known = false},
      {.name = "encoder-stops",
       .gyroscopes = false,
       .frame = true,
       .encoders = true,
       .steered_known = false,
       .stops = true},
      {.name = "encoder-sides",
       .gyroscopes = false,
       .encoders = true,
       .own_clocks = true,
       .stops = true},
      {.name = "encoder-gnss-stops",
       .gyroscopes = false,
       .fixes = true,
       .encoders = true,
       .steered_known = false,
       .circumference_known = false,
       .track_known = false,
       .stops = true},
      {.name = "gyro"},
      {.name = "gyro-clocks", .own_clocks = true},
      {.name = "accel", .gyroscopes = false},
      {.name = "right-only", .left = false},
      {.name = "gnss", .fixes = true, .circumference_known = false, .track_known = false}};
  return all;
}

}  // namespace proofmass::drive_world
