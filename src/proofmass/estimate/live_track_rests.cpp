#include "proofmass/estimate/live_track_rests.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace proofmass::estimate {
namespace {

/// An end of a rest that is not settled for so long is taken for motion.
constexpr double longest_doubt_s = 1.0;

/// N² by the Allan variance of means over half a second, or as long as ten pairs tell; whatever
/// correlates the noise within that is in it.
double white_of(const std::vector<signal::AllanLevel>& levels, double step_s) {
  constexpr double longest_s = 0.5, fewest_pairs = 10.0;
  double white_m2ps3 = 0.0;
  for (const signal::AllanLevel& level : levels) {
    const double mean_over_s = level.samples * step_s;
    const bool tells = level.pairs >= fewest_pairs && mean_over_s <= longest_s * 1.1;
    if (level.samples == 1.0 || tells) white_m2ps3 = level.variance * mean_over_s;
  }
  return white_m2ps3;
}

}  // namespace

LiveTrackRests::LiveTrackRests(const Triad& sensor) : sensor_(sensor), rests_(sensor.axes(), {}) {}

/// True: a block is full.
bool LiveTrackRests::take(const LiveInstant& instant) {
  const Mat<3>& accel = instant.vectors[0];
  std::array<double, 3> values{};
  std::size_t axes = 0;
  if (sensor_.x) values[axes++] = accel(0);
  if (sensor_.y) values[axes++] = accel(1);
  if (sensor_.z) values[axes++] = accel(2);
  if (any_) {
    constexpr double remembered = 200.0, longest = 4.0;
    const double step_s = instant.time_s - last_s_;
    steps_ = std::min(steps_ + 1.0, remembered);
    step_s_ += (steps_ > 1.0 ? std::min(step_s, longest * step_s_) - step_s_ : step_s) / steps_;
  }
  any_ = true;
  last_s_ = instant.time_s;
  if (instant.has(0)) held_.push_back({instant.time_s, accel});
  return rests_.add(instant.time_s, View<double>(values).first(axes));
}

double LiveTrackRests::known_until_s() {
  const signal::RestState& state = rests_.state();
  const bool was_stuck = std::exchange(stuck_, state.phase == signal::RestPhase::stuck);
  if (stuck_) {
    held_.clear();
    if (!was_stuck)
      notes_.push_back({Severity::warning, sensor_.name + ": one reading is repeated at " +
                                               at_second(state.newest_s) +
                                               " s: such readings are left out of the estimate"});
  }
  if (state.phase != signal::RestPhase::resting) return last_s_;
  look_at_rest(state);
  return state.newest_s - state.until_s < longest_doubt_s ? state.until_s : state.newest_s;
}

void LiveTrackRests::look_at_rest(const signal::RestState& state) {
  rest_.since_s = state.since_s;
  rest_.until_s = state.until_s;
  rest_.behind_level_s = static_cast<double>(state.samples) * step_s_;
  const std::array there{sensor_.x.has_value(), sensor_.y.has_value(), sensor_.z.has_value()};
  std::size_t axis = 0;
  for (std::size_t i = 0; i < there.size(); ++i) {
    if (!there[i]) continue;
    const double rounding = state.step[axis] * state.step[axis] / 12.0 * step_s_;
    constexpr double least_m2ps3 = 1e-16;
    const auto to = static_cast<Eigen::Index>(i);
    rest_.level_mps2(to) = state.mean[axis];
    rest_.white_m2ps3(to) =
        std::max({white_of(rests_.levels(axis), step_s_), rounding, least_m2ps3});
    ++axis;
  }
}

std::vector<Note> LiveTrackRests::take_notes() {
  return std::exchange(notes_, {});
}

}  // namespace proofmass::estimate
