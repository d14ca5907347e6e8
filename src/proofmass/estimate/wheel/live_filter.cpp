#include "proofmass/estimate/wheel/live_filter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "proofmass/core/statistics.hpp"

namespace proofmass::estimate {
namespace {

/// wheel_gate without its patience, which notice_surprise() replaces.
constexpr Gate live_gate{wheel_gate.huber, wheel_gate.limit, std::numeric_limits<int>::max()};

/// Interval over which the noise is estimated.
constexpr double stretch_s = 1.0;
/// Ratio of the alternative noise to the filter's own.
constexpr double rival_factor = 3.1622776601683795;
/// A smoothed mean NIS beyond this is significant: the motion exceeds the noise model.
constexpr double surprising = 4.0;
constexpr double surprise_epochs = 10.0;
/// An innovation beyond this share of gravity is a lost phase rather than vibration of the hub.
constexpr double most_shaking = 0.5;
/// An innovation of a gyroscope beyond 0.1 rad/s, squared, is motion rather than vibration.
constexpr double most_rate_noise2 = 0.01;
/// White jerk of a wheel turned by hand, rad²/s⁵: the level to which the noise is raised at once.
constexpr double lively_jerk_psd = 100.0;
/// Limits of the motion noise. Noise that was reduced during a cruise takes seconds to grow again:
/// a gyroscope, which measures the speed by itself, needs no smoother motion than a motor's.
constexpr double least_jerk_psd = 1e-4, least_jerk_psd_by_gyro = 0.1, most_jerk_psd = 1e4,
                 least_bias_walk_psd = 2e-5;
/// Above this the angle is lost.
constexpr double lost_std_rad = 0.8;

double along(const Mat<3>& vector, const Axis& axis) {
  return vector(0) * axis[0] + vector(1) * axis[1] + vector(2) * axis[2];
}

template <class Model>
void scale_motion(Model& model, double factor) {
  const double least = model.with_gyro ? least_jerk_psd_by_gyro : least_jerk_psd;
  model.noise.jerk_psd = std::clamp(model.noise.jerk_psd * factor, least, most_jerk_psd);
  model.noise.snap_psd *= factor;
}

template <int N>
void widen_motion(Gaussian<N>& x) {
  // Additional uncertainty, independent of the state: covariances with the past stay valid.
  for (int i = 0; i < wheel::moving; ++i) x.cov(i, i) *= 4.0;
}

template <class Step>
double log_likelihood_of(const Step& step) {
  double sum = 0.0;
  for (int i = 0; i < step.count; ++i) {
    const auto& u = step.updates[static_cast<std::size_t>(i)];
    sum -= 0.5 * (std::log(2.0 * std::numbers::pi * u.expected) + surprise(std::sqrt(u.nis())));
  }
  return sum;
}

}  // namespace

template <int S>
LiveWheelFilter<S>::LiveWheelFilter(const LiveWheelOptions& options,
                                    const LiveWheelStart& start,
                                    std::size_t lag_epochs)
    : planes_(start.planes),
      variance_m2ps4_(start.variance_m2ps4),
      alignment_variance_rad2_(square(options.wheel.alignment_std_rad)),
      delay_std_s_(start.delay_s.std),
      window_(lag_epochs),
      window_time_s_(lag_epochs + 1),
      window_places_(lag_epochs + 1) {
  now_.gravity_mps2 = start.gravity_mps2;
  now_.rolling_radius_m.value = start.rolling_radius_m;
  now_.phase_rad = start.phase_rad;
  now_.delay_s = start.delay_s;
  now_.epochs.assign(2, {0.0, {0, S == 2 ? 0 : WheelEpoch::no_row}});
  for (std::size_t s = 0; s < static_cast<std::size_t>(S); ++s) {
    jerks_.emplace_back(start.rate_hz, start.speed_scatter2[s], GyroJerk::Evidence::two);
    now_.sensors.push_back({{0.0}, {0.0}, {variance_m2ps4_[s]}});
    if (!(start.speed_variance[s] > 0.0)) continue;
    gyroscope_at_[s] = gyroscope_at(options, s);
    for (auto* rates : {&now_.sensors[s].speed_radps, &now_.sensors[s].rate_u_radps,
                        &now_.sensors[s].rate_v_radps})
      *rates = {std::numeric_limits<double>::quiet_NaN()};
    now_.sensors[s].speed_variance = start.speed_variance[s];
    now_.sensors[s].leak_u = start.leak_u[s];
    now_.sensors[s].leak_v = start.leak_v[s];
  }
  model_ = wheel_model<S>(now_, start.noise);
  model_.places_held = true;
  if (model_.with_gyro) model_.mean_accel = hub_accel_;
  model_.with_ripple = start.with_ripple;
  model_.orders = start.orders;
  scale_motion(model_, 1.0);
  model_.noise.bias_walk_psd = std::max(model_.noise.bias_walk_psd, least_bias_walk_psd);
  main_ = prior_state<S>(start.prior);
  constexpr int gyro = wheel::gyro(S), of_gyro = wheel::encoder(S) - gyro;
  const Mat<of_gyro> believed = main_.x.mean.template segment<of_gyro>(gyro);
  main_.x.mean.template tail<wheel::standing(S)>() = start.constants;
  if (start.constants_cov.size() > 0)
    narrow_constants(start.constants_cov);
  else  // a few seconds of pushes leave bias, scale and rolling radius along a line
    main_.x.mean.template segment<of_gyro>(gyro) = believed;
  hold_rolling_radius();
  places_cov_ = start.places_cov;
  for (int i = 0; i < places; ++i) seat(i);
  rivals_[0] = {rival_factor, main_};
  rivals_[1] = {1.0 / rival_factor, main_};
}

/// The constants get twice their estimated standard deviation, since the filter processes the same
/// measurements again; at most their prior's, which would absorb the first motion. The lever arms
/// stay held.
template <int S>
void LiveWheelFilter<S>::narrow_constants(const Eigen::MatrixXd& found_cov) {
  constexpr int first = wheel::first_of(0), count = wheel::standing(S) - places;
  const Mat<count> prior_std = main_.x.cov.diagonal().template segment<count>(first).cwiseSqrt();
  Mat<count> by;
  for (int i = 0; i < count; ++i) {
    const double found_std = std::sqrt(found_cov(i, i));
    by(i) = found_std > 0.0 ? std::min(2.0, prior_std(i) / found_std) : 0.0;
  }
  main_.x.cov.template block<count, count>(first, first) =
      by.asDiagonal() * found_cov.topLeftCorner<count, count>() * by.asDiagonal();
}

/// A gentle swing of the speed tilts the apparent gravity as another scale of the gyroscope turns
/// the wheel, and the noise of the acceleration, as the coefficient of the radius, makes it seem
/// known: a filter that estimates it then ends where neither its intervals nor its prior allow. Its
/// uncertainty is added to the results instead.
template <int S>
void LiveWheelFilter<S>::hold_rolling_radius() {
  constexpr int rolling = wheel::rolling(S);
  if (model_.with_gyro) rolling_std_m_ = std::sqrt(main_.x.cov(rolling, rolling));
  main_.x.cov.row(rolling).setZero();
  main_.x.cov.col(rolling).setZero();
}

/// Estimates the radius from now on, once pushes determine it.
template <int S>
void LiveWheelFilter<S>::release_rolling_radius() {
  constexpr double pushed_radps2 = 1.5;  // root mean square
  if (rolling_std_m_ == 0.0 || accel2_ < square(pushed_radps2)) return;
  constexpr int rolling = wheel::rolling(S);
  const double variance = square(std::exchange(rolling_std_m_, 0.0));
  main_.x.cov(rolling, rolling) = variance;
  for (Moved& moved : moved_) moved.state.x.cov(rolling, rolling) = variance;
  for (Rival& rival : rivals_) rival.state.x.cov(rolling, rolling) = variance;
}

template <int S>
void LiveWheelFilter<S>::seat(int place) {
  Moved& moved = moved_[static_cast<std::size_t>(place)];
  moved.state = main_;
  moved.state.x.mean(first_place + place) += place_step_m;
}

/// The acceleration before this epoch, the coefficient of the rolling radius; 0 where it may be
/// noise.
template <int S>
double LiveWheelFilter<S>::significant_accel() const {
  constexpr double most_std = 3.0;
  const double accel = main_.x.mean(wheel::accel);
  return square(accel) > square(most_std) * main_.x.cov(wheel::accel, wheel::accel) ? accel : 0.0;
}

/// Where nothing is measured, the acceleration may change as it does otherwise: without this the
/// filter extrapolates the last one, and a turn may be lost unnoticed. White jerk of 2 σ²/τ, as of
/// accelerations of variance σ² with a correlation time τ.
template <int S>
double LiveWheelFilter<S>::unseen_jerk_psd() const {
  constexpr double correlation_s = 1.0;
  return 2.0 * accel2_ / correlation_s;
}

/// Whether an epoch has no measurement, or is the first one after a gap.
template <int S>
bool LiveWheelFilter<S>::is_unseen(const LiveEpoch& epoch) const {
  constexpr double longest_seen_s = 0.1;
  for (int s = 0; s < S; ++s)
    if (epoch.has(static_cast<std::size_t>(s))) return now_.epochs[1].dt_s >= longest_seen_s;
  return true;
}

/// The mean square of the acceleration over 4 s at first, 20 s later, less what is uncertain of it.
template <int S>
void LiveWheelFilter<S>::learn_accel() {
  constexpr double least_memory_s = 4.0, memory_s = 20.0;
  const double square_now =
      std::max(square(main_.x.mean(wheel::accel)) - main_.x.cov(wheel::accel, wheel::accel), 0.0);
  const double share =
      now_.epochs[1].dt_s / std::clamp(time_s_ - first_time_s_, least_memory_s, memory_s);
  accel2_ += (square_now - accel2_) * std::min(share, 1.0);
}

template <int S>
void LiveWheelFilter<S>::read(const LiveEpoch& epoch) {
  now_.epochs[1].dt_s = epochs_ == 0 ? 0.0 : epoch.time_s - time_s_;
  now_.epochs[1].jerk_psd = is_unseen(epoch) ? unseen_jerk_psd() : 0.0;
  time_s_ = epoch.time_s;
  for (std::size_t s = 0; s < static_cast<std::size_t>(S); ++s) {
    const Mat<3>& f = epoch.vectors[s];
    const Axis &u = planes_[s].u, &v = planes_[s].v;
    now_.sensors[s].u_mps2[0] = along(f, u);
    now_.sensors[s].v_mps2[0] = along(f, v);
    if (!gyroscope_at_[s]) continue;
    const Mat<3>& rate = epoch.vectors[*gyroscope_at_[s]];
    const Axis& axis = planes_[s].axis;
    PlanarReadings& sensor = now_.sensors[s];
    double& jerk_psd = now_.epochs[1].jerk_psd;
    const double speed = along(rate, axis);
    sensor.speed_radps[0] = speed;
    jerk_psd = std::max(jerk_psd, jerks_[s].add(epoch.time_s, speed));
    (*hub_accel_)[1] = significant_accel();
    sensor.rate_u_radps[0] = along(rate, u) - sensor.leak_u.at(speed);
    sensor.rate_v_radps[0] = along(rate, v) - sensor.leak_v.at(speed);
  }
}

/// For the measurements at this epoch. The product of the uncertainties of ω² or α and of a lever
/// arm is noise not covered by the Jacobian.
template <int S>
void LiveWheelFilter<S>::set_variance() {
  const double w = main_.x.mean(wheel::speed);
  const double accel =
      main_.x.cov(wheel::accel, wheel::accel) + model_.noise.jerk_psd * now_.epochs[1].dt_s;
  const double both = accel + 4.0 * w * w * main_.x.cov(wheel::speed, wheel::speed);
  for (std::size_t s = 0; s < static_cast<std::size_t>(S); ++s) {
    const auto at = static_cast<Eigen::Index>(2 * s);
    now_.sensors[s].variance_m2ps4[0] =
        variance_m2ps4_[s] + both * 0.5 * places_cov_.template block<2, 2>(at, at).trace();
  }
}

template <int S>
void LiveWheelFilter<S>::advance_all() {
  const std::size_t k = epochs_ == 0 ? 0 : 1;
  for (std::size_t m = 0; m < moved_.size(); ++m) {
    Moved& moved = moved_[m];
    if (std::abs(moved.state.x.mean(wheel::angle) - main_.x.mean(wheel::angle)) > 1.0)
      seat(static_cast<int>(m));  // it has slipped and contains no information
    advance(model_, k, live_gate, moved.state, other_step_);
    for (int i = 0; i < other_step_.count; ++i)
      moved.innovations[static_cast<std::size_t>(i)] =
          other_step_.updates[static_cast<std::size_t>(i)].innovation;
  }
  Model other = model_;
  for (Rival& rival : rivals_) {
    other.noise = model_.noise;
    scale_motion(other, rival.factor);
    advance(other, k, live_gate, rival.state, other_step_);
    rival.log_likelihood += log_likelihood_of(other_step_);
  }
  advance(model_, k, live_gate, main_, step_);
  main_log_likelihood_ += log_likelihood_of(step_);
  const std::size_t at = epochs_ % window_time_s_.size();
  window_.push(step_, model_.active());
  window_time_s_[at] = time_s_;
  expect();
  window_places_[at] = places_variance();
  ++epochs_;
}

template <int S>
void LiveWheelFilter<S>::step(const LiveEpoch& epoch) {
  read(epoch);
  if (epochs_ == 0) first_time_s_ = stretch_start_s_ = time_s_;
  std_before_rad_ = predicted_std_rad();
  if (time_s_ > first_time_s_ + 1.0 && std_before_rad_ > lost_std_rad) lost_ = true;
  set_variance();
  advance_all();
  judge();
  if (step_.count > 0) learn_accel();
  release_rolling_radius();
  if (time_s_ - stretch_start_s_ >= stretch_s) end_stretch();
}

/// Standard deviation of the angle at this epoch, before its measurements.
template <int S>
double LiveWheelFilter<S>::predicted_std_rad() const {
  const auto to = model_.transition(main_.x.mean, 1);
  const Mat<wheel::moving> from = to.F.row(wheel::angle).transpose();
  return std::sqrt(
      from.dot(main_.x.cov.template topLeftCorner<wheel::moving, wheel::moving>() * from) +
      to.Q(wheel::angle, wheel::angle));
}

template <int S>
void LiveWheelFilter<S>::Noise::add(double nis, double expected, double variance) {
  innovation2 += std::min(nis, 4.0 * wheel_gate.huber) * expected;
  explained += expected - variance;
  readings += 1.0;
}

template <int S>
void LiveWheelFilter<S>::Noise::adapt(double& variance) const {
  if (readings < 20.0) return;
  const double found = std::max(innovation2 - explained, 0.2 * innovation2) / readings;
  if (found > 0.0) variance = std::sqrt(variance * found);
}

template <int S>
void LiveWheelFilter<S>::Recent::add(double innovation, double most2) {
  sum += std::min(innovation * innovation, most2);
  channels += 1.0;
}

template <int S>
void LiveWheelFilter<S>::Recent::end_epoch() {
  if (channels > 0.0) mean += (sum / channels - mean) / surprise_epochs;
  sum = channels = 0.0;
}

template <int S>
void LiveWheelFilter<S>::Colour::add(double correction, double variance) {
  constexpr double mean_epochs = 20.0, factor_epochs = 400.0;
  constexpr double most = 100.0;  // so that a lost phase is soon forgotten
  if (!(variance > 0.0)) return;
  mean += (correction / std::sqrt(variance) - mean) / mean_epochs;
  const double of_white = 1.0 / (2.0 * mean_epochs - 1.0);
  factor += (std::min(square(mean) / of_white, most) - factor) / factor_epochs;
}

/// Updates measurement noise and motion noise from the innovations.
template <int S>
void LiveWheelFilter<S>::judge() {
  int channel = 0;
  double clipped = 0.0, correction = 0.0, correction_variance = 0.0;
  nis_ = 0.0;
  const auto take = [&](Noise& noise, double variance, Recent& recent, double most2) {
    const auto& u = step_.updates[static_cast<std::size_t>(channel)];
    const double expected = expected_[static_cast<std::size_t>(channel++)];
    const double nis = u.innovation * u.innovation / expected;
    nis_ += nis;
    clipped += std::min(nis, 4.0 * surprising);
    recent.add(u.innovation, most2);
    if (u.used) noise.add(nis, expected, variance);
    correction += u.gain(wheel::speed) * u.innovation;
    correction_variance += square(u.gain(wheel::speed)) * u.expected;
  };
  const double most_shaking2 = square(most_shaking * now_.gravity_mps2);
  for (std::size_t s = 0; s < static_cast<std::size_t>(S); ++s) {
    if (!model_.has_readings(s, 1)) continue;
    for (int axis = 0; axis < 2; ++axis)
      take(noise_[s], variance_m2ps4_[s], recent_, most_shaking2);
    if (model_.has_speed(s, 1))
      take(speed_noise_[s], now_.sensors[s].speed_variance, recent_speed_, most_rate_noise2);
  }
  since_loosened_s_ += now_.epochs[1].dt_s;
  if (channel == 0) {
    nis_ = std::numeric_limits<double>::quiet_NaN();
    return;
  }
  nis_ /= channel;
  recent_.end_epoch();
  recent_speed_.end_epoch();
  colour_.add(correction, correction_variance);
  notice_surprise(clipped / channel);
}

template <int S>
void LiveWheelFilter<S>::notice_surprise(double mean_nis) {
  surprise_ += (mean_nis - surprise_) / surprise_epochs;
  if (surprise_ < surprising) return;
  surprise_ = 1.0;
  loosened_ = since_loosened_s_ < 1.0 ? loosened_ + 1 : 1;
  since_loosened_s_ = 0.0;
  if (loosened_ > 8) lost_ = true;
  loosen();
}

/// Increases the process noise and the measurement noise at once: a road shakes the hub as soon as
/// the wheel rolls on it. The parallel filters and later innovations separate the two.
template <int S>
void LiveWheelFilter<S>::loosen() {
  if (loosened_ > 1)
    model_.noise.jerk_psd =
        std::min(std::max(lively_jerk_psd, 10.0 * model_.noise.jerk_psd), most_jerk_psd);
  for (std::size_t s = 0; s < static_cast<std::size_t>(S); ++s) {
    variance_m2ps4_[s] = std::max(variance_m2ps4_[s], 0.5 * recent_.mean);
    double& of_speed = now_.sensors[s].speed_variance;
    of_speed = std::max(of_speed, 0.5 * recent_speed_.mean);
  }
  widen_motion(main_.x);
  for (Moved& moved : moved_) widen_motion(moved.state.x);
  forget_stretch();
}

/// Discards the noise statistics of the current interval.
template <int S>
void LiveWheelFilter<S>::forget_stretch() {
  for (Rival& rival : rivals_) {
    rival.state = main_;
    rival.log_likelihood = 0.0;
  }
  main_log_likelihood_ = 0.0;
  noise_ = speed_noise_ = {};
  stretch_start_s_ = time_s_;
}

template <int S>
void LiveWheelFilter<S>::end_stretch() {
  for (std::size_t s = 0; s < static_cast<std::size_t>(S); ++s) {
    noise_[s].adapt(variance_m2ps4_[s]);
    speed_noise_[s].adapt(now_.sensors[s].speed_variance);
  }
  const Rival& better =
      rivals_[0].log_likelihood >= rivals_[1].log_likelihood ? rivals_[0] : rivals_[1];
  if (better.log_likelihood > main_log_likelihood_) scale_motion(model_, better.factor);
  forget_stretch();
}

/// Angle and speed of the wheel, from a state without its ripple. The covariance of the two is left
/// out: the window does not have it, and the sum is known better than its parts.
template <int S>
std::pair<Uncertain, Uncertain> LiveWheelFilter<S>::motion_of(const Gaussian<3>& x,
                                                              const Mat<2>& by_places) const {
  Mat<states> mean = main_.x.mean;
  mean.template head<3>() = x.mean;
  const auto now = model_.motion(mean);
  const auto uncertain = [&](double value, const Mat<states>& slope, double rate, double more) {
    constexpr int at = wheel::ripple(S), count = 2 * wheel::ripple_orders;
    const Mat<3> by_motion = slope.template head<3>();
    double variance = by_motion.dot(x.cov * by_motion);
    if (model_.with_ripple) {
      const Mat<count> by_ripple = slope.template segment<count>(at);
      variance += by_ripple.dot(main_.x.cov.template block<count, count>(at, at) * by_ripple);
    }
    variance = std::max(colour_.factor, 1.0) * std::max(variance, 0.0);
    return Uncertain{value, std::sqrt(variance + square(rate * delay_std_s_) + more)};
  };
  // The hub's acceleration tilts the apparent gravity, and changes within about a second.
  constexpr double changes_per_s = 1.0;
  const double lean_s2 = rolling_std_m_ / now_.gravity_mps2;
  const double angle_more = by_places(0) + alignment_variance_rad2_ + square(lean_s2 * now.accel);
  const double speed_more = by_places(1) + square(lean_s2 * changes_per_s) * accel2_;
  return {uncertain(now.angle, now.by_angle, now.speed, angle_more),
          uncertain(now.speed, now.by_speed, now.accel, speed_more)};
}

template <int S>
LiveWheelRow LiveWheelFilter<S>::row() const {
  LiveWheelRow row;
  const std::size_t newest = (epochs_ - 1) % window_places_.size();
  std::tie(row.angle_rad, row.speed_radps) = motion_of(window_.state(0), window_places_[newest]);
  row.nis = nis_;
  if (window_.size() <= window_.lag()) {
    const double none = std::numeric_limits<double>::quiet_NaN();
    row.smoothed_angle_rad = row.smoothed_speed_radps = {none, none};
    return row;
  }
  const std::size_t oldest = epochs_ % window_time_s_.size();
  row.smoothed_time_s = window_time_s_[oldest];
  std::tie(row.smoothed_angle_rad, row.smoothed_speed_radps) =
      motion_of(window_.state(window_.lag()), window_places_[oldest]);
  return row;
}

template class LiveWheelFilter<1>;
template class LiveWheelFilter<2>;

}  // namespace proofmass::estimate
