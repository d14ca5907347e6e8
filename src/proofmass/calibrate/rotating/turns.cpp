#include "proofmass/calibrate/rotating/turns.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "proofmass/core/statistics.hpp"
#include "proofmass/core/units.hpp"

namespace proofmass::calibrate {
namespace {

constexpr std::size_t least_turns = 8;
constexpr double most_change = 0.08;
constexpr double least_samples_per_turn = 16.0;

// Rises of the readings from below −0.4 to above 0.4 of their amplitude about their middle.
std::vector<double> rises(View<double> time_s, View<double> readings) {
  std::vector<double> at;
  const auto low = quantile(readings, 0.05), high = quantile(readings, 0.95);
  if (!low || !high || !(*high > *low)) return at;
  const double middle = 0.5 * (*low + *high), threshold = 0.2 * (*high - *low);
  bool below = false;
  double left_s = 0.0;  // the last time below
  for (std::size_t k = 0; k < readings.size(); ++k) {
    const double x = readings[k] - middle;
    if (x < -threshold) {
      below = true;
      left_s = time_s[k];
    } else if (below && x > threshold) {
      at.push_back(0.5 * (left_s + time_s[k]));
      below = false;
    }
  }
  return at;
}

// When the angle passes whole turns, whichever way.
std::vector<double> passes(View<double> time_s, View<double> angle_rad) {
  std::vector<double> at;
  double before = 0.0, before_s = 0.0;
  bool any = false;
  for (std::size_t k = 0; k < angle_rad.size(); ++k) {
    const double now = angle_rad[k] / rad_per_turn;
    if (!std::isfinite(now)) continue;
    if (any && std::floor(now) != std::floor(before)) {
      const double whole = std::max(std::floor(now), std::floor(before));
      at.push_back(before_s + (whole - before) / (now - before) * (time_s[k] - before_s));
    }
    before = now;
    before_s = time_s[k];
    any = true;
  }
  return at;
}

// The longest step between samples within each turn.
std::vector<double> longest_steps(View<double> time_s, const std::vector<double>& turn_s) {
  std::vector<double> steps(turn_s.size() < 2 ? 0 : turn_s.size() - 1, 0.0);
  std::size_t turn = 0;
  for (std::size_t k = 1; k < time_s.size(); ++k) {
    while (turn < steps.size() && time_s[k] > turn_s[turn + 1]) {
      steps[turn] = std::max(steps[turn], turn_s[turn + 1] - time_s[k - 1]);
      ++turn;
    }
    if (turn == steps.size()) break;
    if (time_s[k - 1] >= turn_s[turn]) {
      steps[turn] = std::max(steps[turn], time_s[k] - time_s[k - 1]);
    }
  }
  return steps;
}

bool alike(double a, double b) {
  return std::abs(a - b) < most_change * std::min(a, b);
}

}  // namespace

std::vector<std::size_t> axes_in_plane(View<View<double>> readings) {
  std::vector<double> range;
  for (const View<double>& one : readings) {
    const auto low = quantile(one, 0.05), high = quantile(one, 0.95);
    range.push_back(low && high ? *high - *low : 0.0);
  }
  std::vector<std::size_t> order(readings.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order,
                           [&](std::size_t a, std::size_t b) { return range[a] > range[b]; });
  order.resize(std::min<std::size_t>(order.size(), 2));
  if (order.size() == 2 && range[order[1]] < 0.5 * range[order[0]]) order.pop_back();
  std::ranges::sort(order);
  return order;
}

std::vector<double> counted_on(View<double> angle_rad) {
  std::vector<double> counted(angle_rad.begin(), angle_rad.end());
  double turns = 0.0;
  std::optional<double> before;
  for (double& angle : counted) {
    if (!std::isfinite(angle)) continue;
    if (before) turns -= std::round((angle - *before) / rad_per_turn);
    before = angle;
    angle += turns * rad_per_turn;
  }
  return counted;
}

void find_turns(const RotationRecording& recording, std::size_t number, FoundTurns& found) {
  const std::vector<double>& time_s = recording.time_s;
  const std::vector<double> turn_s = recording.angle_rad.empty()
                                         ? rises(time_s, recording.axes.front())
                                         : passes(time_s, recording.angle_rad);
  found.recorded_s += time_s.back() - time_s.front();
  if (turn_s.size() < 2) return;
  const std::vector<double> step_s = longest_steps(time_s, turn_s);
  const std::size_t turns = step_s.size();
  found.turns += turns;
  const auto duration = [&](std::size_t k) { return turn_s[k + 1] - turn_s[k]; };
  const auto steady = [&](std::size_t k) {
    return step_s[k] * least_samples_per_turn < duration(k) &&
           (k == 0 || alike(duration(k), duration(k - 1))) &&
           (k + 1 == turns || alike(duration(k), duration(k + 1)));
  };
  for (std::size_t begin = 0; begin < turns;) {
    std::size_t end = begin;
    while (end < turns && steady(end)) ++end;
    if (end - begin >= least_turns) {
      SteadyTurns section;
      section.recording = number;
      const auto at = static_cast<std::ptrdiff_t>(begin);
      section.turn_s.assign(turn_s.begin() + at,
                            turn_s.begin() + at + static_cast<std::ptrdiff_t>(end - begin) + 1);
      const auto first = std::ranges::lower_bound(time_s, section.turn_s.front());
      const auto last = std::ranges::lower_bound(time_s, section.turn_s.back());
      section.first = static_cast<std::size_t>(first - time_s.begin());
      section.last = static_cast<std::size_t>(last - time_s.begin()) - 1;
      found.steady_s += section.turn_s.back() - section.turn_s.front();
      found.sections.push_back(std::move(section));
    }
    begin = std::max(end, begin + 1);
  }
}

}  // namespace proofmass::calibrate
