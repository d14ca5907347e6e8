#include "proofmass/estimate/track/signal.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "proofmass/core/statistics.hpp"
#include "proofmass/signal/channel_audit.hpp"

namespace proofmass::estimate {
namespace {

Error bad(std::string message, std::vector<Advice> advice = {}) {
  return {Errc::invalid_argument, std::move(message), std::move(advice)};
}

std::string figure(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

std::array<double, 3> level_of(const TrackSignal& signal, const signal::Rest& rest) {
  std::array<double, 3> level{};
  for (std::size_t a = 0; a < signal.axes.size(); ++a)
    level[a] =
        moments(View<double>(signal.accel_mps2[a]).subspan(rest.first, rest.last - rest.first + 1))
            .mean;
  return level;
}

double norm(const std::array<double, 3>& v) {
  return std::hypot(v[0], v[1], v[2]);
}

// Median norm of the rests' levels.
std::optional<double> resting_norm(const TrackSignal& signal) {
  std::vector<double> norms;
  for (const signal::Rest& rest : signal.stops.rests) norms.push_back(norm(level_of(signal, rest)));
  return signal.axes.size() == 3 ? median(norms) : std::nullopt;
}

// At rest three axes measure gravity, zero, or values that are not in m/s².
Result<GravityContent> gravity_content(double norm_mps2, double gravity_mps2) {
  const double share = norm_mps2 / gravity_mps2;
  if (std::abs(share - 1.0) < 0.1) return GravityContent::present;
  if (std::abs(norm_mps2 - 1.0) < 0.08)
    return bad("at rest the norm of the measurements is " + figure(norm_mps2) +
                   " m/s², which is gravity in g, or an offset without gravity",
               {Advice{"unit", "g"}, Advice{"gravity", "removed"}});
  if (std::abs(share / gravity_mps2 - 1.0) < 0.1)
    return bad("at rest the norm of the measurements is " + figure(norm_mps2) +
                   " m/s², which is gravity in m/s² interpreted as g",
               {Advice{"unit", "m/s2"}});
  if (share < 0.1) return GravityContent::removed;
  return GravityContent::unknown;
}

Result<TrackSignal> gathered(const TrackSensor& sensor) {
  TrackSignal signal;
  signal.time_s = sensor.time_s;
  const std::size_t n = sensor.time_s.size();
  if (n < 8) return Error{Errc::too_few_samples, "a track needs at least 8 samples"};
  for (std::size_t k = 1; k < n; ++k)
    if (!(sensor.time_s[k] > sensor.time_s[k - 1]))
      return bad("the time does not ascend at sample " + std::to_string(k));
  for (std::size_t a = 0; a < 3; ++a) {
    if (sensor.accel_mps2[a].empty()) continue;
    if (sensor.accel_mps2[a].size() != n) return bad("an axis is not as long as the time");
    signal.axes.push_back(a);
    signal.accel_mps2.push_back(sensor.accel_mps2[a]);
  }
  if (signal.axes.empty()) return bad("no axis of an accelerometer");
  for (std::size_t k = 0; k < n; ++k) {
    bool missing = false;
    for (const auto& axis : signal.accel_mps2) missing = missing || !signal::is_plausible(axis[k]);
    if (!missing) continue;
    ++signal.missing;
    for (auto& axis : signal.accel_mps2) axis[k] = std::nan("");
  }
  if (n - signal.missing < 8) return Error{Errc::too_few_samples, "fewer than 8 readings"};
  std::vector<double> steps(n - 1);
  for (std::size_t k = 1; k < n; ++k) steps[k - 1] = sensor.time_s[k] - sensor.time_s[k - 1];
  signal.rate_hz = 1.0 / *median(steps);
  return signal;
}

}  // namespace

Result<TrackSignal> track_signal(const TrackSensor& sensor, const TrackOptions& options) {
  auto gathering = gathered(sensor);
  if (!gathering) return gathering.error();
  TrackSignal signal = std::move(gathering).value();
  std::vector<View<double>> views(signal.accel_mps2.begin(), signal.accel_mps2.end());
  signal.stops = find_stops(views, signal.time_s, signal.rate_hz, options);
  signal.resting_norm_mps2 = resting_norm(signal);
  signal.gravity = options.gravity;
  if (signal.resting_norm_mps2 && options.gravity == GravityContent::unknown) {
    const auto content = gravity_content(*signal.resting_norm_mps2, options.gravity_mps2);
    if (!content) return content.error();
    signal.gravity = *content;
  }
  for (std::size_t a = 0; a < signal.axes.size(); ++a) {
    const double level = signal.stops.rests.empty()
                             ? moments(signal.accel_mps2[a]).mean
                             : level_of(signal, signal.stops.rests.front())[a];
    signal.reference_mps2.push_back(level);
  }
  for (std::size_t a = 0; a < signal.axes.size(); ++a)
    for (double& value : signal.accel_mps2[a]) value -= signal.reference_mps2[a];
  return signal;
}

namespace {

double noise_of(const TrackSignal& signal, const signal::Rest& rest) {
  double squares = 0.0;
  for (const auto& axis : signal.accel_mps2) {
    // Differences, since a drifting level is not noise; robust against outliers in half of them.
    std::vector<double> differences;
    for (std::size_t k = rest.first + 1; k <= rest.last; ++k)
      differences.push_back(axis[k] - axis[k - 1]);
    const double scatter = robust_std(differences).value_or(0.0);
    squares += scatter * scatter;
  }
  return std::sqrt(squares);
}

}  // namespace

double RestLevel::cosine_to(const RestLevel& other) const {
  double product = 0.0;
  for (std::size_t a = 0; a < 3; ++a) product += level_mps2[a] * other.level_mps2[a];
  return product / (length_mps2 * other.length_mps2);
}

std::vector<RestLevel> rest_levels(const TrackSignal& signal) {
  std::vector<RestLevel> levels;
  for (const signal::Rest& rest : signal.stops.rests) {
    RestLevel level{level_of(signal, rest)};
    for (std::size_t a = 0; a < 3; ++a) level.level_mps2[a] += signal.reference_mps2[a];
    level.length_mps2 = norm(level.level_mps2);
    level.duration_s = signal.time_s[rest.last] - signal.time_s[rest.first];
    level.std_mps2 =
        noise_of(signal, rest) / std::sqrt(static_cast<double>(rest.last - rest.first + 1));
    levels.push_back(level);
  }
  return levels;
}

std::vector<double> rest_noises(const TrackSignal& signal) {
  std::vector<double> noise;
  for (const signal::Rest& rest : signal.stops.rests) noise.push_back(noise_of(signal, rest));
  return noise;
}

std::vector<signal::Rest> quiet_rests(const TrackSignal& signal) {
  const std::vector<double> noise = rest_noises(signal);
  std::vector<signal::Rest> quiet;
  for (std::size_t i = 0; i < noise.size(); ++i)
    if (noise[i] <= 2.0 * *std::min_element(noise.begin(), noise.end()))
      quiet.push_back(signal.stops.rests[i]);
  return quiet;
}

namespace {

// Range of the velocity integrated from a rest's measurements minus their mean, gaps left out.
double velocity_range(const TrackSignal& signal, View<double> accel, const signal::Rest& rest) {
  const double mean = moments(accel.subspan(rest.first, rest.last - rest.first + 1)).mean;
  double v = 0.0;
  Moments velocity;
  velocity.add(v);
  for (std::size_t k = rest.first + 1; k <= rest.last; ++k) {
    if (!std::isnan(accel[k])) v += (accel[k] - mean) / signal.rate_hz;
    velocity.add(v);
  }
  return velocity.max - velocity.min;
}

}  // namespace

bool may_hide_motion(const TrackSignal& signal) {
  std::size_t resting = 0;
  for (const signal::Rest& rest : signal.stops.rests) resting += rest.last - rest.first;
  if (static_cast<double>(resting) < 0.8 * static_cast<double>(signal.time_s.size() - 1))
    return false;
  constexpr double far_beyond = 8.0;
  return std::any_of(signal.accel_mps2.begin(), signal.accel_mps2.end(), [&](const auto& axis) {
    const LevelNoise noise = level_noise(axis, signal.stops.rests, signal.rate_hz);
    return std::any_of(
        signal.stops.rests.begin(), signal.stops.rests.end(), [&](const signal::Rest& rest) {
          const double length_s = static_cast<double>(rest.last - rest.first) / signal.rate_hz;
          // White noise integrates to σ √(T/rate); its range is about 1.25 of that.
          const double usual = noise.sample_std_mps2 * std::sqrt(length_s / signal.rate_hz);
          return velocity_range(signal, axis, rest) > far_beyond * usual;
        });
  });
}

std::optional<double> largest_turn_rad(const TrackSignal& signal) {
  if (signal.axes.size() != 3 || signal.gravity != GravityContent::present) return std::nullopt;
  const auto& g = signal.reference_mps2;
  double largest = 0.0;
  for (const signal::Rest& rest : signal.stops.rests) {
    const auto d = level_of(signal, rest);
    const std::array f{g[0] + d[0], g[1] + d[1], g[2] + d[2]};
    const double sine =
        norm({g[1] * f[2] - g[2] * f[1], g[2] * f[0] - g[0] * f[2], g[0] * f[1] - g[1] * f[0]});
    const double cosine = g[0] * f[0] + g[1] * f[1] + g[2] * f[2];
    largest = std::max(largest, std::atan2(sine, cosine));
  }
  return largest;
}

namespace {

// Means and scatters of a window.
struct Window {
  double length_s;
  Moments accel, velocity, position;
};

Window window_of(const TrackSeries& series,
                 const std::vector<double>& position,
                 std::size_t first,
                 std::size_t length) {
  const auto part = [&](const std::vector<double>& values) {
    return moments(View<double>(values).subspan(first, length));
  };
  return {series.time_s[first + length - 1] - series.time_s[first], part(series.accel_mps2),
          part(series.velocity_mps), part(position)};
}

// The position with every rest within three standard deviations of 0 set to 0. If no stop checks
// the velocity for long, an undetected error of the level adds a cubic that leaves the velocity at
// both ends unchanged.
std::vector<double> closed_at_rests(const TrackSignal& signal, const TrackSeries& series) {
  constexpr double within = 3.0;
  std::vector<double> position = series.position_m;
  double before = 0.0, before_s = series.time_s.front();  // of the rest before: taken off, its end
  std::size_t done = 0;
  for (const signal::Rest& rest : signal.stops.rests) {
    const double here = series.position_m[rest.first];
    const double off = std::abs(here) <= within * series.position_std_m[rest.first] ? here : 0.0;
    const double length_s = series.time_s[rest.first] - before_s;
    for (; done <= rest.last; ++done) {
      const double s = std::clamp((series.time_s[done] - before_s) / length_s, 0.0, 1.0);
      const double share = done >= rest.first ? 1.0 : s * s * (3.0 - 2.0 * s);
      position[done] -= std::lerp(before, off, share);
    }
    before = off;
    before_s = series.time_s[rest.last];
  }
  for (; done < position.size(); ++done) position[done] -= before;
  return position;
}

double largest(const std::vector<double>& values) {
  double most = 0.0;
  for (const double value : values) most = std::max(most, std::abs(value));
  return most;
}

}  // namespace

JerkSuspicion suspect_jerk(const TrackSignal& signal, const TrackSeries& series) {
  JerkSuspicion found;
  const std::size_t n = series.time_s.size();
  if (signal.gravity == GravityContent::present || signal.stops.rests.empty()) return found;
  const std::vector<double> position = closed_at_rests(signal, series);
  const double far = largest(position), fastest = largest(series.velocity_mps);
  std::vector<unsigned char> resting(n, 0);
  double at_rests = 0.0;
  Moments still;
  for (const signal::Rest& rest : quiet_rests(signal))
    for (std::size_t k = rest.first; k <= rest.last; ++k) {
      resting[k] = 1;
      at_rests = std::max(at_rests, std::abs(position[k]));
      still.add(series.accel_mps2[k]);
    }
  double cruising_far = 0.0;
  const auto length = static_cast<std::size_t>(std::max(8.0, std::round(signal.rate_hz)));
  for (std::size_t first = 0; first + length <= n; first += length) {
    const auto begin = resting.begin() + static_cast<std::ptrdiff_t>(first);
    if (std::find(begin, begin + static_cast<std::ptrdiff_t>(length), 1) !=
        begin + static_cast<std::ptrdiff_t>(length))
      continue;
    const Window window = window_of(series, position, first, length);
    const bool cruising = std::abs(window.velocity.mean) < 0.15 * fastest &&
                          window.velocity.std() < 0.05 * fastest &&
                          window.accel.std() > 1.25 * still.std();
    (cruising ? found.cruising_s : found.pushing_s) += window.length_s;
    if (cruising) cruising_far = std::max(cruising_far, std::abs(window.position.mean));
  }
  found.suspected = found.cruising_s > 5.0 && found.cruising_s > found.pushing_s &&
                    cruising_far > 0.5 * far && at_rests < 0.25 * far;
  return found;
}

}  // namespace proofmass::estimate
