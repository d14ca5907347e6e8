#include "proofmass/estimate/attitude/model.hpp"

#include <algorithm>
#include <cmath>

#include "proofmass/core/statistics.hpp"

namespace proofmass::estimate {
namespace {

/// Standard deviation of a level over half a second, in which the body may already move.
constexpr double level_std_rad = 0.3;
/// Duration of the rotation or push to which scale_std applies.
constexpr double turn_s = 1.0, push_s = 0.3;

/// Adds a measurement of an error's departure from the nominal motion; returns its h, which is
/// zero.
InertialError& add_row(Readings<inertial::states, AttitudeModel::channels>& out,
                       double departure,
                       double variance) {
  Reading<inertial::states>& row = out.rows[static_cast<std::size_t>(out.count++)];
  row.value = departure;
  row.variance = variance;
  row.h.setZero();
  return row.h;
}

/// Level, with heading 0: the sensor's x axis above the world's, or its y axis above the world's.
Mat<3, 3> levelled(const Mat<3>& force) {
  const Mat<3> up = force / force.norm();
  const bool by_x = std::abs(up.x()) < 0.95;
  const Mat<3> axis = by_x ? Mat<3>(1.0, 0.0, 0.0) : Mat<3>(0.0, 1.0, 0.0);
  const Mat<3> along = (axis - axis.dot(up) * up).normalized();
  const Mat<3> left = cross(up, along);
  Mat<3, 3> R;
  if (by_x)
    R << along.transpose(), left.transpose(), up.transpose();
  else
    R << -left.transpose(), along.transpose(), up.transpose();
  return R;
}

}  // namespace

void NominalState::move_by(const InertialError& error) {
  R = orthonormal(rotation_by(error.segment<3>(inertial::attitude)) * R);
  v += error.segment<3>(inertial::velocity);
  p += error.segment<3>(inertial::position);
  rate_bias += error.segment<3>(inertial::rate_bias);
  accel_bias += error.segment<3>(inertial::accel_bias);
}

InertialError NominalState::less(const NominalState& from) const {
  InertialError error;
  error << rotation_vector(R * from.R.transpose()), v - from.v, p - from.p,
      rate_bias - from.rate_bias, accel_bias - from.accel_bias;
  return error;
}

AttitudeModel::AttitudeModel(const PreparedSeries& series, const AttitudeOptions& options)
    : nominal(series.samples.size()),
      series_(&series),
      options_(options),
      bounds_speed_(series.samples.size(), 0) {
  double since_s = 0.0, resting = 0.0;
  int rests = 0;
  for (std::size_t k = 0; k < series.samples.size(); ++k) {
    const InertialSample& sample = series.samples[k];
    rests = std::max(rests, sample.rest + 1);
    if (sample.rest >= 0) resting += 1.0;
    since_s = sample.starts || sample.rest >= 0 ? 0.0 : since_s + sample.dt_s;
    if (since_s < options.speed_interval_s) continue;
    bounds_speed_[k] = 1;
    since_s = 0.0;
  }
  reading_of_.assign(series.samples.size(), 0);
  std::size_t k = 0;
  for (std::size_t i = 0; i < options.positions.size() && k < series.samples.size(); ++i) {
    while (k + 1 < series.samples.size() && series.samples[k].row < options.positions[i].sample)
      ++k;
    reading_of_[k] = i + 1;
  }
  rest_used.assign(static_cast<std::size_t>(rests), 1);
  gravity_variance_ = square(options.gravity_std_mps2) * resting;
}

bool AttitudeModel::at_rest(std::size_t k) const {
  const int rest = series_->samples[k].rest;
  return rest >= 0 && rest_used[static_cast<std::size_t>(rest)] != 0;
}

bool AttitudeModel::stays(std::size_t k) const {
  return k > 0 && at_rest(k) && !series_->samples[k].enters_rest;
}

NominalState AttitudeModel::start(std::size_t k) const {
  constexpr double span_s = 0.5;
  Mat<3> sum = Mat<3>::Zero();
  double since_s = 0.0;
  for (std::size_t i = k; i < size() && (i == k || !series_->samples[i].starts); ++i) {
    since_s += series_->samples[i].dt_s;
    if (since_s > span_s) break;
    sum += series_->samples[i].force;
  }
  NominalState out;
  if (sum.norm() > 0.0) out.R = levelled(sum);
  return out;
}

NominalState AttitudeModel::moved(const NominalState& before, std::size_t k) const {
  const InertialSample &a = series_->samples[k - 1], &b = series_->samples[k];
  if (b.starts) {
    NominalState out = start(k);
    out.rate_bias = before.rate_bias;
    out.accel_bias = before.accel_bias;
    return out;
  }
  NominalState out = before;
  if (stays(k)) {
    out.v.setZero();
    return out;
  }
  // Rate and force are linear between samples; ω₁ × ω₂ is due to the rotation of the axis.
  const Mat<3> w1 = a.rate - before.rate_bias, w2 = b.rate - before.rate_bias;
  const Mat<3> turn = 0.5 * b.dt_s * (w1 + w2) + square(b.dt_s) / 12.0 * cross(w1, w2);
  out.R = before.R * rotation_by(turn);
  const Mat<3> gravity(0.0, 0.0, options_.gravity_mps2);
  const Mat<3> a1 = before.R * (a.force - before.accel_bias) - gravity;
  const Mat<3> a2 = out.R * (b.force - before.accel_bias) - gravity;
  out.v += 0.5 * b.dt_s * (a1 + a2);
  out.p += b.dt_s * before.v + square(b.dt_s) / 6.0 * (2.0 * a1 + a2);
  return out;
}

Mat<15, 15> AttitudeModel::start_cov(std::size_t k) const {
  InertialError variance = InertialError::Zero();
  variance.segment<2>(inertial::attitude).setConstant(square(level_std_rad));
  const double speed = at_rest(k) ? options_.rest_speed_std_mps : options_.speed_std_mps;
  variance.segment<3>(inertial::velocity).setConstant(square(speed));
  return variance.asDiagonal();
}

Gaussian<15> AttitudeModel::prior() const {
  Gaussian<states> out;
  out.mean = start(0).less(nominal.front());
  out.cov = start_cov(0);
  out.cov.diagonal()
      .segment<3>(inertial::rate_bias)
      .setConstant(square(options_.rate_bias_std_radps));
  out.cov.diagonal()
      .segment<3>(inertial::accel_bias)
      .setConstant(square(options_.accel_bias_std_mps2));
  return out;
}

void AttitudeModel::add_motion(std::size_t k, Transition<states, states>& step) const {
  using namespace inertial;
  const InertialSample &a = series_->samples[k - 1], &b = series_->samples[k];
  const NominalState& from = nominal[k - 1];
  const double dt = b.dt_s;
  const Mat<3, 3> R = from.R * rotation_by(0.5 * dt * (a.rate - from.rate_bias));
  const Mat<3> force = R * (0.5 * (a.force + b.force) - from.accel_bias);
  const Mat<3, 3> lean = -dt * cross_matrix(force);
  step.F.block<3, 3>(attitude, rate_bias) = -dt * R;
  step.F.block<3, 3>(velocity, attitude) = lean;
  step.F.block<3, 3>(velocity, rate_bias) = -0.5 * dt * lean * R;
  step.F.block<3, 3>(velocity, accel_bias) = -dt * R;
  step.F.block<3, 3>(position, velocity).diagonal().setConstant(dt);
  step.F.block<3, 3>(position, attitude) = 0.5 * dt * lean;
  step.F.block<3, 3>(position, accel_bias) = -0.5 * dt * dt * R;

  const double rate = (0.5 * (a.rate + b.rate) - from.rate_bias).squaredNorm();
  const double accel = (force - Mat<3>(0.0, 0.0, options_.gravity_mps2)).squaredNorm();
  const double qr =
      square(series_->rate_noise) + b.rate_doubt + square(options_.rate_scale_std) * rate * turn_s;
  const double qa = square(series_->accel_noise) + b.force_doubt +
                    square(options_.accel_scale_std) * accel * push_s;
  step.Q.diagonal().segment<3>(attitude).setConstant(qr * dt);
  step.Q.diagonal().segment<3>(velocity).setConstant(qa * dt);
  step.Q.diagonal().segment<3>(position).setConstant(qa * dt * dt * dt / 3.0);
  step.Q.block<3, 3>(velocity, position).diagonal().setConstant(qa * dt * dt / 2.0);
  step.Q.block<3, 3>(position, velocity).diagonal().setConstant(qa * dt * dt / 2.0);
}

Transition<15, 15> AttitudeModel::transition(const InertialError& x, std::size_t k) const {
  using namespace inertial;
  const InertialSample& sample = series_->samples[k];
  Transition<states, states> step{InertialError::Zero(), Mat<states, states>::Identity(),
                                  Mat<states, states>::Zero(), InertialError::Zero()};
  if (sample.starts) {
    step.F.topLeftCorner<9, 9>().setZero();
    step.Q = start_cov(k);
  } else if (stays(k)) {
    step.F.block<3, 3>(velocity, velocity).setZero();
    step.Q.diagonal().segment<3>(attitude).setConstant(square(options_.rest_creep_radps_rthz) *
                                                       sample.dt_s);
    step.Q.diagonal().segment<3>(velocity).setConstant(square(options_.rest_speed_std_mps));
  } else {
    add_motion(k, step);
  }
  const double dt = sample.starts ? 0.0 : sample.dt_s;
  step.Q.diagonal().segment<3>(rate_bias).setConstant(square(options_.rate_bias_walk_radps_rts) *
                                                      dt);
  step.Q.diagonal()
      .segment<3>(accel_bias)
      .setConstant(square(options_.accel_bias_walk_mps2_rts) * dt);
  step.mean = step.F * x + moved(nominal[k - 1], k).less(nominal[k]);
  return step;
}

void AttitudeModel::add_rest(std::size_t k, Readings<states, channels>& out) const {
  using namespace inertial;
  const InertialSample& sample = series_->samples[k];
  const NominalState& about = nominal[k];
  const double dt = std::max(sample.dt_s, series_->samples[std::min(k + 1, size() - 1)].dt_s);
  const double rate = (square(series_->rate_noise) + sample.rate_doubt) / dt;
  const double accel = (square(series_->accel_noise) + sample.force_doubt) / dt;
  for (int i = 0; i < 3; ++i)
    add_row(out, sample.rate(i) - about.rate_bias(i), rate)(rate_bias + i) = 1.0;
  // g e_z = R (f − b) + δθ × g e_z − R δb: heading is in none of the rows.
  const double g = options_.gravity_mps2;
  const Mat<3> off = Mat<3>(0.0, 0.0, g) - about.R * (sample.force - about.accel_bias);
  const Mat<3> variance(accel, accel, accel + gravity_variance_);
  const Mat<3, 3> tilt = -g * cross_matrix({0.0, 0.0, 1.0});
  for (int i = 0; i < 3; ++i) {
    InertialError& h = add_row(out, off(i), variance(i));
    h.segment<3>(attitude) = tilt.row(i).transpose();
    h.segment<3>(accel_bias) = -about.R.row(i).transpose();
  }
}

void AttitudeModel::add_position(std::size_t k, Readings<states, channels>& out) const {
  if (reading_of_[k] == 0) return;
  const PositionReading& reading = options_.positions[reading_of_[k] - 1];
  const Mat<3> there = nominal[k].p + reading.after_s * nominal[k].v;
  InertialError& h =
      add_row(out, reading.position_m - reading.direction.dot(there), reading.variance_m2);
  h.segment<3>(inertial::position) = reading.direction;
  h.segment<3>(inertial::velocity) = reading.after_s * reading.direction;
}

void AttitudeModel::measure(const InertialError& x,
                            std::size_t k,
                            Readings<states, channels>& out) const {
  out.count = 0;
  const bool resting = at_rest(k);
  if (resting) add_rest(k, out);
  const bool enters = resting && series_->samples[k].enters_rest;
  if (enters || (!resting && bounds_speed_[k] != 0)) {
    const double std = enters ? options_.rest_speed_std_mps : options_.speed_std_mps;
    for (int i = 0; i < 3; ++i)
      add_row(out, -nominal[k].v(i), square(std))(inertial::velocity + i) = 1.0;
  }
  add_position(k, out);
  for (int i = 0; i < out.count; ++i) {
    Reading<states>& row = out.rows[static_cast<std::size_t>(i)];
    row.predicted = row.h.dot(x);
  }
}

}  // namespace proofmass::estimate
