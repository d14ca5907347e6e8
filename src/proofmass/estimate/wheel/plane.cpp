#include "proofmass/estimate/wheel/plane.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "proofmass/core/linalg.hpp"
#include "proofmass/core/statistics.hpp"
#include "proofmass/estimate/wheel/fit.hpp"

namespace proofmass::estimate {
namespace {

double component(const WheelSensor& sensor, std::size_t axis, std::size_t row) {
  const std::vector<double>& values = sensor.accel_mps2[axis];
  return values.empty() ? 0.0 : values[row];
}

/// The longest ascending subsequence of the stamps: a stamp far ahead is dropped itself, not all
/// that follow it. Source: C. Schensted, Canadian Journal of Mathematics 13 (1961) 179. Cost: O(N
/// log N).
std::vector<bool> rising(const std::vector<double>& time_s) {
  constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> ends;  // of the rising runs of length 1, 2, …, the one that ends lowest
  std::vector<std::size_t> before(time_s.size(), none);
  for (std::size_t row = 0; row < time_s.size(); ++row) {
    if (!std::isfinite(time_s[row])) continue;
    auto at = ends.end();
    if (!ends.empty() && time_s[row] <= time_s[ends.back()])
      at =
          std::ranges::lower_bound(ends, time_s[row], {}, [&](std::size_t k) { return time_s[k]; });
    if (at != ends.end() && time_s[row] == time_s[*at]) continue;
    if (at != ends.begin()) before[row] = *(at - 1);
    if (at == ends.end())
      ends.push_back(row);
    else
      *at = row;
  }
  std::vector<bool> keep(time_s.size(), false);
  for (std::size_t row = ends.empty() ? none : ends.back(); row != none; row = before[row])
    keep[row] = true;
  return keep;
}

Axis force_at(const WheelSensor& sensor, std::size_t row) {
  return {component(sensor, 0, row), component(sensor, 1, row), component(sensor, 2, row)};
}

double dot(const Axis& a, const Axis& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Axis cross(const Axis& a, const Axis& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Axis scaled(const Axis& a, double factor) {
  return {a[0] * factor, a[1] * factor, a[2] * factor};
}

std::size_t largest(const Axis& a) {
  std::size_t at = 0;
  for (std::size_t i = 1; i < 3; ++i)
    if (std::abs(a[i]) > std::abs(a[at])) at = i;
  return at;
}

WheelPlane plane_about(const Axis& axis) {
  WheelPlane plane;
  plane.axis = scaled(axis, 1.0 / std::sqrt(dot(axis, axis)));
  Axis next{};
  next[(largest(axis) + 1) % 3] = 1.0;
  const double along = dot(next, plane.axis);
  for (std::size_t i = 0; i < 3; ++i) next[i] -= along * plane.axis[i];
  plane.u = scaled(next, 1.0 / std::sqrt(dot(next, next)));
  plane.v = cross(plane.axis, plane.u);
  return plane;
}

/// Medians of the force over `each` rows: vibration and single bad rows are suppressed.
Eigen::MatrixX3d averaged(const WheelSensor& sensor,
                          const std::vector<std::size_t>& rows,
                          std::size_t each) {
  const std::size_t count = rows.size() / each;
  Eigen::MatrixX3d medians(static_cast<Eigen::Index>(count), 3);
  std::vector<double> stretch(each);
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t k = 0; k < each; ++k)
        stretch[k] = component(sensor, axis, rows[i * each + k]);
      medians(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(axis)) = *median(stretch);
    }
  return medians;
}

/// Rows of a twentieth of a second, in which most wheels hardly rotate, in shorter recordings a
/// tenth of the rows.
std::size_t rows_to_average(const WheelSensor& sensor, const std::vector<std::size_t>& rows) {
  const double span_s = sensor.time_s[rows.back()] - sensor.time_s[rows.front()];
  const double rate_hz = span_s > 0.0 ? static_cast<double>(rows.size()) / span_s : 0.0;
  const auto wanted = static_cast<std::size_t>(std::clamp(0.05 * rate_hz, 1.0, 1e4));
  return std::min(wanted, std::max<std::size_t>(rows.size() / 10, 1));
}

/// Clips values that lie further outside the middle nine tenths of a column than those are wide, so
/// that a few bad intervals cannot rotate the axis.
void limit(Eigen::MatrixX3d& means) {
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const View<double> column(means.col(axis).data(), static_cast<std::size_t>(means.rows()));
    const double low = *quantile(column, 0.05), high = *quantile(column, 0.95), span = high - low;
    means.col(axis) = means.col(axis).cwiseMax(low - span).cwiseMin(high + span).eval();
  }
}

/// The sensor axis most nearly level, for a wheel that does not turn.
Result<WheelPlane> assume_plane(const Eigen::MatrixX3d& means) {
  const Eigen::RowVector3d mean = means.colwise().mean();
  Axis axis{};
  std::size_t most_level = 2;
  for (const std::size_t i : {std::size_t{1}, std::size_t{0}})
    if (std::abs(mean(static_cast<Eigen::Index>(i))) <
        0.8 * std::abs(mean(static_cast<Eigen::Index>(most_level))))
      most_level = i;
  axis[most_level] = 1.0;
  WheelPlane plane = plane_about(axis);
  plane.assumed = true;
  return plane;
}

Axis axis_of(const SymmetricEigen& spread, Eigen::Index which) {
  return {spread.vectors(0, which), spread.vectors(1, which), spread.vectors(2, which)};
}

SymmetricEigen covariance_of(const Eigen::MatrixX3d& rows) {
  const Eigen::MatrixX3d centred = rows.rowwise() - rows.colwise().mean();
  return symmetric_eigen(centred.transpose() * centred / static_cast<double>(rows.rows()));
}

/// True if the least of three spreads is clearly that along the axle.
bool is_axle(const SymmetricEigen& spread) {
  return spread.values(1) >= 16.0 * std::max(spread.values(0), 0.0);
}

/// True if changes are those of gravity that rotates: along two directions alike.
bool is_rotation(const SymmetricEigen& changes) {
  constexpr double alike = 0.25, much_alike = 0.7, least_ratio = 4.0;
  const double ratio = changes.values(1) / changes.values(2);
  return (is_axle(changes) && ratio >= alike) ||
         (ratio >= much_alike && changes.values(1) >= least_ratio * changes.values(0));
}

/// The axle as the direction in which the force changes least from one interval to the next: a
/// vehicle that turns is accelerated along the axle, and one that accelerates changes the
/// centripetal force, slowly. The Coriolis force of its turns on a sensor that is fast on its wheel
/// is along the axle and proportional to gravity's radial component: a direction along which the
/// force varies by far the most, which is then that of the centripetal force, is orthogonal to the
/// axle.
std::optional<Axis> axle_of_changes(const Eigen::MatrixX3d& means, const SymmetricEigen& spread) {
  const Eigen::MatrixX3d changes =
      means.bottomRows(means.rows() - 1) - means.topRows(means.rows() - 1);
  Eigen::Matrix3d cov = changes.transpose() * changes / static_cast<double>(changes.rows());
  if (spread.values(2) >= 16.0 * spread.values(1)) {
    const Eigen::Vector3d radial = spread.vectors.col(2);
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - radial * radial.transpose();
    cov = across * cov * across + radial.dot(cov * radial) * radial * radial.transpose();
  }
  const SymmetricEigen found = symmetric_eigen(cov);
  return is_rotation(found) ? std::optional(axis_of(found, 0)) : std::nullopt;
}

/// The axle by what the force does, of means over a twentieth of a second, or of rows: a fast wheel
/// rotates by radians in that time.
std::optional<Axis> axle_of_force(const Eigen::MatrixX3d& means, const Eigen::MatrixX3d& rows) {
  const SymmetricEigen spread = covariance_of(means);
  // 0.3 m/s² of spread: gravity rotated by some 25 degrees. Less may be vibration.
  if (spread.values(1) < 0.09) return std::nullopt;
  if (is_axle(spread)) return axis_of(spread, 0);
  if (const auto axle = axle_of_changes(means, spread)) return axle;
  return axle_of_changes(rows, spread);
}

/// The axis of the largest rates of rotation, of a gyroscope that shows whole turns.
std::optional<Axis> spin_axis(const WheelSensor& sensor, const std::vector<std::size_t>& rows) {
  if (sensor.rate_radps[0].empty()) return std::nullopt;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const std::size_t row : rows) {
    const Eigen::Vector3d rate{sensor.rate_radps[0][row], sensor.rate_radps[1][row],
                               sensor.rate_radps[2][row]};
    if (rate.norm() < beyond_belief_radps) spread += rate * rate.transpose();
  }
  const SymmetricEigen rates = symmetric_eigen(spread / static_cast<double>(rows.size()));
  // A vehicle's turns are far slower than its wheels'.
  if (rates.values(2) < 1.0 || rates.values(2) < 16.0 * rates.values(1)) return std::nullopt;
  return axis_of(rates, 2);
}

Result<WheelPlane> plane_from(const WheelSensor& sensor,
                              const std::vector<std::size_t>& rows,
                              const Eigen::MatrixX3d& means) {
  std::optional<Axis> axis = axle_of_force(means, averaged(sensor, rows, 1));
  if (!axis) axis = spin_axis(sensor, rows);
  if (!axis) {
    if (covariance_of(means).values(2) < 1.0) return assume_plane(means);
    return Error{
        Errc::not_observable,
        "the force changes along one direction only: a wheel that rocks, or one whose axle is "
        "upright; state the axle, or record a whole turn",
        {Advice{"spin-axis"}}};
  }
  if ((*axis)[largest(*axis)] < 0.0) *axis = scaled(*axis, -1.0);
  return plane_about(*axis);
}

/// Regression on the speed, of measurements within `most_radps` of another.
RateLeak regression(const std::vector<double>& rate_radps,
                    const std::vector<double>& speed_radps,
                    const RateLeak& about,
                    double most_radps) {
  double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  for (std::size_t row = 0; row < rate_radps.size(); ++row) {
    const double speed = speed_radps[row], rate = rate_radps[row];
    if (!(std::abs(rate - about.at(speed)) < most_radps)) continue;  // NaN too
    n += 1.0;
    x += speed;
    y += rate;
    xx += speed * speed;
    xy += speed * rate;
  }
  const double spread = n * xx - x * x;
  if (!(spread > 0.0)) return about;
  const double share = (n * xy - x * y) / spread;
  return {(y - share * x) / n, share};
}

/// A turning vehicle's rate rotates in the sensor's axes: it averages out over the turns of a fast
/// wheel, and is the exception on a slow one.
RateLeak leak_of(const std::vector<double>& rate_radps, const std::vector<double>& speed_radps) {
  constexpr int rounds = 6;
  constexpr double most_std = 3.0;
  RateLeak leak = regression(rate_radps, speed_radps, {}, std::numeric_limits<double>::infinity());
  std::vector<double> off;
  for (int round = 0; round < rounds; ++round) {
    off.clear();
    for (std::size_t row = 0; row < rate_radps.size(); ++row)
      if (!std::isnan(speed_radps[row])) off.push_back(rate_radps[row] - leak.at(speed_radps[row]));
    const double std_radps = robust_std(off).value_or(0.0);
    leak = regression(rate_radps, speed_radps, leak, most_std * std_radps);
  }
  return leak;
}

void remove_leak(const RateLeak& leak,
                 const std::vector<double>& speed_radps,
                 std::vector<double>& rate_radps) {
  for (std::size_t row = 0; row < rate_radps.size(); ++row)
    rate_radps[row] -= leak.at(speed_radps[row]);
}

/// Whether the gyroscope's measurements amount to a whole turn.
bool turns_round(const std::vector<double>& time_s, const std::vector<double>& speed_radps) {
  double angle = 0.0, lowest = 0.0, highest = 0.0,
         last_s = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t row = 0; row < time_s.size(); ++row) {
    if (std::isnan(speed_radps[row])) continue;
    if (!std::isnan(last_s)) angle += speed_radps[row] * (time_s[row] - last_s);
    last_s = time_s[row];
    lowest = std::min(lowest, angle);
    highest = std::max(highest, angle);
  }
  return highest - lowest > rad_per_turn;
}

/// The gyroscope's measurements, with an initial variance from their scatter.
void add_speeds(const WheelSensor& sensor,
                const Screened& screened,
                const WheelPlane& plane,
                PlanarReadings& readings) {
  constexpr double least_variance = 1e-6;
  const std::size_t size = sensor.time_s.size();
  for (auto* rates : {&readings.speed_radps, &readings.rate_u_radps, &readings.rate_v_radps})
    rates->assign(size, std::numeric_limits<double>::quiet_NaN());
  std::vector<double> seconds;  // differences
  Moments speeds;
  for (std::size_t row = 0; row < size; ++row) {
    const Axis rate{sensor.rate_radps[0][row], sensor.rate_radps[1][row],
                    sensor.rate_radps[2][row]};
    const double speed = dot(rate, plane.axis);
    if (!screened.usable[row] || !(std::abs(speed) < beyond_belief_radps)) continue;
    readings.speed_radps[row] = speed;
    speeds.add(speed);
    readings.rate_u_radps[row] = dot(rate, plane.u);
    readings.rate_v_radps[row] = dot(rate, plane.v);
    if (row >= 2)
      seconds.push_back(speed - 2.0 * readings.speed_radps[row - 1] +
                        readings.speed_radps[row - 2]);
  }
  readings.constant_gyroscope = speeds.count > 0 && speeds.min == speeds.max;
  if (speeds.count == 0 || readings.constant_gyroscope) {
    for (auto* rates : {&readings.speed_radps, &readings.rate_u_radps, &readings.rate_v_radps})
      rates->clear();
    return;
  }
  if (turns_round(sensor.time_s, readings.speed_radps)) {
    readings.leak_u = leak_of(readings.rate_u_radps, readings.speed_radps);
    readings.leak_v = leak_of(readings.rate_v_radps, readings.speed_radps);
    remove_leak(readings.leak_u, readings.speed_radps, readings.rate_u_radps);
    remove_leak(readings.leak_v, readings.speed_radps, readings.rate_v_radps);
  }
  std::erase_if(seconds, [](double second) { return std::isnan(second); });
  // A second difference of white noise has six times its variance.
  readings.speed_scatter2 = square(robust_std(seconds).value_or(0.0)) / 6.0;
  readings.speed_variance = std::max(least_variance, readings.speed_scatter2);
}

/// Mean and variance of x² for a normal x.
struct Square {
  double mean = 0.0, variance = 0.0;
};

Square square_of(double mean, double variance) {
  const double mean2 = mean * mean;
  return {mean2 + variance, 2.0 * variance * (variance + 2.0 * mean2)};
}

}  // namespace

const char* why_unbelievable(const Axis& accel_mps2) {
  bool all_zero = true;
  for (const double x : accel_mps2) {
    if (!std::isfinite(x)) return "not a finite number";
    if (std::abs(x) > beyond_belief_mps2) return "beyond 1000 g";
    if (x != 0.0 && std::abs(x) < 1e-30) return "denormal number";
    all_zero = all_zero && x == 0.0;
  }
  return all_zero ? "all axes exactly zero" : nullptr;
}

Screened screen_rows(const WheelSensor& sensor) {
  Screened screened{std::vector<bool>(sensor.time_s.size(), false), {}, 0};
  const std::vector<bool> time_rises = rising(sensor.time_s);
  double last_time_s = sensor.time_s.empty() ? 0.0 : sensor.time_s.front();
  const char* open = nullptr;  // reason of the stretch that goes on
  for (std::size_t row = 0; row < sensor.time_s.size(); ++row) {
    const char* why =
        time_rises[row] ? why_unbelievable(force_at(sensor, row)) : "time does not rise";
    if (why == nullptr) {
      screened.usable[row] = true;
      last_time_s = sensor.time_s[row];
    } else {
      const double t_s = time_rises[row] ? sensor.time_s[row] : last_time_s;
      if (why != open) screened.rejected.push_back({t_s, t_s, 0, why});
      screened.rejected.back().end_s = t_s;
      ++screened.rejected.back().rows;
      ++screened.unusable;
    }
    open = why;
  }
  return screened;
}

Result<WheelPlane> find_plane(const WheelSensor& sensor,
                              const Screened& screened,
                              const std::optional<Axis>& given) {
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < screened.usable.size(); ++row)
    if (screened.usable[row]) rows.push_back(row);
  if (rows.size() < 10)
    return Error{Errc::too_few_samples, sensor.name + ": only " + std::to_string(rows.size()) +
                                            " usable rows; a wheel needs at least 10"};
  if (given && !(dot(*given, *given) > 0.0))
    return Error{Errc::invalid_argument,
                 "the spin axis has length 0; give it as x, y, z or a vector"};
  Eigen::MatrixX3d means = averaged(sensor, rows, rows_to_average(sensor, rows));
  limit(means);
  Result<WheelPlane> found = given ? Result<WheelPlane>(plane_about(*given))
                             : sensor.accel_mps2[2].empty() ? plane_about({0.0, 0.0, 1.0})
                                                            : plane_from(sensor, rows, means);
  if (!found) return found;
  WheelPlane plane = *found;
  const Eigen::Vector3d axis(plane.axis[0], plane.axis[1], plane.axis[2]);
  const Eigen::VectorXd axial = means * axis;
  plane.axial_mps2 = *median(View<double>(axial.data(), static_cast<std::size_t>(axial.size())));
  return plane;
}

WheelPlane turned_over(const WheelPlane& plane) {
  WheelPlane other = plane;
  other.axis = scaled(plane.axis, -1.0);
  other.v = scaled(plane.v, -1.0);
  other.axial_mps2 = -plane.axial_mps2;
  return other;
}

Uncertain gravity_in_plane(const WheelPlane& plane,
                           bool axial_read,
                           double gravity_mps2,
                           double tilt_std_rad) {
  constexpr double tilted_part = 0.1;  // of all axles; these have any tilt
  const double read = axial_read ? plane.axial_mps2 : 0.0;
  const double level2 = std::pow(tilt_std_rad * gravity_mps2, 2);
  const double bias2 = std::pow(ConstantsPrior{}.bias_mps2, 2), read2 = level2 + bias2;
  const double learned = axial_read ? level2 / read2 : 0.0;
  const Square level = square_of(learned * read, (1.0 - learned) * level2);
  const Square tilted = square_of(read, bias2);
  const double as_level =
      (1.0 - tilted_part) * std::exp(-0.5 * read * read / read2) / std::sqrt(rad_per_turn * read2);
  const double as_tilted = tilted_part / (2.0 * gravity_mps2);
  const double w = axial_read ? as_tilted / (as_level + as_tilted) : 0.0;
  const double mean = std::lerp(level.mean, tilted.mean, w);
  const double variance = std::lerp(level.variance, tilted.variance, w) +
                          w * (1.0 - w) * std::pow(tilted.mean - level.mean, 2);
  const double all2 = gravity_mps2 * gravity_mps2;
  const double in_plane = std::sqrt(std::max(all2 - mean, 0.01 * all2));
  return {in_plane, std::sqrt(variance) / (2.0 * in_plane)};
}

PlanarReadings project(const WheelSensor& sensor,
                       const Screened& screened,
                       const WheelPlane& plane) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  const std::size_t size = sensor.time_s.size();
  PlanarReadings readings{std::vector<double>(size, none), std::vector<double>(size, none),
                          std::vector<double>(size, 1.0)};
  for (std::size_t row = 0; row < size; ++row) {
    if (!screened.usable[row]) continue;
    const Axis f = force_at(sensor, row);
    readings.u_mps2[row] = dot(f, plane.u);
    readings.v_mps2[row] = dot(f, plane.v);
  }
  if (!sensor.rate_radps[0].empty()) add_speeds(sensor, screened, plane, readings);
  return readings;
}

}  // namespace proofmass::estimate
