#include "proofmass/estimate/drive/yaw.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <fmt/format.h>
#include <optional>
#include <utility>

#include "proofmass/core/linalg.hpp"
#include "proofmass/core/statistics.hpp"
#include "proofmass/core/units.hpp"

namespace proofmass::estimate::drive {
namespace {

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

// A sensor's rows with possible rates, one of them missing at most, and the wheel's angle and speed
// there. The force may be missing.
struct Spinning {
  std::vector<double> time_s, angle, speed;
  std::vector<Three> force, rate;
};

bool is_possible(const Three& rate) {
  int known = 0;
  for (const double value : rate) {
    if (std::abs(value) > impossible_radps) return false;
    known += std::isfinite(value) ? 1 : 0;
  }
  return known >= 2;
}

Spinning spinning_rows(const WheelSensor& sensor, const Trace& trace) {
  Spinning rows;
  for (std::size_t k = 0; k < sensor.time_s.size(); ++k) {
    const double t = sensor.time_s[k];
    const Three force = row(sensor.accel_mps2, k), rate = row(sensor.rate_radps, k);
    if (!is_possible(rate) || force.norm() > 1e3 || force.isZero()) continue;
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
    if (!rows.force[k].allFinite()) continue;
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
    if (rows.rate[k].allFinite()) fit.add(Eigen::Vector2d(rows.speed[k], 1.0), rows.rate[k]);
  const Eigen::MatrixXd c = fit.solve();
  return {c.row(0).transpose(), c.row(1).transpose()};
}

// The axis nearest to the spin is at the end of its range where the wheel is fast, and what it
// would measure is known: its speed. The projection of the spin on the others is best seen there.
Spin complete_rows(Spinning& rows) {
  const Spin slow = spin_axis_of(rows);
  Eigen::Index along = 0;
  slow.axis.cwiseAbs().maxCoeff(&along);
  Spinning complete;
  for (std::size_t k = 0; k < rows.time_s.size(); ++k) {
    double& spin = rows.rate[k](along);
    if (std::isnan(spin)) spin = slow.axis(along) * rows.speed[k] + slow.bias(along);
    if (!rows.rate[k].allFinite()) continue;
    complete.time_s.push_back(rows.time_s[k]);
    complete.angle.push_back(rows.angle[k]);
    complete.speed.push_back(rows.speed[k]);
    complete.force.push_back(rows.force[k]);
    complete.rate.push_back(rows.rate[k]);
  }
  rows = std::move(complete);
  return spin_axis_of(rows);
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

// Integral of a yaw rate by trapezoids. Where samples are missing in motion the rate is a random
// walk between its values at both ends: the integral over a gap of g then has the variance q g³/12
// of a Brownian bridge, q the variance that the rate gains in a second, from its means over half
// seconds.
class YawIntegral {
 public:
  explicit YawIntegral(double usual_step_s) : usual_step_s_(usual_step_s) {}

  // The yaw at the next sample.
  double add(double t, double rate, bool stands) {
    const double step_s = time_s_.empty() ? 0.0 : t - time_s_.back();
    const double yaw = yaw_.empty() ? 0.0 : yaw_.back() + 0.5 * step_s * (rate_ + rate);
    const bool is_gap = step_s > longest_step * usual_step_s_ && !(stands && stood_);
    gap_s3_.push_back((gap_s3_.empty() ? 0.0 : gap_s3_.back()) + (is_gap ? cube(step_s) : 0.0));
    if (is_gap) missing_s_ += step_s;
    if (is_gap || (stands && stood_)) {
      before_.reset();
      block_ = {};
    } else {
      add_to_block(rate, step_s);
    }
    time_s_.push_back(t);
    yaw_.push_back(yaw);
    rate_ = rate;
    stood_ = stands;
    return yaw;
  }
  [[nodiscard]] double missing_s() const { return missing_s_; }
  [[nodiscard]] const std::vector<double>& time_s() const { return time_s_; }
  [[nodiscard]] const std::vector<double>& yaw_rad() const { return yaw_; }
  // Variance up to each sample; empty if nothing is missing.
  [[nodiscard]] std::vector<double> gap_rad2() const {
    if (missing_s_ == 0.0) return {};
    // Means of a random walk over adjacent blocks of b differ by the variance 2 q b/3.
    const double q = pairs_ > 0.0 ? 1.5 * squares_ / (pairs_ * block_of_rate_s) : 0.0;
    std::vector<double> variance = gap_s3_;
    for (double& value : variance) value *= q / 12.0;
    return variance;
  }

 private:
  static constexpr double longest_step = 3.0, block_of_rate_s = 0.5;
  struct Block {
    double sum = 0.0, time_s = 0.0;
  };
  static double cube(double x) { return x * x * x; }
  void add_to_block(double rate, double step_s) {
    block_.sum += rate * step_s;
    block_.time_s += step_s;
    if (block_.time_s < block_of_rate_s) return;
    const double mean = block_.sum / block_.time_s;
    if (before_) {
      squares_ += square(mean - *before_);
      pairs_ += 1.0;
    }
    before_ = mean;
    block_ = {};
  }

  double usual_step_s_;
  std::vector<double> time_s_, yaw_, gap_s3_;
  double rate_ = 0.0, missing_s_ = 0.0, squares_ = 0.0, pairs_ = 0.0;
  bool stood_ = true;
  Block block_;
  std::optional<double> before_;
};

double usual_step_s(const std::vector<double>& time_s) {
  std::vector<double> steps;
  for (std::size_t k = 1; k < time_s.size(); ++k)
    if (time_s[k] > time_s[k - 1]) steps.push_back(time_s[k] - time_s[k - 1]);
  return median(std::move(steps)).value_or(0.0);
}

void note_missing(const WheelSensor& sensor, const YawIntegral& yaw, Trace& trace) {
  constexpr double worth_a_note_s = 0.1;
  if (yaw.missing_s() < worth_a_note_s) return;
  trace.notes.push_back(
      {Severity::warning,
       fmt::format("{}: the yaw rate is missing for {:.2g} s in motion and is interpolated there",
                   sensor.name, yaw.missing_s())});
}

}  // namespace

// The in-plane axes, rotated by the wheel's angle, give the rates about the upward direction, which
// is yaw, and about the direction of travel, which is noise and the axle's roll. The second
// measures the first's noise, over blocks of two turns, in which the modulation by the wheel's
// angle averages out. A wheel that stands has no yaw. Source: X. Niu, Y. Wu, J. Kuang, Wheel-INS
// (2021), section III.
void add_yaw(const WheelSensor& sensor, Trace& trace) {
  Spinning rows = spinning_rows(sensor, trace);
  if (rows.time_s.size() < 100) return;
  const Upward upward = upward_direction(rows);
  const Spin spin = complete_rows(rows);
  const Three axis = spin.axis.normalized();
  if (!(std::abs(spin.axis.norm() - 1.0) < 0.3)) {
    trace.notes.push_back(
        {Severity::warning, sensor.name +
                                ": the gyroscope does not show the wheel's spin, so its other axes "
                                "are not used for the yaw rate (unit?)"});
    return;
  }
  trace.spin_tilt_rad = std::acos(std::min(1.0, axis.cwiseAbs().maxCoeff()));
  YawIntegral yaw(usual_step_s(sensor.time_s));
  WalkFromBlocks walk;
  double block_from = 0.0;
  for (std::size_t k = 0; k < rows.time_s.size(); ++k) {
    const Three up =
        upward.by_sin * std::sin(rows.angle[k]) + upward.by_cos * std::cos(rows.angle[k]);
    const Three level_up = (up - axis * axis.dot(up)).normalized();
    const Three left = rows.rate[k] - spin.axis * rows.speed[k] - spin.bias;
    const bool stands = std::abs(rows.speed[k]) < standing_radps;
    yaw.add(rows.time_s[k], stands ? 0.0 : left.dot(level_up), stands);
    const double step_s = k > 0 ? rows.time_s[k] - rows.time_s[k - 1] : 0.0;
    if (!stands && step_s > 0.0 && step_s < 0.2) walk.add(left.dot(cross(axis, level_up)), step_s);
    if (std::abs(rows.angle[k] - block_from) >= block_turns * rad_per_turn) {
      walk.close_block();
      block_from = rows.angle[k];
    }
  }
  const std::vector<double> gap_rad2 = yaw.gap_rad2();
  for (const double t : trace.time_s) {
    trace.yaw_rad.push_back(at_time(yaw.time_s(), yaw.yaw_rad(), t));
    if (!gap_rad2.empty()) trace.yaw_gap_rad2.push_back(at_time(yaw.time_s(), gap_rad2, t));
  }
  trace.yaw_walk_rad2ps = walk.rad2ps();
  trace.yaw_bias_std_radps = wheel_bias_std_radps;
  note_missing(sensor, yaw, trace);
}

namespace {

bool is_resting(const std::vector<Stretch>& rests, double t) {
  return std::ranges::any_of(
      rests, [&](const Stretch& rest) { return t >= rest.start_s && t <= rest.end_s; });
}

// The force may be missing.
bool is_plausible(const Three& force, const Three& rate) {
  return rate.allFinite() && !force.isZero() && !(force.norm() > 1e3) &&
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
    if (!force.allFinite() || !is_resting(rests, sensor.time_s[k])) continue;
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
  YawIntegral yaw(usual_step_s(sensor.time_s));
  for (const std::size_t k : frame.rows) {
    const double t = sensor.time_s[k];
    const double rate = frame.up.dot(row(sensor.rate_radps, k) - frame.bias);
    const bool stands = is_resting(rests, t);
    const double step_s = trace.time_s.empty() ? 0.0 : t - trace.time_s.back();
    if (!trace.time_s.empty() && step_s <= 0.0) continue;
    if (stands && step_s > 0.0 && step_s < 0.2) walk.add(rate, step_s);
    if (walk.time_s() >= block_s) walk.close_block();
    trace.time_s.push_back(t);
    trace.yaw_rad.push_back(yaw.add(t, stands ? 0.0 : rate, stands));
  }
  trace.yaw_gap_rad2 = yaw.gap_rad2();
  note_missing(sensor, yaw, trace);
  // Roll and pitch in motion tilt the axis by a degree or so; vibration adds to the walk at rest.
  trace.yaw_walk_rad2ps = 4.0 * walk.rad2ps();
  trace.yaw_bias_std_radps = frame_bias_std_radps;
  return trace;
}

}  // namespace proofmass::estimate::drive
