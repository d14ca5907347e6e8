#include <cmath>
#include <string_view>

#include "proofmass/core/random.hpp"
#include "proofmass/core/units.hpp"
#include "wheel_world.hpp"

namespace proofmass::wheel_world {
namespace {

/// Common basis of all scenarios: a wheel between 20 and 150 rpm, an uncalibrated sensor.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : random_(seed, "world") {
    world_.rate_hz = 100.0 + 300.0 * random_.unit();
    world_.duration_s = 30.0 + 20.0 * random_.unit();
    world_.slow_radps = speed_within(20.0, 150.0);
    world_.fast_radps = world_.slow_radps * (1.6 + 0.8 * random_.unit());
    world_.start_angle_rad = random_.phase();
    world_.jitter = 0.02;
    world_.missing = 0.01;
    world_.units.push_back(unit());
    if (random_.unit() < 0.5) {
      world_.slow_radps = -world_.slow_radps;
      world_.fast_radps = -world_.fast_radps;
    }
  }

  World& world() { return world_; }
  Unit& unit_one() { return world_.units.front(); }
  double unit_random() { return random_.unit(); }
  double between(double low, double high) { return low + (high - low) * random_.unit(); }
  double log_between(double low, double high) { return low * std::pow(high / low, random_.unit()); }
  Course one_of(std::initializer_list<Course> courses) {
    return *(courses.begin() +
             static_cast<int>(random_.unit() * static_cast<double>(courses.size())));
  }
  int one_of_counts() {
    constexpr std::array counts{100, 512, 1440, 4096, 16384};
    return counts[static_cast<std::size_t>(random_.unit() * static_cast<double>(counts.size()))];
  }
  /// Limits the fastest sample to an eighth of a turn.
  double speed_within(double low_rpm, double high_rpm) {
    return log_between(low_rpm, high_rpm) * radps_per_rpm;
  }
  Unit unit() {
    Unit unit;
    unit.radius_m = log_between(0.006, 0.15);
    unit.direction_rad = random_.phase();
    unit.mounting_rad = random_.phase();
    for (double& bias : unit.bias_mps2) bias = 0.5 * random_.uniform();
    for (double& scale : unit.scale) scale = 1.0 + 0.03 * random_.uniform();
    unit.skew_rad = 0.01 * random_.uniform();
    unit.noise_mps2 = log_between(0.01, 0.07);
    unit.step_mps2 = random_.unit() < 0.3 ? unit.noise_mps2 * between(0.3, 1.0) : 0.0;
    unit.walk_mps2_rts = 2e-4 * random_.unit();
    return unit;
  }
  void add_gyro() {
    for (Unit& unit : world_.units)
      unit.gyro =
          Gyro{1.0 + 0.02 * random_.uniform(), 0.03 * random_.uniform(), log_between(0.001, 0.02)};
  }

 private:
  Random random_;
  World world_;
};

constexpr auto bench = {Course::constant,   Course::two_speeds, Course::ramp,
                        Course::start_stop, Course::reversal,   Course::wander};

World ideal(std::uint64_t seed) {
  Draw draw(seed);
  draw.world().course = draw.one_of(bench);
  return draw.world();
}

World slow(std::uint64_t seed) {
  Draw draw(seed);
  draw.world().slow_radps = draw.speed_within(1.0, 12.0);
  draw.world().fast_radps = 2.0 * draw.world().slow_radps;
  draw.world().course = draw.one_of(bench);
  draw.world().duration_s = 60.0;
  return draw.world();
}

template <int per_mille>
World ripple(std::uint64_t seed) {
  Draw draw(seed);
  draw.world().course = draw.one_of(bench);
  draw.world().ripple = per_mille * 1e-3;
  return draw.world();
}

World ripple_at_one_speed(std::uint64_t seed) {
  Draw draw(seed);
  draw.world().ripple = 0.01;
  draw.unit_one().radius_m = 0.1;
  return draw.world();
}

template <int low_hz, int high_hz>
World pole(std::uint64_t seed) {
  Draw draw(seed);
  draw.world().course = draw.one_of(bench);
  draw.unit_one().pole_hz = draw.log_between(low_hz, high_hz);
  return draw.world();
}

World tilted(std::uint64_t seed) {
  Draw draw(seed);
  draw.world().course = draw.one_of(bench);
  draw.world().axle_tilt_rad = draw.between(3.0, 10.0) * rad_per_deg;
  return draw.world();
}

World rest_to_rest(std::uint64_t seed) {
  Draw draw(seed);
  draw.world().course = Course::start_stop;
  draw.world().rolling_radius_m = 0.3;
  draw.world().road_mps2 = draw.between(0.3, 2.0);
  return draw.world();
}

World rest_to_rest_rippling(std::uint64_t seed) {
  World world = rest_to_rest(seed);
  world.ripple = 0.01;
  return world;
}

World on_the_road(std::uint64_t seed) {
  World world = rest_to_rest(seed);
  Draw draw(seed + 1'000'000);
  world.course = draw.one_of({Course::constant, Course::wander, Course::two_speeds});
  return world;
}

/// The same world with a gyroscope in its first unit.
World and_gyro(World world, std::uint64_t seed) {
  Draw draw(seed);
  draw.add_gyro();
  world.units.front().gyro = draw.unit_one().gyro;
  return world;
}

World vehicle_with_gyro(std::uint64_t seed) {
  return and_gyro(rest_to_rest(seed), seed);
}

World pushed(std::uint64_t seed) {
  Draw draw(seed);
  World& world = draw.world();
  world.course = Course::pushes;
  world.slow_radps = 0.0;
  world.fast_radps = draw.between(5.0, 9.0);
  world.rate_hz = 400.0;
  world.rolling_radius_m = 0.3;
  world.road_mps2 = draw.between(0.1, 0.8);
  world.stamps_by_wifi = true;
  draw.unit_one().radius_m = draw.between(0.03, 0.07);
  world.axle_tilt_rad = draw.between(0.0, 4.0) * rad_per_deg;
  return world;
}

World pushed_with_gyro(std::uint64_t seed) {
  return and_gyro(pushed(seed), seed);
}

World pair(std::uint64_t seed) {
  Draw draw(seed);
  World& world = draw.world();
  world.course = draw.one_of(bench);
  world.units.push_back(draw.unit());
  // Two identical units, as on a rig: the second's axes may point in any direction.
  return world;
}

World with_gyro(std::uint64_t seed) {
  Draw draw(seed);
  draw.world().course = draw.one_of(bench);
  draw.add_gyro();
  return draw.world();
}

Encoder draw_encoder(Draw& draw) {
  return {draw.one_of_counts(),    draw.unit_random() < 0.5,   0.01 * draw.unit_random(),
          draw.between(0.0, 6.28), 0.002 * draw.unit_random(), draw.between(0.0, 6.28)};
}

World with_encoder(std::uint64_t seed) {
  Draw draw(seed);
  draw.world().course = draw.one_of(bench);
  draw.world().encoder = draw_encoder(draw);
  return draw.world();
}

World pushed_with_encoder(std::uint64_t seed) {
  World world = pushed(seed);
  Draw draw(seed + 1'000'000);
  world.stamps_by_wifi = false;
  world.encoder = draw_encoder(draw);
  return world;
}

World pair_with_encoder(std::uint64_t seed) {
  World world = pair(seed);
  Draw draw(seed + 1'000'000);
  world.encoder = draw_encoder(draw);
  return world;
}

World coarse(std::uint64_t seed) {
  Draw draw(seed);
  draw.world().course = draw.one_of(bench);
  draw.unit_one().step_mps2 = draw.unit_one().noise_mps2 * draw.between(3.0, 6.0);
  return draw.world();
}

World all_at_once(std::uint64_t seed) {
  Draw draw(seed);
  World& world = draw.world();
  world.course = draw.one_of(bench);
  world.ripple = draw.log_between(1e-3, 1e-2);
  world.axle_tilt_rad = draw.between(0.0, 6.0) * rad_per_deg;
  draw.unit_one().pole_hz = draw.log_between(0.2, 5.0) * world.rate_hz / 2.0;
  draw.unit_one().warm_up_mps2 = 0.1 * draw.unit_random();
  return world;
}

/// More than 200 000 rows: most passes run on averages of up to 0.25 rad.
World long_bench(std::uint64_t seed) {
  Draw draw(seed);
  World& world = draw.world();
  world.course = draw.one_of({Course::constant, Course::two_speeds, Course::ramp,
                              Course::start_stop, Course::stop_and_go, Course::wander});
  world.duration_s = draw.between(600.0, 1200.0);
  world.rate_hz = draw.between(300.0, 400.0);
  world.slow_radps = draw.speed_within(3.0, 60.0);
  world.fast_radps = 2.0 * world.slow_radps;
  world.ripple = draw.log_between(1e-4, 3e-3);
  if (draw.unit_random() < 0.5) world.units.push_back(draw.unit());
  return world;
}

estimate::WheelOptions axis_given(const World&) {
  estimate::WheelOptions options;
  options.spin_axis = {0.0, 0.0, 1.0};
  return options;
}

estimate::WheelOptions nothing_given(const World&) {
  return {};
}

estimate::WheelOptions radius_given(const World& world) {
  estimate::WheelOptions options = axis_given(world);
  options.radius_m = world.units.front().radius_m;
  return options;
}

constexpr std::array all{
    Scenario{"ideal", "a bench, six courses of 20 to 150 rpm", ideal, axis_given},
    Scenario{"slow", "1 to 12 rpm", slow, axis_given},
    Scenario{"axis-found", "ideal, the axle found", ideal, nothing_given},
    Scenario{"ripple-1", "speed ripples by 0.1 % at 1, 2, 7 a turn", ripple<1>, axis_given},
    Scenario{"ripple-3", "by 0.3 %", ripple<3>, axis_given},
    Scenario{"ripple-10", "by 1 %", ripple<10>, axis_given},
    Scenario{"one-speed", "1 %, one speed, radius given", ripple_at_one_speed, radius_given},
    Scenario{"pole-500", "the sensor's pole at 500 Hz", pole<499, 501>, axis_given},
    Scenario{"pole-50", "at 50 Hz", pole<49, 51>, axis_given},
    Scenario{"pole-10-40", "at 10 to 40 Hz", pole<10, 40>, axis_given},
    Scenario{"tilted", "axle 3 to 10 degrees off level", tilted, axis_given},
    Scenario{"rest-to-rest", "a vehicle's wheel, road 0.3 to 2 m/s^2", rest_to_rest, axis_given},
    Scenario{"rest-to-rest-10", "the same, rippling by 1 %", rest_to_rest_rippling, axis_given},
    Scenario{"on-the-road", "a vehicle's wheel, in motion throughout", on_the_road, axis_given},
    Scenario{"pushed", "a wheelchair's, stamps of Wi-Fi", pushed, axis_given},
    Scenario{"pushed-gyro", "the same with a gyroscope", pushed_with_gyro, axis_given},
    Scenario{"rest-to-rest-gyro", "a vehicle's wheel with a gyroscope", vehicle_with_gyro,
             axis_given},
    Scenario{"gyro", "a bench with a gyroscope", with_gyro, axis_given},
    Scenario{"pair", "two sensors", pair, axis_given},
    Scenario{"encoder", "a bench with an encoder", with_encoder, axis_given},
    Scenario{"pair-encoder", "two sensors and an encoder", pair_with_encoder, axis_given},
    Scenario{"pushed-encoder", "a wheelchair's with an encoder", pushed_with_encoder, axis_given},
    Scenario{"coarse", "converter steps of 3 to 6 times the noise", coarse, axis_given},
    Scenario{"all-at-once", "ripple, tilt, pole and warm-up", all_at_once, axis_given},
    Scenario{"long", "one or two sensors, ten to twenty minutes at 3 to 60 rpm", long_bench,
             axis_given},
};

}  // namespace

std::span<const Scenario> scenarios() {
  return all;
}

}  // namespace proofmass::wheel_world
