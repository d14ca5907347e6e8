#include "proofmass/estimate/track/axis_inputs.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include "proofmass/core/statistics.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/signal/channel_audit.hpp"

namespace proofmass::estimate {
namespace {

// For an axis between the sensor's, the warm-up of its largest component is used.
std::optional<double> warm_up_along(const std::array<std::optional<double>, 3>& time_s,
                                    const std::array<double, 3>& axis) {
  const auto largest = std::max_element(
      axis.begin(), axis.end(), [](double x, double y) { return std::abs(x) < std::abs(y); });
  return time_s[static_cast<std::size_t>(largest - axis.begin())];
}

AxisInput first_along(const PvaTask& task, const TrackOptions& options, const TrackSolution& of) {
  AxisInput first{.name = task.sensor.name,
                  .accel_mps2 = of.series.accel_mps2,
                  .white_m2ps3 = task.run.noise.white_m2ps3,
                  .walk_m2ps5 = task.run.noise.rest_walk_m2ps5,
                  .warm_up_time_s = warm_up_along(options.warm_up_time_s, of.axis)};
  for (std::size_t a = 0; a < task.signal.axes.size(); ++a)
    first.level_mps2 += of.axis[task.signal.axes[a]] * task.signal.reference_mps2[a];
  return first;
}

Result<std::vector<double>> project(const ParallelAccelerometer& sensor,
                                    const std::array<double, 3>& axis,
                                    std::size_t size) {
  std::vector<double> along(size, 0.0);
  for (std::size_t a = 0; a < 3; ++a) {
    if (axis[a] == 0.0) continue;
    const std::vector<double>& accel = sensor.accel_mps2[a];
    if (accel.empty())
      return Error{Errc::invalid_argument,
                   "this sensor has no axis along the motion; state one that all sensors have",
                   {Advice{"axis"}}};
    if (accel.size() != size)
      return Error{Errc::invalid_argument,
                   "the number of its samples differs from the first sensor's"};
    for (std::size_t k = 0; k < size; ++k)
      along[k] = signal::is_plausible(accel[k]) ? along[k] + axis[a] * accel[k] : std::nan("");
  }
  return along;
}

Result<AxisInput> beside_along(const PvaTask& task,
                               const ParallelAccelerometer& sensor,
                               const std::array<double, 3>& axis) {
  auto projected = project(sensor, axis, task.signal.time_s.size());
  if (!projected) return projected.error().at(sensor.name);
  AxisInput one{.name = sensor.name,
                .accel_mps2 = std::move(projected).value(),
                .warm_up_time_s = warm_up_along(sensor.figures.warm_up_time_s, axis)};
  View<double> level_of = one.accel_mps2;
  if (!task.readings.rests.empty()) {
    const signal::Rest& rest = task.readings.rests.front();
    level_of = level_of.subspan(rest.first, rest.last - rest.first + 1);
  }
  const Moments level = moments(level_of);
  if (level.count == 0)
    return Error{Errc::too_few_samples, "no data at the first rest"}.at(sensor.name);
  one.level_mps2 = level.mean;
  for (double& x : one.accel_mps2) x -= one.level_mps2;
  const AxisRun run = prepare_axis(task.signal, one.accel_mps2, task.readings,
                                   {density_along(sensor.figures.white_mps2_rthz, axis),
                                    density_along(sensor.figures.walk_mps2_rts, axis)});
  one.white_m2ps3 = run.noise.white_m2ps3;
  one.walk_m2ps5 = run.noise.rest_walk_m2ps5;
  return one;
}

std::string formatted(const char* format, double value) {
  char buffer[160];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}

// Regression slope of one axis of a further sensor on the first sensor's measurement along the
// motion.
struct Slope {
  double value = 0.0, std = 0.0;
};

Slope slope_of(View<double> along, View<double> other, const std::vector<PvaSample>& samples) {
  Moments at_rest;
  for (std::size_t k = 0; k < samples.size(); ++k)
    if (samples[k].resting && signal::is_plausible(other[k])) at_rest.add(other[k]);
  double xx = 0.0, xy = 0.0, yy = 0.0, count = 0.0;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const double x = along[k], y = other[k] - at_rest.mean;
    if (samples[k].resting || std::isnan(x) || !signal::is_plausible(other[k])) continue;
    xx += x * x;
    xy += x * y;
    yy += y * y;
    count += 1.0;
  }
  if (!(xx > 0.0) || count < 3.0) return {0.0, std::numeric_limits<double>::infinity()};
  const double left = std::max(0.0, yy - xy * xy / xx);
  return {xy / xx, std::sqrt(left / (xx * (count - 1.0)))};
}

// In motion, parallel sensors measure the same: the regression slope is 1 along the axis but for
// the scales, and 0 across it for any scales.
Status check_parallel(const AxisInput& first,
                      const AxisInput& other,
                      const ParallelAccelerometer& sensor,
                      const std::array<double, 3>& axis,
                      const std::vector<PvaSample>& samples) {
  const Slope along = slope_of(first.accel_mps2, other.accel_mps2, samples);
  constexpr double determined = 0.05, clear = 4.0, largest_rad = 0.175;  // 10°: 1.5 % of the length
  if (!(along.std < determined)) return Done{};
  if (!(along.value > 0.7 && along.value < 1.4))
    return Error{Errc::invalid_argument,
                 formatted("along the axis of the motion it reads %.2f times what the first does: "
                           "sensors to be fused have parallel axes and the same scale",
                           along.value)}
        .at(other.name);
  double squares = 0.0, variance = 0.0;
  for (std::size_t a = 0; a < 3; ++a) {
    if (sensor.accel_mps2[a].size() != samples.size()) continue;
    const Slope slope = slope_of(first.accel_mps2, sensor.accel_mps2[a], samples);
    const double across = slope.value - along.value * axis[a];
    squares += across * across;
    variance += slope.std * slope.std;
  }
  const double angle_rad = std::atan2(std::sqrt(squares), along.value);
  if (angle_rad < largest_rad || squares < clear * clear * variance) return Done{};
  return Error{Errc::invalid_argument,
               formatted("it sees the motion along an axis that is turned by %.0f deg from that of "
                         "the first: sensors to be fused have parallel axes",
                         angle_rad / rad_per_deg)}
      .at(other.name);
}

// A turning point is within a sample of the stated time.
double turn_std_mps(const PvaTask& task, View<double> accel, std::size_t k) {
  const double h = k > 0 ? task.signal.time_s[k] - task.signal.time_s[k - 1] : 0.0;
  const double slip_mps = std::isnan(accel[k]) ? 0.0 : std::abs(accel[k]) * h;
  return std::hypot(task.readings.rest_speed_std_mps, slip_mps);
}

std::vector<PvaSample> samples_of(const PvaTask& task, View<double> accel) {
  std::vector<PvaSample> samples(task.signal.time_s.size());
  for (const std::size_t k : task.readings.turns)
    samples[k].velocity_std_mps = turn_std_mps(task, accel, k);
  for (const TrackReadings::Fix& fix : task.readings.fixes) {
    PvaSample& at = samples[fix.sample];
    const double before = std::isnan(at.position_m) ? 0.0 : 1.0 / at.position_variance;
    const double weight = before + 1.0 / fix.variance_m2;
    const double sum =
        (before > 0.0 ? before * at.position_m : 0.0) + fix.position_m / fix.variance_m2;
    at.position_m = sum / weight;
    at.position_after_s = (before * at.position_after_s + fix.after_s / fix.variance_m2) / weight;
    at.position_variance = 1.0 / weight;
  }
  for (const signal::Rest& rest : task.readings.rests) {
    samples[rest.first].velocity_std_mps = task.readings.rest_speed_std_mps;
    samples[rest.first].arrives = samples[rest.first].jumps = rest.first > 0;
    for (std::size_t k = rest.first + 1; k <= rest.last; ++k)
      samples[k] = {.resting = true,
                    .position_m = samples[k].position_m,
                    .position_variance = samples[k].position_variance,
                    .position_after_s = samples[k].position_after_s};
    if (rest.last + 1 < samples.size()) samples[rest.last + 1].jumps = true;
  }
  return samples;
}

// The task's further sensors.
Status add_beside(const PvaTask& task, const std::array<double, 3>& axis, AxisInputs& sensors) {
  const std::size_t beside = task.sensor.beside.size();
  if (beside == 0 || beside >= most_fused_sensors)
    return Error{Errc::invalid_argument, std::to_string(beside + 1) + " accelerometers; 2 to " +
                                             std::to_string(most_fused_sensors) + " are fused"};
  for (const ParallelAccelerometer& other : task.sensor.beside) {
    auto one = beside_along(task, other, axis);
    if (!one) return one.error();
    const Status parallel = check_parallel(sensors.all.front(), *one, other, axis, sensors.samples);
    if (!parallel) return parallel.error();
    sensors.all.push_back(std::move(one).value());
  }
  return Done{};
}

// Where all sensors miss, the mean acceleration has the scatter of the motion, σ: between two
// measurements T apart a jerk of density 12 σ²/T gives it that variance.
void add_missing_jerk(View<double> time_s, AxisInputs& sensors) {
  const double std_mps2 = moments(sensors.all.front().accel_mps2).std();
  const auto missing = [&](std::size_t k) {
    return std::ranges::all_of(sensors.all,
                               [k](const AxisInput& one) { return std::isnan(one.accel_mps2[k]); });
  };
  for (std::size_t k = 1; k < time_s.size(); ++k) {
    if (!missing(k)) continue;
    const std::size_t before = k - 1;
    while (k + 1 < time_s.size() && missing(k)) ++k;
    const double psd = 12.0 * square(std_mps2) / (time_s[k] - time_s[before]);
    for (std::size_t i = before + 1; i <= k; ++i) sensors.samples[i].missing_jerk_m2ps5 = psd;
  }
}

}  // namespace

Result<AxisInputs> axis_inputs(const PvaTask& task,
                               const TrackOptions& options,
                               const TrackSolution& solution) {
  AxisInputs sensors;
  sensors.all.push_back(first_along(task, options, solution));
  sensors.samples = samples_of(task, solution.series.accel_mps2);
  if (options.model == TrackModel::fused) {
    const Status added = add_beside(task, solution.axis, sensors);
    if (!added) return added.error();
  }
  add_missing_jerk(task.signal.time_s, sensors);
  return sensors;
}

}  // namespace proofmass::estimate
