#include "proofmass/estimate/motor/prepare.hpp"

#include <algorithm>
#include <cmath>

#include "proofmass/core/number_words.hpp"
#include "proofmass/core/statistics.hpp"
#include "proofmass/estimate/motor/angle.hpp"

namespace proofmass::estimate::motor {
namespace {

constexpr std::size_t least_samples = 200;

Status check(const MotorRecord& record) {
  const std::size_t n = record.time_s.size();
  bool fits = record.voltage_v.size() == n;
  fits = fits && (record.current_a.empty() || record.current_a.size() == n);
  fits = fits && (record.angle_rad.empty() || record.angle_rad.size() == n);
  for (const auto& sensor : record.accel_mps2)
    for (const auto& axis : sensor) fits = fits && (axis.empty() || axis.size() == n);
  if (!fits) return Error{Errc::invalid_argument, "columns of unequal length"};
  if (record.angle_rad.empty() && record.accel_mps2.empty())
    return Error{Errc::invalid_argument, "neither accelerometers nor an angle"};
  if (n < least_samples)
    return Error{Errc::too_few_samples, std::to_string(n) + " samples, at least " +
                                            std::to_string(least_samples) + " are needed"};
  return Done{};
}

// Whether a row has a value in every column that is used.
bool is_whole(const MotorRecord& record, std::size_t row) {
  const auto has = [row](const std::vector<double>& column) {
    return column.empty() || std::isfinite(column[row]);
  };
  if (!has(record.voltage_v) || !has(record.current_a) || !has(record.angle_rad)) return false;
  return !record.angle_rad.empty() ||
         std::ranges::all_of(record.accel_mps2,
                             [&](const auto& sensor) { return std::ranges::all_of(sensor, has); });
}

std::vector<std::size_t> whole_rows(const MotorRecord& record) {
  std::vector<std::size_t> rows;
  for (std::size_t k = 0; k < record.time_s.size(); ++k)
    if (is_whole(record, k)) rows.push_back(k);
  return rows;
}

std::vector<double> rows_of(const std::vector<double>& values,
                            const std::vector<std::size_t>& rows) {
  std::vector<double> out;
  if (values.empty()) return out;
  for (const std::size_t k : rows) out.push_back(values[k]);
  return out;
}

// On an even grid by linear interpolation, then the mean of each `block`.
std::vector<double> on_grid(const std::vector<double>& t,
                            const std::vector<double>& values,
                            double step_s,
                            std::size_t block) {
  std::vector<double> out;
  if (values.empty()) return out;
  const auto n = static_cast<std::size_t>((t.back() - t.front()) / step_s + 1.000001);
  std::size_t at = 0;
  double sum = 0.0;
  for (std::size_t k = 0; k < n; ++k) {
    const double time = t.front() + static_cast<double>(k) * step_s;
    while (at + 2 < t.size() && t[at + 1] < time) ++at;
    const double share = std::clamp((time - t[at]) / (t[at + 1] - t[at]), 0.0, 1.0);
    sum += values[at] + share * (values[at + 1] - values[at]);
    if ((k + 1) % block != 0) continue;
    out.push_back(sum / static_cast<double>(block));
    sum = 0.0;
  }
  return out;
}

// The samples of the even grid that lie within longer steps than of two missing rows, by blocks.
std::vector<bool> bridged_on_grid(const std::vector<double>& t, double step_s, std::size_t block) {
  constexpr double longest_step = 3.5;
  std::vector<double> gaps(t.size(), 0.0);
  for (std::size_t k = 1; k < t.size(); ++k)
    if (t[k] - t[k - 1] > longest_step * step_s) gaps[k - 1] = gaps[k] = 1.0;
  std::vector<bool> bridged;
  for (const double share : on_grid(t, gaps, step_s, block)) bridged.push_back(share > 0.0);
  return bridged;
}

Result<std::vector<double>> load_angle(const MotorRecord& record,
                                       const std::vector<std::size_t>& rows,
                                       double gravity_mps2) {
  if (!record.angle_rad.empty()) return rows_of(record.angle_rad, rows);
  std::vector<PlaneAxes> planes;
  for (const auto& sensor : record.accel_mps2) {
    std::array<std::vector<double>, 3> axes;
    for (std::size_t i = 0; i < 3; ++i)
      axes[i] =
          sensor[i].empty() ? std::vector<double>(rows.size(), 0.0) : rows_of(sensor[i], rows);
    planes.push_back(plane_of(axes));
  }
  return angle_of(planes, gravity_mps2);
}

// The sense of the angle is that of the axes; the drive's is that of the voltage.
void turn_with_voltage(Series& series) {
  double along = 0.0;
  for (std::size_t k = 1; k < series.size(); ++k)
    along += series.voltage_v[k] * (series.angle_rad[k] - series.angle_rad[k - 1]);
  if (along < 0.0)
    for (double& angle : series.angle_rad) angle = -angle;
}

}  // namespace

Result<Series> prepare(const MotorRecord& record, const MotorOptions& options) {
  if (const Status good = check(record); !good) return good.error();
  const std::vector<std::size_t> rows = whole_rows(record);
  if (rows.size() < least_samples)
    return Error{Errc::too_few_samples, "too few rows have a value in every column"};
  const std::vector<double> time_s = rows_of(record.time_s, rows);
  std::vector<double> steps;
  for (std::size_t k = 1; k < time_s.size(); ++k) steps.push_back(time_s[k] - time_s[k - 1]);
  const double step_s = median(steps).value_or(0.0);
  if (!(step_s > 0.0) || *std::ranges::min_element(steps) <= 0.0)
    return Error{Errc::invalid_argument, "the times do not increase"};
  Result<std::vector<double>> angle = load_angle(record, rows, options.gravity_mps2);
  if (!angle) return angle.error();
  const auto block = std::max<std::size_t>(
      1, static_cast<std::size_t>(std::ceil(1.0 / (step_s * options.most_rate_hz) - 1e-6)));
  Series series{.step_s = step_s * static_cast<double>(block),
                .voltage_v = on_grid(time_s, rows_of(record.voltage_v, rows), step_s, block),
                .current_a = on_grid(time_s, rows_of(record.current_a, rows), step_s, block),
                .angle_rad = on_grid(time_s, *angle, step_s, block),
                .bridged = bridged_on_grid(time_s, step_s, block),
                .from_gravity = record.angle_rad.empty(),
                .gravity_mps2 = options.gravity_mps2};
  if (series.size() < least_samples)
    return Error{Errc::too_few_samples, "the recording is too short"};
  // A regression takes its columns as exact: noise of the current would attenuate resistance and
  // inductance, in whose place torque constant and backlash would come.
  constexpr double smooth_s = 0.05;
  series.sampled_current_a = series.current_a;
  if (series.has_current()) series.current_a = smoothed(series.current_a, series.step_s, smooth_s);
  turn_with_voltage(series);
  return series;
}

}  // namespace proofmass::estimate::motor
