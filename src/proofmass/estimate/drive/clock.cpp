#include "proofmass/estimate/drive/clock.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "proofmass/core/statistics.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/estimate/drive/trace.hpp"

namespace proofmass::estimate::drive {
namespace {

constexpr double most_points = 8000.0;
// Changes of wheel speeds; and of the fixes' speed, whose noise over a second is that of the
// motion.
constexpr double wheel_change_s = 1.0, fix_change_s = 4.0, fix_chord_s = 3.0;

// Changes of a signal over change_s, centred, on a grid of its own clock.
struct Changes {
  double start_s = 0.0, step_s = 0.1;
  std::vector<double> values;

  [[nodiscard]] double power() const {
    double sum = 0.0;
    for (const double value : values) sum += value * value;
    return sum;
  }
  // Independent changes: those over change_s follow each other, and the largest count most.
  [[nodiscard]] double independent(double change_s) const {
    double fourth = 0.0;
    for (const double value : values) fourth += square(value * value);
    return fourth > 0.0 ? std::max(1.0, square(power()) / fourth * step_s / change_s) : 1.0;
  }
};

Changes changes_of(const Signal& signal, double step_s, double change_s) {
  Changes changes{.start_s = signal.time_s.front(), .step_s = step_s, .values = {}};
  for (double t = changes.start_s; t <= signal.time_s.back(); t += step_s)
    changes.values.push_back(at_time(signal.time_s, signal.values, t + 0.5 * change_s) -
                             at_time(signal.time_s, signal.values, t - 0.5 * change_s));
  return changes;
}

// Σ a b with b shifted by `lag` steps against a.
double product(const Changes& a, const Changes& b, std::ptrdiff_t lag) {
  double sum = 0.0;
  const auto na = static_cast<std::ptrdiff_t>(a.values.size());
  const auto nb = static_cast<std::ptrdiff_t>(b.values.size());
  for (std::ptrdiff_t i = std::max<std::ptrdiff_t>(0, -lag); i < std::min(na, nb - lag); ++i)
    sum += a.values[static_cast<std::size_t>(i)] * b.values[static_cast<std::size_t>(i + lag)];
  return sum;
}

double duration(const Signal& signal) {
  return signal.time_s.back() - signal.time_s.front();
}

// Fisher's transformation of a correlation: over n pairs its sampling variance is about 1/n.
double fisher(double correlation) {
  constexpr double largest = 0.999999;
  return std::atanh(std::clamp(correlation, -largest, largest));
}

Alignment align_changes(const Signal& first,
                        const Signal& second,
                        double change_s,
                        std::optional<double> expected_s) {
  const double step_s = std::max(0.05, std::max(duration(first), duration(second)) / most_points);
  const Changes a = changes_of(first, step_s, change_s);
  const Changes b = changes_of(second, step_s, change_s);
  const double norm = std::sqrt(a.power() * b.power());
  if (!(norm > 0.0)) return {};
  const auto offset_of = [&](double lag) { return b.start_s - a.start_s + lag * step_s; };
  struct Peak {
    double value = -INFINITY;
    std::ptrdiff_t lag = 0;
  } best, near;
  const auto na = static_cast<std::ptrdiff_t>(a.values.size());
  const auto nb = static_cast<std::ptrdiff_t>(b.values.size());
  for (std::ptrdiff_t lag = 1 - na; lag < nb; ++lag) {
    const double value = product(a, b, lag) / norm;
    if (value > best.value) best = {value, lag};
    const double off_s = std::abs(offset_of(static_cast<double>(lag)) - expected_s.value_or(0.0));
    if (expected_s && off_s < 0.5 && value > near.value) near = {value, lag};
  }
  // By how many standard deviations another offset must be better than the expected one.
  constexpr double clearly = 4.0;
  const double independent = std::min(a.independent(change_s), b.independent(change_s));
  if (fisher(best.value) - fisher(near.value) < clearly * std::sqrt(2.0 / independent)) best = near;
  // The top of a parabola through three points.
  const double before = product(a, b, best.lag - 1) / norm,
               after = product(a, b, best.lag + 1) / norm;
  const double bend = before - 2.0 * best.value + after;
  const double top = bend < 0.0 ? std::clamp(0.5 * (before - after) / bend, -1.0, 1.0) : 0.0;
  Alignment found;
  found.offset_s = offset_of(static_cast<double>(best.lag) + top);
  found.correlation = best.value;
  // What the signals do not share moves the top by its slope over the top's curvature.
  const double curvature = std::max(0.0, -bend) / square(step_s);
  const double unshared = std::max(0.0, 1.0 - square(best.value));
  found.std_s = std::sqrt(unshared / (independent * std::max(best.value * curvature, 1e-6)));
  return found;
}

}  // namespace

Signal log_speed(const Signal& speed) {
  constexpr double floor = 0.03;  // of the root mean square
  double power = 0.0;
  for (const double value : speed.values) power += square(value);
  const double usual = std::sqrt(power / static_cast<double>(speed.values.size()));
  Signal logarithm = speed;
  if (usual > 0.0)
    for (double& value : logarithm.values) value = std::log(floor + std::abs(value) / usual);
  return logarithm;
}

Alignment align(const Signal& first, const Signal& second, std::optional<double> expected_s) {
  return align_changes(first, second, wheel_change_s, expected_s);
}

LocalFixes local_fixes(const GnssFixes& fixes) {
  LocalFixes local;
  if (fixes.fixes.empty()) return local;
  const double lat = local.latitude_rad = fixes.fixes.front().latitude_rad;
  local.longitude_rad = fixes.fixes.front().longitude_rad;
  // Radii of curvature of the WGS 84 ellipsoid. Source: NIMA TR8350.2 (2000), section 3.
  constexpr double a_m = 6378137.0, e2 = 6.69437999014e-3;
  const double w2 = 1.0 - e2 * square(std::sin(lat));
  const double meridian_m = a_m * (1.0 - e2) / (w2 * std::sqrt(w2));
  const double parallel_m = a_m / std::sqrt(w2) * std::cos(lat);
  for (const GnssFix& fix : fixes.fixes) {
    local.time_s.push_back(fix.time_s);
    local.east_m.push_back(std::remainder(fix.longitude_rad - local.longitude_rad, rad_per_turn) *
                           parallel_m);
    local.north_m.push_back((fix.latitude_rad - lat) * meridian_m);
    local.std_m.push_back(fix.std_m);
  }
  return local;
}

Signal speed_of(const LocalFixes& fixes) {
  Signal speed;
  const std::vector<double>& t = fixes.time_s;
  if (t.size() < 2) return speed;
  std::size_t back = 0;
  for (std::size_t k = 1; k < t.size(); ++k) {
    while (back + 1 < k && t[k] - t[back + 1] >= fix_chord_s) ++back;
    const double step_s = t[k] - t[back];
    if (step_s < 0.5 * fix_chord_s) continue;
    const double middle = 0.5 * (t[k] + t[back]);
    if (!speed.time_s.empty() && middle <= speed.time_s.back()) continue;
    speed.time_s.push_back(middle);
    speed.values.push_back(
        std::hypot(fixes.east_m[k] - fixes.east_m[back], fixes.north_m[k] - fixes.north_m[back]) /
        step_s);
  }
  // Where a receiver jumps, the speed between its fixes is not the vehicle's.
  constexpr double usual_share = 0.8, most = 2.0;
  const double limit = most * quantile(speed.values, usual_share).value_or(0.0);
  for (double& value : speed.values) value = std::min(value, limit);
  return speed;
}

ScaledAlignment align_fixes(const Signal& wheels, const LocalFixes& fixes) {
  ScaledAlignment best;
  constexpr std::array scales{1.0, 0.1, 10.0, 1e-2, 100.0, 1e-3, 1e3, 1e-6, 1e-9};
  for (const double scale : scales) {
    LocalFixes scaled = fixes;
    for (double& t : scaled.time_s) t *= scale;
    const Signal speed = speed_of(scaled);
    if (speed.time_s.size() < 5) continue;
    const double ratio = duration(speed) / duration(wheels);
    if (scale != 1.0 && (ratio > 2.0 || ratio < 0.5)) continue;
    const Alignment found = align_changes(wheels, speed, fix_change_s, {});
    // The stamps are believed unless another scale fits clearly better.
    if (found.correlation > best.alignment.correlation + (scale == 1.0 ? 0.0 : 0.1))
      best = {scale, found};
  }
  return best;
}

}  // namespace proofmass::estimate::drive
