#include "proofmass/estimate/track/live_rests.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace proofmass::estimate {
namespace {

/// An end of a rest that is undecided for longer counts as motion.
constexpr double longest_doubt_s = 1.0;

/// N² from the Allan variance of means over half a second, or the longest time with ten pairs; it
/// includes noise correlated within that time.
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

LiveTrackRests::LiveTrackRests(const Triad& sensor)
    : name_(sensor.name), rests_(sensor.axes(), {}) {
  if (sensor.x) axes_.push_back(0);
  if (sensor.y) axes_.push_back(1);
  if (sensor.z) axes_.push_back(2);
}

/// Returns true if a block is complete.
bool LiveTrackRests::take(const LiveEpoch& epoch) {
  const Mat<3>& accel = epoch.vectors[0];
  std::array<double, 3> values{};
  std::size_t axes = 0;
  for (const Eigen::Index i : axes_) values[axes++] = accel(i);
  if (any_) {
    constexpr double remembered = 200.0, longest = 4.0;
    const double step_s = epoch.time_s - last_s_;
    steps_ = std::min(steps_ + 1.0, remembered);
    step_s_ += (steps_ > 1.0 ? std::min(step_s, longest * step_s_) - step_s_ : step_s) / steps_;
  }
  any_ = true;
  last_s_ = epoch.time_s;
  if (epoch.has(0)) held_.push_back({epoch.time_s, accel});
  return rests_.add(epoch.time_s, View<double>(values).first(axes));
}

double LiveTrackRests::known_until_s() {
  const signal::RestState& state = rests_.state();
  const bool was_stuck = std::exchange(stuck_, state.phase == signal::RestPhase::stuck);
  if (stuck_) {
    held_.clear();
    if (!was_stuck)
      notes_.push_back({Severity::warning, name_ + ": a constant value is repeated at " +
                                               at_second(state.newest_s) +
                                               " s: such samples are excluded from the estimate"});
  }
  if (state.phase != signal::RestPhase::resting) return last_s_;
  if (!look_at_rest(state)) return last_s_;
  return state.newest_s - state.until_s < longest_doubt_s ? state.until_s : state.newest_s;
}

/// Returns false if its means scatter more than in any rest: it is motion that was classified as
/// noise.
bool LiveTrackRests::look_at_rest(const signal::RestState& state) {
  const Mat<3> white_m2ps3 = white_of_rest(state);
  constexpr double louder = 25.0;            // as a density: five times as a standard deviation
  constexpr std::size_t most_refused = 512;  // blocks: the memory of the rest search
  if (quietest_m2ps3_ > 0.0 && white_m2ps3.sum() > louder * quietest_m2ps3_ &&
      ++refused_ < most_refused)
    return false;
  const bool first = quietest_m2ps3_ == 0.0 || refused_ >= most_refused;
  quietest_m2ps3_ = first ? white_m2ps3.sum() : std::min(quietest_m2ps3_, white_m2ps3.sum());
  refused_ = 0;
  rest_.since_s = state.since_s;
  rest_.until_s = state.until_s;
  rest_.behind_level_s = static_cast<double>(state.samples) * step_s_;
  rest_.white_m2ps3 = white_m2ps3;
  std::size_t axis = 0;
  for (const Eigen::Index i : axes_) rest_.level_mps2(i) = state.mean[axis++];
  return true;
}

Mat<3> LiveTrackRests::white_of_rest(const signal::RestState& state) const {
  constexpr double least_m2ps3 = 1e-16;
  Mat<3> white_m2ps3 = Mat<3>::Zero();
  std::size_t axis = 0;
  for (const Eigen::Index i : axes_) {
    const double rounding = state.step[axis] * state.step[axis] / 12.0 * step_s_;
    const double scatter = white_of(rests_.levels(axis), step_s_);
    white_m2ps3(i) = std::max({scatter, rounding, least_m2ps3});
    ++axis;
  }
  return white_m2ps3;
}

std::vector<Note> LiveTrackRests::take_notes() {
  return std::exchange(notes_, {});
}

}  // namespace proofmass::estimate
