#include "proofmass/estimate/drive/trace.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "proofmass/core/linalg.hpp"
#include "proofmass/core/statistics.hpp"
#include "proofmass/core/units.hpp"

namespace proofmass::estimate::drive {
namespace {

constexpr double standing_radps = 0.05;      // slower, a wheel is taken to stand
constexpr double impossible_radps = 1000.0;  // of a gyroscope
constexpr double least_walk_rad2ps = 1e-7;   // 1.1 °/√h: an ordinary MEMS gyroscope
constexpr double block_s = 1.0, block_turns = 2.0;
// Yaw rate bias that is left after rotation by the wheel's angle: sensitivity of the gyroscope to
// acceleration, whose reaction of gravity turns as the yaw does (0.02 °/s per g); of a frame: the
// change of its bias since the last rest.
constexpr double wheel_bias_std_radps = 0.015 * rad_per_deg,
                 frame_bias_std_radps = 0.02 * rad_per_deg;

using Three = Eigen::Vector3d;

Three row(const std::array<std::vector<double>, 3>& axes, std::size_t k) {
  return {axes[0][k], axes[1][k], axes[2][k]};
}

// Eigen's own is in its Geometry, which this module does not include.
Three cross(const Three& a, const Three& b) {
  return {a(1) * b(2) - a(2) * b(1), a(2) * b(0) - a(0) * b(2), a(0) * b(1) - a(1) * b(0)};
}

// Least squares of three-vectors on regressors, with a second pass without outliers.
class VectorFit {
 public:
  explicit VectorFit(int regressors) : size_(regressors) {}

  void add(const Eigen::VectorXd& x, const Three& y) {
    rows_.push_back(x);
    values_.push_back(y);
  }

  // One row of coefficients for each regressor.
  [[nodiscard]] Eigen::MatrixXd solve() const {
    Eigen::MatrixXd fit = solve_within(Eigen::MatrixXd::Zero(size_, 3), -1.0);
    double sum = 0.0;
    for (std::size_t k = 0; k < rows_.size(); ++k) sum += misfit2(fit, k);
    const double limit = 16.0 * sum / static_cast<double>(std::max<std::size_t>(rows_.size(), 1));
    return solve_within(fit, limit);
  }
  [[nodiscard]] std::size_t rows() const { return rows_.size(); }

 private:
  [[nodiscard]] double misfit2(const Eigen::MatrixXd& fit, std::size_t k) const {
    return (values_[k] - fit.transpose() * rows_[k]).squaredNorm();
  }
  [[nodiscard]] Eigen::MatrixXd solve_within(const Eigen::MatrixXd& about, double limit) const {
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(size_, size_), b = Eigen::MatrixXd::Zero(size_, 3);
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      if (limit >= 0.0 && misfit2(about, k) > limit) continue;
      A += rows_[k] * rows_[k].transpose();
      b += rows_[k] * values_[k].transpose();
    }
    A.diagonal().array() += 1e-9;
    return proofmass::solve(A, b);
  }

  int size_;
  std::vector<Eigen::VectorXd> rows_;
  std::vector<Three> values_;
};

// A sensor's rows that have finite, possible values, with the wheel's angle and speed there.
struct Spinning {
  std::vector<double> time_s, angle, speed;
  std::vector<Three> force, rate;
};

Spinning spinning_rows(const WheelSensor& sensor, const Trace& trace) {
  Spinning rows;
  for (std::size_t k = 0; k < sensor.time_s.size(); ++k) {
    const double t = sensor.time_s[k];
    const Three force = row(sensor.accel_mps2, k), rate = row(sensor.rate_radps, k);
    if (!force.allFinite() || !rate.allFinite() || force.norm() > 1e3 ||
        rate.cwiseAbs().maxCoeff() > impossible_radps || force.isZero())
      continue;
    if (t < trace.time_s.front() || t > trace.time_s.back()) continue;
    if (!rows.time_s.empty() && t <= rows.time_s.back()) continue;
    rows.time_s.push_back(t);
    rows.angle.push_back(at_time(trace.time_s, trace.angle_rad, t));
    rows.speed.push_back(at_time(trace.time_s, trace.speed_radps, t));
    rows.force.push_back(force);
    rows.rate.push_back(rate);
  }
  return rows;
}

// Upward direction in the sensor's axes at wheel angle φ: (up_sin sin φ + up_cos cos φ), from the
// specific force, whose part that turns with φ is gravity's reaction. The other regressors take up
// bias and centripetal force.
struct Upward {
  Three by_sin, by_cos;
};

Upward upward_direction(const Spinning& rows) {
  VectorFit fit(4);
  for (std::size_t k = 0; k < rows.time_s.size(); ++k) {
    Eigen::VectorXd x(4);
    x << std::sin(rows.angle[k]), std::cos(rows.angle[k]), 1.0, 1e-2 * square(rows.speed[k]);
    fit.add(x, rows.force[k]);
  }
  const Eigen::MatrixXd c = fit.solve();
  return {c.row(0).transpose(), c.row(1).transpose()};
}

// Angular rate about the axle in the gyroscope's axes for a wheel speed of 1 rad/s, and the bias.
// The spin axis is tilted against the sensor's axes: its projection on them, times a spin that
// exceeds the yaw rate a hundredfold, would otherwise be taken for yaw.
struct Spin {
  Three axis, bias;
};

Spin spin_axis_of(const Spinning& rows) {
  VectorFit fit(2);
  for (std::size_t k = 0; k < rows.time_s.size(); ++k)
    fit.add(Eigen::Vector2d(rows.speed[k], 1.0), rows.rate[k]);
  const Eigen::MatrixXd c = fit.solve();
  return {c.row(0).transpose(), c.row(1).transpose()};
}

// Random walk that a rate's noise adds to its integral, from differences of the means of successive
// blocks: what varies slowly, such as the roll of the road, is not noise.
// Source: D. W. Allan, Proc. IEEE 54 (1966) 221.
class WalkFromBlocks {
 public:
  void add(double value, double step_s) {
    sum_ += value * step_s;
    time_s_ += step_s;
  }
  [[nodiscard]] double time_s() const { return time_s_; }
  void close_block() {
    if (!(time_s_ > 0.0)) return;
    const double mean = sum_ / time_s_;
    if (before_s_ > 0.0) {
      squares_ += square(mean - before_) / (1.0 / time_s_ + 1.0 / before_s_);
      pairs_ += 1.0;
    }
    before_ = mean;
    before_s_ = time_s_;
    sum_ = time_s_ = 0.0;
  }
  [[nodiscard]] double rad2ps() const {
    return pairs_ < 1.0 ? least_walk_rad2ps : std::max(least_walk_rad2ps, squares_ / pairs_);
  }

 private:
  double sum_ = 0.0, time_s_ = 0.0, before_ = 0.0, before_s_ = 0.0, squares_ = 0.0, pairs_ = 0.0;
};

// Yaw from the in-plane axes: rotated by the wheel's angle they give the rates about the upward
// direction, which is yaw, and about the direction of travel, which is noise and the axle's roll.
// The second measures the first's noise, over blocks of two turns, in which the modulation by the
// wheel's angle averages out. A wheel that stands has no yaw.
// Source: X. Niu, Y. Wu, J. Kuang, Wheel-INS (2021), section III.
void add_yaw(const WheelSensor& sensor, Trace& trace) {
  const Spinning rows = spinning_rows(sensor, trace);
  if (rows.time_s.size() < 100) return;
  const Upward upward = upward_direction(rows);
  const Spin spin = spin_axis_of(rows);
  const Three axis = spin.axis.normalized();
  if (!(std::abs(spin.axis.norm() - 1.0) < 0.3)) {
    trace.notes.push_back(
        {Severity::warning, sensor.name +
                                ": the gyroscope does not show the wheel's spin, so its other axes "
                                "are not used for the yaw rate (unit?)"});
    return;
  }
  trace.spin_tilt_rad = std::acos(std::min(1.0, axis.cwiseAbs().maxCoeff()));
  std::vector<double> yaw(rows.time_s.size(), 0.0);
  WalkFromBlocks walk;
  double before = 0.0, block_from = 0.0;
  for (std::size_t k = 0; k < yaw.size(); ++k) {
    const Three up =
        upward.by_sin * std::sin(rows.angle[k]) + upward.by_cos * std::cos(rows.angle[k]);
    const Three level_up = (up - axis * axis.dot(up)).normalized();
    const Three left = rows.rate[k] - spin.axis * rows.speed[k] - spin.bias;
    const bool stands = std::abs(rows.speed[k]) < standing_radps;
    const double rate = stands ? 0.0 : left.dot(level_up);
    const double step_s = k > 0 ? rows.time_s[k] - rows.time_s[k - 1] : 0.0;
    if (k > 0) yaw[k] = yaw[k - 1] + 0.5 * (before + rate) * step_s;
    if (!stands && step_s > 0.0 && step_s < 0.2) walk.add(left.dot(cross(axis, level_up)), step_s);
    if (std::abs(rows.angle[k] - block_from) >= block_turns * rad_per_turn) {
      walk.close_block();
      block_from = rows.angle[k];
    }
    before = rate;
  }
  for (const double t : trace.time_s) trace.yaw_rad.push_back(at_time(rows.time_s, yaw, t));
  trace.yaw_walk_rad2ps = walk.rad2ps();
  trace.yaw_bias_std_radps = wheel_bias_std_radps;
}

Result<Trace> trace_encoder(const DriveWheel& wheel) {
  Trace trace;
  constexpr double quantum_std_rad = 2e-3;
  for (std::size_t k = 0; k < wheel.encoder_rad.size(); ++k) {
    if (!std::isfinite(wheel.encoder_rad[k])) continue;
    trace.time_s.push_back(wheel.sensor.time_s[k]);
    trace.angle_rad.push_back(wheel.encoder_rad[k]);
  }
  const std::size_t n = trace.time_s.size();
  if (n < 10) return Error{Errc::too_few_samples, wheel.sensor.name + ": no angle of the encoder"};
  // The least step between two readings is the encoder's resolution.
  double step = INFINITY;
  for (std::size_t k = 1; k < n; ++k)
    if (const double d = std::abs(trace.angle_rad[k] - trace.angle_rad[k - 1]); d > 1e-9)
      step = std::min(step, d);
  const double std_rad =
      std::max(quantum_std_rad, std::isfinite(step) ? step / std::sqrt(12.0) : 0.0);
  trace.angle_std_rad.assign(n, std_rad);
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t a = k < 5 ? 0 : k - 5, b = std::min(k + 5, n - 1);
    trace.speed_radps.push_back((trace.angle_rad[b] - trace.angle_rad[a]) /
                                (trace.time_s[b] - trace.time_s[a]));
  }
  trace.turns = Uncertain{(trace.angle_rad.back() - trace.angle_rad.front()) / rad_per_turn,
                          std::sqrt(2.0) * std_rad / rad_per_turn};
  return trace;
}

}  // namespace

double at_time(const std::vector<double>& time_s, const std::vector<double>& values, double t) {
  const auto after = std::ranges::upper_bound(time_s, t);
  if (after == time_s.begin()) return values.front();
  if (after == time_s.end()) return values.back();
  const auto k = static_cast<std::size_t>(after - time_s.begin());
  const double share = (t - time_s[k - 1]) / (time_s[k] - time_s[k - 1]);
  return values[k - 1] + share * (values[k] - values[k - 1]);
}

Result<Trace> trace_wheel(const DriveWheel& wheel, const WheelOptions& options) {
  if (!wheel.encoder_rad.empty()) return trace_encoder(wheel);
  WheelOptions own = options;
  if (wheel.circumference_m) own.rolling_radius_m = wheel.circumference_m->value / rad_per_turn;
  const auto solved = estimate_wheel({wheel.sensor}, own);
  if (!solved) return solved.error();
  if (!solved->turns)
    return Error{Errc::not_observable, wheel.sensor.name + ": the number of turns is ambiguous: " +
                                           solved->smoother.note};
  Trace trace;
  trace.time_s = solved->series.time_s;
  trace.angle_rad = solved->series.angle_rad;
  // The smoother's errors are correlated over some epochs; the filter takes them as white.
  constexpr double inflation = 2.0;
  for (const double std_rad : solved->series.angle_std_rad)
    trace.angle_std_rad.push_back(inflation * std_rad);
  trace.speed_radps = solved->series.speed_radps;
  trace.turns = solved->turns;
  trace.rolling_radius_m = solved->rolling_radius_m;
  for (const Note& note : solved->notes)
    if (note.severity != Severity::info)
      trace.notes.push_back({note.severity, wheel.sensor.name + ": " + note.text});
  const auto& rates = wheel.sensor.rate_radps;
  if (!rates[0].empty() && !wheel.sensor.accel_mps2[2].empty()) add_yaw(wheel.sensor, trace);
  return trace;
}

std::vector<Stretch> rests_of(const Trace& wheel, double least_s) {
  std::vector<Stretch> rests;
  bool open = false;
  for (std::size_t k = 0; k < wheel.time_s.size(); ++k) {
    const bool stands = std::abs(wheel.speed_radps[k]) < standing_radps;
    if (stands && !open) rests.push_back({wheel.time_s[k], wheel.time_s[k], 0, {}});
    if (stands) {
      rests.back().end_s = wheel.time_s[k];
      ++rests.back().rows;
    }
    open = stands;
  }
  std::erase_if(rests, [&](const Stretch& rest) { return rest.end_s - rest.start_s < least_s; });
  return rests;
}

namespace {

bool is_resting(const std::vector<Stretch>& rests, double t) {
  return std::ranges::any_of(
      rests, [&](const Stretch& rest) { return t >= rest.start_s && t <= rest.end_s; });
}

bool is_plausible(const Three& force, const Three& rate) {
  return force.allFinite() && rate.allFinite() && !force.isZero() && force.norm() <= 1e3 &&
         rate.cwiseAbs().maxCoeff() <= impossible_radps;
}

// The plausible rows of a frame, and the means of those at rest.
struct FrameRows {
  std::vector<std::size_t> rows;
  Three up = Three::Zero(), bias = Three::Zero();
  std::size_t still = 0;
};

FrameRows rows_of_frame(const WheelSensor& sensor, const std::vector<Stretch>& rests) {
  FrameRows found;
  for (std::size_t k = 0; k < sensor.time_s.size(); ++k) {
    const Three force = row(sensor.accel_mps2, k), rate = row(sensor.rate_radps, k);
    if (!is_plausible(force, rate)) continue;
    found.rows.push_back(k);
    if (!is_resting(rests, sensor.time_s[k])) continue;
    found.up += force;
    found.bias += rate;
    ++found.still;
  }
  if (found.still > 0) {
    found.up.normalize();
    found.bias /= static_cast<double>(found.still);
  }
  return found;
}

}  // namespace

Result<Trace> trace_frame(const WheelSensor& sensor, const std::vector<Stretch>& rests) {
  if (sensor.rate_radps[0].empty())
    return Error{Errc::invalid_argument,
                 sensor.name + ": no gyroscope, which is what a sensor on the frame is for"};
  const FrameRows frame = rows_of_frame(sensor, rests);
  constexpr std::size_t fewest_still = 100;
  if (frame.still < fewest_still)
    return Error{
        Errc::not_observable,
        sensor.name +
            ": the vehicle does not stand long enough to determine the bias of the frame's "
            "gyroscope"};
  Trace trace;
  WalkFromBlocks walk;
  double before = 0.0;
  for (const std::size_t k : frame.rows) {
    const double t = sensor.time_s[k];
    const double rate = frame.up.dot(row(sensor.rate_radps, k) - frame.bias);
    const bool stands = is_resting(rests, t);
    const double step_s = trace.time_s.empty() ? 0.0 : t - trace.time_s.back();
    if (!trace.time_s.empty() && step_s <= 0.0) continue;
    if (stands && step_s > 0.0 && step_s < 0.2) walk.add(rate, step_s);
    if (walk.time_s() >= block_s) walk.close_block();
    const double so_far = trace.yaw_rad.empty() ? 0.0 : trace.yaw_rad.back();
    trace.time_s.push_back(t);
    trace.yaw_rad.push_back(so_far + 0.5 * step_s * (before + (stands ? 0.0 : rate)));
    before = stands ? 0.0 : rate;
  }
  // Roll and pitch in motion tilt the axis by a degree or so; vibration adds to the walk at rest.
  trace.yaw_walk_rad2ps = 4.0 * walk.rad2ps();
  trace.yaw_bias_std_radps = frame_bias_std_radps;
  return trace;
}

void reverse(Trace& wheel) {
  for (double& angle : wheel.angle_rad) angle = -angle;
  for (double& speed : wheel.speed_radps) speed = -speed;
  if (wheel.turns) wheel.turns->value = -wheel.turns->value;
}

}  // namespace proofmass::estimate::drive
