#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "proofmass/core/statistics.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/estimate/drive/fit.hpp"

namespace proofmass::estimate::drive {
namespace {

constexpr double step_s = 0.1;
constexpr double most_epochs = 12000.0;
constexpr double still_radps = 0.03;  // of every wheel: the vehicle stands
constexpr double steering_mps = 0.5;  // slower, the steering angle is not that of the path
constexpr double least_angle_std_rad = 0.003;

void add_wheel(const Trace& trace, double offset_s, std::size_t wheel, std::vector<Epoch>& epochs) {
  const double first = at_time(trace.time_s, trace.angle_rad, epochs.front().time_s + offset_s);
  for (Epoch& epoch : epochs) {
    const double t = epoch.time_s + offset_s;
    epoch.angle_rad[wheel] = missing;
    if (t < trace.time_s.front() || t > trace.time_s.back()) continue;
    epoch.angle_rad[wheel] = at_time(trace.time_s, trace.angle_rad, t) - first;
    epoch.angle_std_rad[wheel] =
        std::max(least_angle_std_rad, at_time(trace.time_s, trace.angle_std_rad, t));
    epoch.angle_rate_radps[wheel] = at_time(trace.time_s, trace.speed_radps, t);
  }
}

void add_yaw(const Trace& trace, double offset_s, std::size_t gyro, std::vector<Epoch>& epochs) {
  if (trace.yaw_rad.empty()) return;
  const double first = at_time(trace.time_s, trace.yaw_rad, epochs.front().time_s + offset_s);
  for (Epoch& epoch : epochs) {
    const double t = epoch.time_s + offset_s;
    if (t < trace.time_s.front() || t > trace.time_s.back()) continue;
    epoch.yaw_rad[gyro] = at_time(trace.time_s, trace.yaw_rad, t) - first;
    epoch.yaw_rate_radps[gyro] = (at_time(trace.time_s, trace.yaw_rad, t + step_s) -
                                  at_time(trace.time_s, trace.yaw_rad, t - step_s)) /
                                 (2.0 * step_s);
  }
}

// Angular rates of the wheels in the step to an epoch.
struct StepRates {
  double sum = 0.0, fastest = 0.0, speed_mps = 0.0;
};

StepRates rates_of(const Epoch& epoch, const Epoch* before, const Vehicle& vehicle) {
  StepRates rates;
  for (std::size_t i = 0; i < static_cast<std::size_t>(vehicle.wheels); ++i) {
    const double rate = before == nullptr
                            ? epoch.angle_rate_radps[i]
                            : (epoch.angle_rad[i] - before->angle_rad[i]) / epoch.dt_s;
    if (std::isnan(rate)) continue;
    rates.sum += rate;
    rates.fastest = std::max(rates.fastest, std::abs(rate));
    rates.speed_mps += std::abs(rate) * vehicle.radius_m[i] / vehicle.wheels;
  }
  return rates;
}

double offset_s(const Vehicle& vehicle, std::size_t sensor) {
  return vehicle.offset_s[static_cast<std::size_t>(vehicle.clock[sensor])];
}

// Variance that the integrated yaw rate gains in the step to an epoch.
double yaw_variance_rad2(const Trace& trace, double offset_s, const Epoch& epoch) {
  const double walk = trace.yaw_walk_rad2ps * epoch.dt_s;
  if (trace.yaw_gap_rad2.empty()) return walk;
  const double t = epoch.time_s + offset_s;
  return walk + at_time(trace.time_s, trace.yaw_gap_rad2, t) -
         at_time(trace.time_s, trace.yaw_gap_rad2, t - epoch.dt_s);
}

void set_yaw_variance(const Recorded& recorded, const Vehicle& vehicle, Epoch& epoch) {
  const auto set = [&](const Trace& trace, std::size_t gyro) {
    epoch.yaw_walk_rad2[gyro] = yaw_variance_rad2(trace, offset_s(vehicle, gyro), epoch);
  };
  for (std::size_t i = 0; i < recorded.wheels.size(); ++i) set(recorded.wheels[i], i);
  if (recorded.frame) set(*recorded.frame, most_drive_wheels);
}

// Direction of travel in the step to each epoch. Standing wheels add no noise to the yaw.
void add_direction(const Recorded& recorded, const Vehicle& vehicle, std::vector<Epoch>& epochs) {
  const Epoch* before = nullptr;
  for (Epoch& epoch : epochs) {
    const StepRates rates = rates_of(epoch, before, vehicle);
    epoch.direction = rates.fastest < still_radps ? 0 : rates.sum < 0.0 ? -1 : 1;
    epoch.turns = rates.speed_mps > steering_mps;
    if (before != nullptr)
      epoch.moving_s = before->moving_s + (epoch.direction == 0 ? 0.0 : epoch.dt_s);
    before = &epoch;
    if (epoch.direction != 0) set_yaw_variance(recorded, vehicle, epoch);
  }
}

// Each fix at its nearest epoch, one at most.
void add_fixes(const LocalFixes& fixes, double offset_s, std::vector<Epoch>& epochs) {
  const double begin = epochs.front().time_s;
  const double step = epochs.size() > 1 ? epochs[1].time_s - begin : step_s;
  for (std::size_t j = 0; j < fixes.time_s.size(); ++j) {
    const double index = std::round((fixes.time_s[j] - offset_s - begin) / step);
    if (!(index >= 0.0) || index >= static_cast<double>(epochs.size())) continue;
    Epoch& epoch = epochs[static_cast<std::size_t>(index)];
    if (!std::isnan(epoch.fix_east_m)) continue;
    epoch.fix_east_m = fixes.east_m[j];
    epoch.fix_north_m = fixes.north_m[j];
    epoch.fix_variance_m2 = 0.0;
    epoch.fix_after_s = fixes.time_s[j] - epoch.time_s;
  }
}

}  // namespace

std::vector<Epoch> epochs_of(const Recorded& recorded, const Vehicle& vehicle) {
  const double span_s = recorded.end_s - recorded.start_s;
  const double step = std::max(step_s, span_s / most_epochs);
  const auto count = static_cast<std::size_t>(span_s / step) + 1;
  std::vector<Epoch> epochs(count);
  for (std::size_t k = 0; k < count; ++k) {
    epochs[k].time_s = recorded.start_s + static_cast<double>(k) * step;
    epochs[k].dt_s = k == 0 ? 0.0 : step;
    epochs[k].angle_rad.fill(missing);
    epochs[k].yaw_rad.fill(missing);
  }
  for (std::size_t i = 0; i < recorded.wheels.size(); ++i) {
    add_wheel(recorded.wheels[i], offset_s(vehicle, i), i, epochs);
    add_yaw(recorded.wheels[i], offset_s(vehicle, i), i, epochs);
  }
  if (recorded.frame)
    add_yaw(*recorded.frame, offset_s(vehicle, most_drive_wheels), most_drive_wheels, epochs);
  add_direction(recorded, vehicle, epochs);
  if (recorded.fixes)
    add_fixes(*recorded.fixes, vehicle.offset_s[static_cast<std::size_t>(vehicle.fix_clock)],
              epochs);
  return epochs;
}

namespace {

struct NormalPoint {
  std::size_t epoch;
  double off_m;  // from the path
};

// A point far from the path, as after reflections that last for seconds, gets a variance that grows
// with the square of its distance. The filter alone would accept it where it comes first, and then
// reject the others.
void doubt_far_points(const std::vector<NormalPoint>& points, std::vector<Epoch>& epochs) {
  constexpr double far = 5.0, least_m = 3.0;
  std::vector<double> off_m;
  for (const NormalPoint& point : points) off_m.push_back(point.off_m);
  const double most_m = std::max(least_m, far * median(std::move(off_m)).value_or(0.0));
  for (const NormalPoint& point : points) {
    if (!(point.off_m > most_m)) continue;
    epochs[point.epoch].fix_variance_m2 += square(point.off_m) - square(most_m);
    epochs[point.epoch].fix_doubted = true;
  }
}

}  // namespace

void form_normal_points(const Vehicle& vehicle,
                        const std::vector<Mat<at::states>>& path,
                        double window_s,
                        std::vector<Epoch>& epochs) {
  const int clock = at::clock + vehicle.fix_clock;
  const auto place = [&](std::size_t k, double late_s) {
    const Mat<seen_states> now = seen(path[k]);
    const double ahead_m = now(4) * late_s;
    const double ahead = ahead_m + path[k](at::antenna), left = path[k](at::antenna + 1);
    const double c = std::cos(now(2)), s = std::sin(now(2));
    return Mat<2>(now(0) + path[k](at::origin) + c * ahead - s * left,
                  now(1) + path[k](at::origin + 1) + s * ahead + c * left);
  };
  std::vector<NormalPoint> points;
  std::size_t k = 0;
  while (k < epochs.size()) {
    if (std::isnan(epochs[k].fix_east_m)) {
      ++k;
      continue;
    }
    const double until_s = epochs[k].time_s + window_s;
    std::vector<std::size_t> members;
    for (; k < epochs.size() && epochs[k].time_s < until_s; ++k)
      if (!std::isnan(epochs[k].fix_east_m)) members.push_back(k);
    std::vector<double> east, north;
    double variance = 0.0;
    for (const std::size_t j : members) {
      Epoch& epoch = epochs[j];
      const Mat<2> expected = place(j, epoch.fix_after_s - path[j](clock));
      east.push_back(epoch.fix_east_m - expected(0));
      north.push_back(epoch.fix_north_m - expected(1));
      variance += epoch.fix_variance_m2 / static_cast<double>(members.size());
      epoch.fix_east_m = epoch.fix_north_m = missing;
    }
    const std::size_t middle = members[members.size() / 2];
    const Mat<2> expected = place(middle, 0.0);
    epochs[middle].fix_east_m = expected(0) + median(east).value_or(0.0);
    epochs[middle].fix_north_m = expected(1) + median(north).value_or(0.0);
    epochs[middle].fix_variance_m2 = variance;
    epochs[middle].fix_after_s = path[middle](clock);
    points.push_back({middle, std::hypot(median(east).value_or(0.0), median(north).value_or(0.0))});
  }
  doubt_far_points(points, epochs);
}

void add_course(const Vehicle& vehicle, std::vector<Epoch>& epochs) {
  constexpr double chord_m = 4.0, walk_rad2ps = 0.02;
  struct Point {
    std::size_t epoch;
    double course_rad;
  };
  std::vector<Point> points;
  std::optional<std::size_t> from;
  double rolled_m = 0.0;
  for (std::size_t k = 1; k < epochs.size(); ++k) {
    rolled_m += std::abs(epochs[k].angle_rad[0] - epochs[k - 1].angle_rad[0]) * vehicle.radius_m[0];
    if (std::isnan(epochs[k].fix_east_m) || epochs[k].direction == 0) continue;
    if (from && rolled_m < chord_m) continue;
    if (from) {
      const Epoch& start = epochs[*from];
      const double sign = epochs[k].direction;
      const double course = std::atan2(sign * (epochs[k].fix_north_m - start.fix_north_m),
                                       sign * (epochs[k].fix_east_m - start.fix_east_m));
      const double before = points.empty() ? course : points.back().course_rad;
      points.push_back({(*from + k) / 2, before + std::remainder(course - before, rad_per_turn)});
    }
    from = k;
    rolled_m = 0.0;
  }
  if (points.empty()) return;
  std::vector<double> times, courses;
  for (const Point& point : points) {
    times.push_back(epochs[point.epoch].time_s);
    courses.push_back(point.course_rad - points.front().course_rad);
  }
  for (Epoch& epoch : epochs) {
    epoch.yaw_rad[most_drive_wheels] = at_time(times, courses, epoch.time_s);
    epoch.yaw_walk_rad2[most_drive_wheels] = epoch.direction == 0 ? 0.0 : walk_rad2ps * epoch.dt_s;
  }
}

}  // namespace proofmass::estimate::drive
