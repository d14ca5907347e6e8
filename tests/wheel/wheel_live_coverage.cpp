#include "wheel_live_coverage.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "proofmass/core/random.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/estimate/live_test_support.hpp"
#include "proofmass/estimate/live_wheel.hpp"

namespace proofmass::wheel_world {
namespace {

constexpr double from_s = 6.0;
constexpr int epochs = 8;

estimate::test::Stream stream_of(const Recorded& recorded, estimate::LiveWheelOptions& options) {
  estimate::test::Stream stream{recorded.sensors.front().time_s, {}};
  const auto append = [&](const std::string& name, const auto& axes) {
    const std::size_t at = stream.channels.size();
    stream.channels.insert(stream.channels.end(), axes.begin(), axes.end());
    return Triad{name, at, at + 1, at + 2};
  };
  for (const estimate::WheelSensor& sensor : recorded.sensors) {
    options.sensors.push_back(append(sensor.name, sensor.accel_mps2));
    options.gyroscopes.push_back(sensor.rate_radps[0].empty()
                                     ? Triad{}
                                     : append(sensor.name + " gyroscope", sensor.rate_radps));
  }
  return stream;
}

/// The truth at any time, interpolated linearly between rows.
double angle_at(const Truth& truth, double time_s) {
  const auto next = std::ranges::upper_bound(truth.time_s, time_s) - truth.time_s.begin();
  const auto k =
      static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(next, 1, std::ssize(truth.time_s) - 1));
  const double share = (time_s - truth.time_s[k - 1]) / (truth.time_s[k] - truth.time_s[k - 1]);
  return std::lerp(truth.angle_rad[k - 1], truth.angle_rad[k], share);
}

double speed_at(const Truth& truth, double time_s) {
  const double apart_s = truth.time_s[1] - truth.time_s[0];
  return (angle_at(truth, time_s + 0.5 * apart_s) - angle_at(truth, time_s - 0.5 * apart_s)) /
         apart_s;
}

LiveCoverage compare(const estimate::test::Followed& run, const Truth& truth, Random& random) {
  LiveCoverage one;
  one.recordings = 1;
  const std::vector<double>& stamps_s = run.fed.rows.stamps_s;
  if (stamps_s.empty()) {
    one.never_found = 1;
    return one;
  }
  const auto off = [&](const char* name, double time_s, std::size_t row) {
    return run[name][row] - angle_at(truth, time_s);
  };
  const double started = rad_per_turn * std::round(off("angle", stamps_s[0], 0) / rad_per_turn);
  const auto begin =
      static_cast<std::size_t>(std::ranges::lower_bound(stamps_s, from_s) - stamps_s.begin());
  for (int i = 0; i < epochs && begin < stamps_s.size(); ++i) {
    const std::size_t row =
        begin +
        static_cast<std::size_t>(random.unit() * static_cast<double>(stamps_s.size() - begin));
    const double time_s = stamps_s[row], then_s = run["smoothed_time"][row];
    const double whole = off("angle", time_s, row) - started, std = run["angle_std"][row];
    one.counted.add(Uncertain{whole, std}, 0.0);
    one.angle.add(Uncertain{std::remainder(whole, rad_per_turn), std}, 0.0);
    one.speed.add(Uncertain{run["speed"][row], run["speed_std"][row]}, speed_at(truth, time_s));
    if (std::isfinite(then_s))
      one.smoothed.add(Uncertain{std::remainder(off("smoothed_angle", then_s, row), rad_per_turn),
                                 run["smoothed_angle_std"][row]},
                       0.0);
  }
  const double slip = std::abs(off("angle", stamps_s.back(), stamps_s.size() - 1) - started);
  one.slipped = slip > 3.0;
  one.silently =
      slip > 3.0 && slip > 3.0 * run["angle_std"].back() && !run.fed.says("turns may be lost");
  return one;
}

}  // namespace

LiveCoverage live_coverage_of(const Scenario& scenario,
                              std::uint64_t first,
                              int count,
                              bool verbose) {
  LiveCoverage all;
  for (int i = 0; i < count; ++i) {
    const std::uint64_t seed = first + static_cast<std::uint64_t>(i);
    const World world = scenario.draw(seed);
    const Recorded recorded = record(world, seed);
    estimate::LiveWheelOptions options;
    options.wheel = scenario.options(world);
    const estimate::test::Stream stream = stream_of(recorded, options);
    const auto run = estimate::test::followed(estimate::live_wheel(options).value(), stream, 20);
    Random random(seed, "epochs");
    const LiveCoverage one = compare(run, recorded.truth, random);
    if (verbose) {
      std::printf("%s %llu: largest %.1f smoothed %.1f counted %.1f speed %.1f%s%s\n",
                  scenario.name, static_cast<unsigned long long>(seed), one.angle.largest(),
                  one.smoothed.largest(), one.counted.largest(), one.speed.largest(),
                  one.slipped > 0 ? " slipped" : "", one.silently > 0 ? " silently" : "");
      for (const Note& note : run.fed.notes) std::printf("    %s\n", note.text.c_str());
    }
    all.angle.append(one.angle);
    all.smoothed.append(one.smoothed);
    all.counted.append(one.counted);
    all.speed.append(one.speed);
    all.recordings += one.recordings;
    all.never_found += one.never_found;
    all.slipped += one.slipped;
    all.silently += one.silently;
  }
  return all;
}

}  // namespace proofmass::wheel_world
