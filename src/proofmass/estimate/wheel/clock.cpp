#include "proofmass/estimate/wheel/clock.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "proofmass/core/statistics.hpp"

namespace proofmass::estimate {
namespace {

double interpolated(const std::vector<double>& x, const std::vector<double>& y, double at) {
  const auto above = std::ranges::upper_bound(x, at) - x.begin();
  const auto i = std::clamp<std::size_t>(static_cast<std::size_t>(above), 1, x.size() - 1);
  return std::lerp(y[i - 1], y[i], (at - x[i - 1]) / (x[i] - x[i - 1]));
}

bool is_lost(const WheelMotion& motion, double t) {
  return std::ranges::any_of(motion.lost, [t](const LostInterval& interval) {
    return t >= interval.from_s && t <= interval.to_s;
  });
}

/// The first's times on a grid of 20 Hz at which the shifted second has measurements too, and
/// neither is lost.
std::vector<double> common_times(const WheelMotion& first,
                                 const WheelMotion& second,
                                 double offset_s) {
  const double start = std::max(first.time_s->front(), second.time_s->front() - offset_s);
  const double end = std::min(first.time_s->back(), second.time_s->back() - offset_s);
  std::vector<double> times;
  for (double t = start; t <= end; t += 0.05)
    if (!is_lost(first, t) && !is_lost(second, t + offset_s)) times.push_back(t);
  return times;
}

/// Mean square difference of the speeds at an offset; infinite where less than half of the shorter
/// recording is shared.
double speed_mismatch(const WheelMotion& first, const WheelMotion& second, double offset_s) {
  const auto times = common_times(first, second, offset_s);
  const double shorter = std::min(first.time_s->back() - first.time_s->front(),
                                  second.time_s->back() - second.time_s->front());
  if (times.size() < 20 || times.back() - times.front() < 0.5 * shorter)
    return std::numeric_limits<double>::infinity();
  double sum = 0.0;
  for (const double t : times)
    sum += std::pow(interpolated(*first.time_s, *first.speed_radps, t) -
                        interpolated(*second.time_s, *second.speed_radps, t + offset_s),
                    2);
  return sum / static_cast<double>(times.size());
}

double coarse_offset(const WheelMotion& first, const WheelMotion& second) {
  const double widest = std::max(first.time_s->back() - first.time_s->front(),
                                 second.time_s->back() - second.time_s->front());
  const double centre = second.time_s->front() - first.time_s->front();
  double best = centre, least = std::numeric_limits<double>::infinity();
  for (double offset = centre - 0.5 * widest; offset <= centre + 0.5 * widest; offset += 0.1) {
    const double mismatch = speed_mismatch(first, second, offset);
    if (mismatch < least) {
      least = mismatch;
      best = offset;
    }
  }
  return best;
}

struct Slope {
  double slope = 0.0, std = 0.0, level = 0.0;
  double speed_spread = 0.0;
};

/// Difference of the angles against the speed: slope −δ, level the phase. The differences are far
/// from independent, so the slope's scatter is the jackknife's over ten blocks. Source: B. Efron,
/// The Jackknife, the Bootstrap and Other Resampling Plans (1982), chapter 3.
Slope slope_of(const std::vector<double>& speed, const std::vector<double>& difference) {
  constexpr std::size_t blocks = 10;
  const auto fit = [&](std::size_t without) {
    double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (std::size_t i = 0; i < speed.size(); ++i) {
      if (i * blocks / speed.size() == without) continue;
      n += 1.0;
      sx += speed[i];
      sy += difference[i];
      sxx += speed[i] * speed[i];
      sxy += speed[i] * difference[i];
    }
    const double spread = sxx - sx * sx / n;
    const double slope = spread > 0.0 ? (sxy - sx * sy / n) / spread : 0.0;
    return Slope{slope, 0.0, (sy - slope * sx) / n, std::sqrt(std::max(spread, 0.0) / n)};
  };
  Slope all = fit(blocks);
  double scatter = 0.0;
  for (std::size_t b = 0; b < blocks; ++b) scatter += std::pow(fit(b).slope - all.slope, 2);
  all.std = std::sqrt(scatter * (blocks - 1.0) / blocks);
  return all;
}

/// second(t + offset) − first(t), unwrapped.
std::vector<double> angle_difference(const WheelMotion& first,
                                     const WheelMotion& second,
                                     const std::vector<double>& times,
                                     double offset_s) {
  std::vector<double> difference;
  for (const double t : times) {
    const double turned = interpolated(*second.time_s, *second.angle_rad, t + offset_s) -
                          interpolated(*first.time_s, *first.angle_rad, t);
    const double before = difference.empty() ? turned : difference.back();
    difference.push_back(before + std::remainder(turned - before, 2.0 * std::numbers::pi));
  }
  return difference;
}

constexpr std::size_t fewest_times = 20;

/// Stamps that both begin at zero look like one clock but need not be: the speeds decide.
bool are_better_elsewhere(const WheelMotion& first, const WheelMotion& second, double apart) {
  constexpr double same_speed_radps = 0.3;
  return apart > same_speed_radps * same_speed_radps &&
         speed_mismatch(first, second, coarse_offset(first, second)) < 0.25 * apart;
}

Error nothing_shared() {
  return {Errc::not_observable, "the two recordings share less than a second"};
}

}  // namespace

Result<ClockFit> fit_phase(const WheelMotion& first, const WheelMotion& second) {
  const auto times = common_times(first, second, 0.0);
  if (times.size() < fewest_times) return nothing_shared();
  const double phase = *median(angle_difference(first, second, times, 0.0));
  return ClockFit{{0.0, 0.0}, std::remainder(phase, 2.0 * std::numbers::pi)};
}

Result<ClockFit> fit_clocks(const WheelMotion& first,
                            const WheelMotion& second,
                            bool clocks_shared) {
  const double apart = speed_mismatch(first, second, 0.0);
  if (are_better_elsewhere(first, second, apart)) clocks_shared = false;
  double offset_s = clocks_shared ? 0.0 : coarse_offset(first, second);
  Slope slope;
  for (int round = 0; round < 4; ++round) {
    const auto times = common_times(first, second, offset_s);
    if (times.size() < fewest_times) return nothing_shared();
    const std::vector<double> difference = angle_difference(first, second, times, offset_s);
    std::vector<double> speed;
    for (const double t : times)
      speed.push_back(interpolated(*first.time_s, *first.speed_radps, t));
    slope = slope_of(speed, difference);
    if (slope.speed_spread < 0.05) {
      if (clocks_shared) return ClockFit{{0.0, 0.0}, *median(difference)};
      return Error{Errc::not_observable,
                   "two clocks cannot be aligned at one speed: stop, start or change speed once"};
    }
    // second(t + o) − first(t) = phase + ω δ where the offset is short by −δ.
    const double move = -slope.slope;
    // Stamps of one clock are further apart only if that explains the difference of the speeds.
    if (clocks_shared && std::abs(offset_s + move) > 0.1 &&
        !(speed_mismatch(first, second, offset_s + move) < 0.25 * apart))
      break;
    offset_s += move;
    if (std::abs(move) < 1e-5) break;
  }
  return ClockFit{{offset_s, slope.std}, std::remainder(slope.level, 2.0 * std::numbers::pi)};
}

}  // namespace proofmass::estimate
