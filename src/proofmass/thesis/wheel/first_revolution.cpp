#include "proofmass/thesis/wheel/first_revolution.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "proofmass/core/units.hpp"

namespace proofmass::thesis {
namespace {

constexpr double still = 0.02;  // of the highest speed

struct Span {
  std::size_t first = 0, last = 0;
};

/// The first revolution by an angle that rises; from where it leaves its rest, if it starts at one.
Span first_revolution(const std::vector<double>& angle_rad,
                      const std::vector<double>& speed_radps,
                      bool from_rest) {
  constexpr double moved_rad = 1.0 * rad_per_deg;
  const std::size_t last = angle_rad.size() - 1;
  Span span;
  if (from_rest) {
    while (span.first < last && std::abs(angle_rad[span.first] - angle_rad.front()) < moved_rad)
      ++span.first;
    const double slow = still * *std::ranges::max_element(speed_radps);
    while (span.first > 0 && std::abs(speed_radps[span.first]) > slow) --span.first;
  }
  span.last = span.first;
  while (span.last < last && angle_rad[span.last] - angle_rad[span.first] < rad_per_turn)
    ++span.last;
  return span;
}

void cut(std::vector<double>& values, const Span& span) {
  values = {values.begin() + static_cast<std::ptrdiff_t>(span.first),
            values.begin() + static_cast<std::ptrdiff_t>(span.last) + 1};
}

/// Angles are known up to whole turns: brought to where the reference is.
void count_with(const std::vector<double>& reference_rad, std::vector<double>& angle_rad) {
  const double off = angle_rad.back() - reference_rad.back();
  const double turns_rad = off - std::remainder(off, rad_per_turn);
  for (double& angle : angle_rad) angle -= turns_rad;
}

/// Over the fastest of the whole turns, counted back from the end, or over what there is of one:
/// neither ramp nor rest. Turns that overlap would be picked by their noise.
Uncertain speed_of(const std::vector<double>& time_s, const AngleEstimate& smoothed) {
  const std::vector<double>& angle_rad = smoothed.angle_rad;
  const auto between = [&](std::size_t from, std::size_t to) {
    const double lasted_s = time_s[to] - time_s[from];
    return Uncertain{(angle_rad[to] - angle_rad[from]) / lasted_s,
                     std::hypot(smoothed.std_rad[from], smoothed.std_rad[to]) / lasted_s};
  };
  std::optional<Uncertain> fastest;
  std::size_t last = time_s.size() - 1;
  for (std::size_t k = last; k-- > 0;) {
    if (angle_rad[last] - angle_rad[k] < rad_per_turn) continue;
    const Uncertain speed = between(k, last);
    if (!fastest || speed.value > fastest->value) fastest = speed;
    last = k;
  }
  return fastest ? *fastest : between(0, time_s.size() - 1);
}

void cut_to(const Span& span, FirstTurn& turn) {
  for (auto& sensor : turn.force_mps2)
    for (auto& axis : sensor) cut(axis, span);
  for (auto* values : {&turn.time_s, &turn.angle_rad, &turn.speed_radps, &turn.accel_radps2,
                       &turn.filtered.angle_rad, &turn.filtered.std_rad, &turn.smoothed.angle_rad,
                       &turn.smoothed.std_rad, &turn.smoothed_accel_radps2, &turn.moved_std_rad})
    if (!values->empty()) cut(*values, span);
  const double start_s = turn.time_s.front();
  for (double& t : turn.time_s) t -= start_s;
}

}  // namespace

void cut_to_first_revolution(FirstTurn& turn) {
  turn.mean_speed_radps = speed_of(turn.time_s, turn.smoothed);
  turn.from_rest =
      std::abs(turn.speed_radps.front()) < still * *std::ranges::max_element(turn.speed_radps);
  // The rig is known to start with its first sample.
  const bool rests = turn.from_rest && !turn.simulated;
  cut_to(first_revolution(turn.angle_rad, turn.speed_radps, rests), turn);
  turn.whole = turn.angle_rad.back() - turn.angle_rad.front() >= rad_per_turn;
  count_with(turn.angle_rad, turn.filtered.angle_rad);
  count_with(turn.angle_rad, turn.smoothed.angle_rad);
}

}  // namespace proofmass::thesis
