#include "proofmass/estimate/track/live_filter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "proofmass/core/statistics.hpp"

namespace proofmass::estimate {
namespace {

using inertial_axis::position_m;
using inertial_axis::velocity_mps;

/// Limits the influence of a shock or outlier at rest to that of three standard deviations.
constexpr double resting_huber = 3.0;
/// Minimum of an unmeasured acceleration, and its duration.
constexpr double unread_accel_mps2 = 1.0, unread_time_s = 1.0;

}  // namespace

LiveTrackFilter::LiveTrackFilter(const LiveTrackSetup& setup,
                                 const LiveTrackSample& begin,
                                 const LiveLevel& level)
    : setup_(setup),
      state_(inertial_start({.speed_std_mps = setup.rest_speed_std_mps,
                             .bias_mps2 = level.mps2,
                             .bias_std_mps2 = std::sqrt(level.variance)})),
      window_(setup.lag),
      times_s_(setup.lag + 1),
      last_(begin) {
  last_.resting = true;
  step_.F.setIdentity();
  step_.filtered = state_.x;
  window_.push(step_);
  times_s_[epoch_count_++] = begin.time_s;
}

void LiveTrackFilter::step(const LiveTrackSample& sample, const LiveLevel& rest) {
  if (last_.resting && !sample.resting) leave();
  const bool arrives = !last_.resting && sample.resting;
  epochs_[1] = epoch_to(sample, rest);
  const bool gap = !epochs_[1].resting && epochs_[1].dt_s > setup_.longest_step_s;
  has_gap_ = has_gap_ || gap;
  const InertialAxis model{epochs_, noise_of(epochs_[1], gap)};
  Gate gate;
  if (epochs_[1].resting) gate.huber = resting_huber;
  advance(model, 1, gate, state_, step_);
  window_.push(step_);
  times_s_[epoch_count_++ % times_s_.size()] = sample.time_s;
  if (!sample.resting) {
    moved_s_ += epochs_[1].dt_s;
    accel_square_ +=
        epochs_[1].dt_s * square(sample.accel_mps2 - state_.x.mean(inertial_axis::bias_mps2));
    fastest_mps_ = std::max(fastest_mps_, std::abs(state_.x.mean(velocity_mps)));
  }
  last_ = sample;
  if (arrives) arrive(rest);
}

InertialEpoch LiveTrackFilter::epoch_to(const LiveTrackSample& sample, const LiveLevel& rest) {
  InertialEpoch epoch;
  const double h = epoch.dt_s = sample.time_s - last_.time_s;
  if (last_.resting && sample.resting) {
    epoch.resting = true;
    epoch.level_mps2 = sample.accel_mps2;
    epoch.level_variance = setup_.white_m2ps3 / h;
    return epoch;
  }
  epoch.velocity_step_mps = 0.5 * h * (last_.accel_mps2 + sample.accel_mps2);
  epoch.position_step_m = h * h * (last_.accel_mps2 / 3.0 + sample.accel_mps2 / 6.0);
  epoch.leaves_rest = last_.resting;
  if (!sample.resting) return epoch;
  epoch.arrives_at_rest = true;
  epoch.velocity_std_mps = setup_.rest_speed_std_mps;
  epoch.level_mps2 = rest.mps2;
  epoch.level_variance = rest.variance;
  return epoch;
}

/// In a gap the acceleration is white over times longer than `unread_time_s`: a constant one would
/// be determined by the next stop, together with the displacement.
InertialNoise LiveTrackFilter::noise_of(const InertialEpoch& epoch, bool gap) const {
  const double scale = scale_.scale();
  InertialNoise noise{
      .white_m2ps3 = setup_.white_m2ps3,
      .motion_lean_m2ps3 = scale * usual_lean_m2ps3,
      .motion_walk_m2ps5 = std::max(scale * usual_walk_m2ps5, setup_.rest_walk_m2ps5),
      .motion_jump_m2ps4 = scale * usual_jump_m2ps4,
      .rest_walk_m2ps5 = setup_.rest_walk_m2ps5,
      .rest_speed_std_mps = setup_.rest_speed_std_mps};
  if (gap) {
    const double mean_square = moved_s_ > 0.0 ? accel_square_ / moved_s_ : 0.0;
    noise.motion_lean_m2ps3 +=
        std::max(mean_square, square(unread_accel_mps2)) * std::min(epoch.dt_s, unread_time_s);
  }
  return noise;
}

void LiveTrackFilter::leave() {
  left_s_ = last_.time_s;
  left_variance_m2_ = state_.x.cov(position_m, position_m);
  fastest_mps_ = 0.0;
  has_gap_ = false;
}

/// The closure velocity determines the scale of the errors in motion, and thereby its own
/// uncertainty.
void LiveTrackFilter::arrive(const LiveLevel& rest) {
  const double elapsed_s = last_.time_s - left_s_;
  excess_variance_m2_ += rest.moved_m2ps4 * square(square(elapsed_s)) / 64.0;
  const Update<3>& closure = step_.updates[0];
  const double usual = usual_velocity_variance(elapsed_s);
  const double known = std::max(closure.expected - scale_.scale() * usual, 0.01 * closure.expected);
  if (has_gap_ || fastest_mps_ < 5.0 * std::sqrt(known)) return;
  scale_.learn(closure.innovation, known, usual);
  set_left_open((known + scale_.scale() * usual) * square(elapsed_s) / 12.0);
}

/// Position uncertainty since the last stop that remains after a closure. If all errors were white,
/// their ∫∫ given their ∫ would have T²/12 times the variance of ∫; jumps and random walks leave
/// less. The states of the smoother's window are in the past: their uncertainty can only be
/// increased.
void LiveTrackFilter::set_left_open(double variance_m2) {
  const double variance = state_.x.cov(position_m, position_m);
  const double meant = left_variance_m2_ + variance_m2;
  if (meant > variance) {
    excess_variance_m2_ += meant - variance;
    return;
  }
  const double shrink = std::sqrt(meant / variance);
  state_.x.cov.row(position_m) *= shrink;
  state_.x.cov.col(position_m) *= shrink;
}

bool LiveTrackFilter::is_cruising() const {
  constexpr double far_off = 24.0;  // χ² of one, p = 1e-6
  const double speed = state_.x.mean(velocity_mps);
  const double cautious =
      (scale_.scale() - scale_.middle()) * usual_velocity_variance(last_.time_s - left_s_);
  const double expected = state_.x.cov(velocity_mps, velocity_mps) - std::max(cautious, 0.0);
  return std::abs(speed) > 0.5 * fastest_mps_ && speed * speed > far_off * expected;
}

Uncertain LiveTrackFilter::position(const Gaussian<3>& x) const {
  const double at = x.mean(position_m);
  return {at, std::sqrt(std::max(x.cov(position_m, position_m), 0.0) + excess_variance_m2_ +
                        square(setup_.scale_std * at))};
}

LiveTrackRow LiveTrackFilter::row() const {
  LiveTrackRow row;
  row.position_m = position(state_.x);
  const double speed = state_.x.mean(velocity_mps);
  row.velocity_mps = {speed, std::sqrt(std::max(state_.x.cov(velocity_mps, velocity_mps), 0.0) +
                                       square(setup_.scale_std * speed))};
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  row.smoothed_time_s = none;
  row.smoothed_position_m = {none, none};
  if (window_.size() <= window_.lag()) return row;
  row.smoothed_time_s = times_s_[epoch_count_ % times_s_.size()];
  row.smoothed_position_m = position(window_.state(window_.lag()));
  return row;
}

}  // namespace proofmass::estimate
