#include "proofmass/calibrate/gyroscope/data.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <span>

#include "proofmass/calibrate/multi_position/dwell_noise.hpp"
#include "proofmass/calibrate/multi_position/norm_model.hpp"
#include "proofmass/core/so3.hpp"
#include "proofmass/core/statistics.hpp"
#include "proofmass/signal/rounding.hpp"

namespace proofmass::calibrate {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Vector3d;

// A step longer than this many usual ones has missing samples in it.
constexpr double gap_steps = 3.5;

Vector3d at(const std::array<std::vector<double>, 3>& axes, std::size_t n) {
  return {axes[0][n], axes[1][n], axes[2][n]};
}

std::array<View<double>, 3> views(const std::array<std::vector<double>, 3>& axes) {
  return {axes[0], axes[1], axes[2]};
}

Status check(const GyroscopeSession& session) {
  const std::size_t n = session.time_s.size();
  for (const auto* axes : {&session.rate, &session.accel})
    for (const std::vector<double>& axis : *axes)
      if (axis.size() != n)
        return Error{
            Errc::invalid_argument,
            fmt::format("gyroscope: {} samples of a channel for {} times", axis.size(), n)};
  if (session.poses.size() != session.rests.size())
    return Error{Errc::invalid_argument, "gyroscope: a position has no interval at rest"};
  std::size_t next = 0;
  for (const Dwell& rest : session.rests) {
    if (rest.first < next || rest.last < rest.first || rest.last >= n)
      return Error{Errc::invalid_argument,
                   "gyroscope: the rests must be in order and within the recording"};
    next = rest.last + 1;
  }
  return Done{};
}

// Specific force of a mean, f = T diag(1/scale) (mean − bias).
Vector3d force_of(const Parameters& p, const Vector3d& mean) {
  return correction(p) * (mean - p.head<3>());
}

// Rotation vector of `up` per parameter, by central differences over a thousandth of its size.
Eigen::Matrix<double, 3, 9> tilt_by_parameters(const MultiPosition& fit, const Vector3d& mean) {
  Eigen::Matrix<double, 3, 9> out = Eigen::Matrix<double, 3, 9>::Zero();
  const Parameters p(fit.estimate.data());
  const Vector3d force = force_of(p, mean);
  for (Index k = 0; k < 9; ++k) {
    const double h = k < 3 ? 1e-3 * std::abs(p(3 + k)) * fit.gravity_mps2
                           : (k < 6 ? 1e-3 * std::abs(p(k)) : 1e-3);
    Parameters above = p, below = p;
    above(k) += h;
    below(k) -= h;
    const Vector3d slope = (force_of(above, mean) - force_of(below, mean)) / (2.0 * h);
    out.col(k) = force.cross(slope) / force.squaredNorm();
  }
  return out;
}

// Noise of the means of all rests of one session.
struct SessionNoiseOfRate {
  PoseMeans means;
  std::array<DwellNoise, 3> axis;
};

Result<SessionNoiseOfRate> noise_of(const GyroscopeSession& session) {
  Result<PoseMeans> means = pose_means(views(session.rate), session.rests, session.rate_lsb);
  if (!means) return means.error().at("gyroscope");
  SessionNoiseOfRate out{std::move(means).value(), {}};
  std::vector<double> lengths;
  for (const Dwell& rest : session.rests)
    lengths.push_back(static_cast<double>(rest.last - rest.first + 1));
  for (std::size_t k = 0; k < 3; ++k)
    out.axis[k] =
        fit_dwell_noise(out.means.session.levels[k], *median(lengths), session.rate_lsb[k]);
  return out;
}

// Variance of a rest's mean due to quantisation, the mean over all rests. A gyroscope has nearly
// the same reading in all of them, so that their scatter does not show it: the values of each do.
Vector3d rounding_of(const GyroscopeSession& session) {
  Vector3d sum = Vector3d::Zero();
  for (const Dwell& rest : session.rests)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::vector<double>& rate = session.rate[axis];
      std::vector<double> values;
      for (std::size_t n = rest.first; n <= rest.last; ++n)
        if (std::isfinite(rate[n])) values.push_back(rate[n]);
      sum(static_cast<Index>(axis)) +=
          signal::rounding_variance(std::move(values), session.rate_lsb[axis]);
    }
  return sum / static_cast<double>(session.rests.size());
}

GyroscopeRest rest_of(const Pose& pose,
                      const Pose& rate,
                      const Vector3d& rounding,
                      const MultiPosition& accelerometer) {
  const Parameters p(accelerometer.estimate.data());
  GyroscopeRest out;
  out.force = force_of(p, pose.mean);
  out.up = out.force.normalized();
  const Matrix3d tilt = cross_matrix(out.up) * correction(p) / out.force.norm();
  out.tilt_covariance = tilt * pose.mean_covariance * tilt.transpose();
  out.tilt_by_accel = tilt_by_parameters(accelerometer, pose.mean);
  out.mean = rate.mean;
  out.rounding = rounding;
  out.variance = rate.mean_covariance.diagonal() - rate.rounding_variance + rounding;
  return out;
}

// Usual step between the samples of a session, and how far single stamps are from an even one.
struct Stepping {
  double usual_s = 0.0, stamp_std_s = 0.0;
};

Stepping stepping_of(const std::vector<double>& time_s) {
  std::vector<double> steps;
  for (std::size_t n = 1; n < time_s.size(); ++n) steps.push_back(time_s[n] - time_s[n - 1]);
  Stepping out{.usual_s = median(steps).value_or(0.0)};
  Moments deviation;
  for (const double step : steps)
    if (std::abs(step - out.usual_s) < 0.5 * out.usual_s) deviation.add(step - out.usual_s);
  // A late stamp makes one step longer and the next one shorter.
  if (deviation.count > 1) out.stamp_std_s = deviation.std() / std::numbers::sqrt2;
  return out;
}

struct Row {
  double time_s;
  Vector3d reading, force;
};

// The cubic through four rows.
Row interpolated(std::span<const Row, 4> rows, double time_s) {
  Row out{time_s, Vector3d::Zero(), Vector3d::Zero()};
  for (std::size_t i = 0; i < 4; ++i) {
    double weight = 1.0;
    for (std::size_t j = 0; j < 4; ++j)
      if (j != i) weight *= (time_s - rows[j].time_s) / (rows[i].time_s - rows[j].time_s);
    out.reading += weight * rows[i].reading;
    out.force += weight * rows[i].force;
  }
  return out;
}

// The samples with a value of every axis from one rest to the next.
std::vector<Row> rows_between(const GyroscopeSession& session,
                              const Parameters& accelerometer,
                              const Dwell& before,
                              const Dwell& after) {
  const auto is_there = [&](std::size_t n) {
    return at(session.rate, n).allFinite() && at(session.accel, n).allFinite();
  };
  std::size_t first = before.last, last = after.first;
  while (first > before.first && !is_there(first)) --first;
  while (last < after.last && !is_there(last)) ++last;
  std::vector<Row> rows;
  for (std::size_t n = first; n <= last; ++n)
    if (is_there(n))
      rows.push_back(
          {session.time_s[n], at(session.rate, n), force_of(accelerometer, at(session.accel, n))});
  return rows;
}

// Adds row k, and interpolated ones where rows are missing before it.
void add_row(const std::vector<Row>& rows,
             std::size_t k,
             const Stepping& stepping,
             MotionSamples& out) {
  const double step_s = rows[k].time_s - rows[k - 1].time_s;
  // At the ends, the sensor is at rest.
  const bool is_inside = k > 1 && k + 1 < rows.size();
  const double parts = is_inside ? std::max(1.0, std::round(step_s / stepping.usual_s)) : 1.0;
  const auto add = [&](const Row& row) {
    out.step_s.push_back(step_s / parts);
    out.reading.push_back(row.reading);
    out.force.push_back(row.force);
  };
  for (double part = 1.0; part < parts; part += 1.0)
    add(interpolated(std::span<const Row, 4>(&rows[k - 2], 4),
                     rows[k - 1].time_s + step_s * part / parts));
  add(rows[k]);
}

// The samples of a motion, up to two missing ones interpolated, or why they cannot be integrated.
std::string take_samples(const GyroscopeSession& session,
                         const MultiPosition& accelerometer,
                         std::size_t from,
                         const Stepping& stepping,
                         MotionSamples& out) {
  constexpr auto missing = "samples are missing, or at the limit of the range";
  const std::vector<Row> rows = rows_between(session, Parameters(accelerometer.estimate.data()),
                                             session.rests[from], session.rests[from + 1]);
  if (rows.size() < 2) return missing;
  out.stamp_std_s = stepping.stamp_std_s;
  out.reading.push_back(rows.front().reading);
  out.force.push_back(rows.front().force);
  for (std::size_t k = 1; k < rows.size(); ++k) {
    const double step_s = rows[k].time_s - rows[k - 1].time_s;
    if (!(step_s > 0.0)) return "its times do not increase";
    if (step_s > gap_steps * stepping.usual_s) return missing;
    add_row(rows, k, stepping, out);
  }
  return {};
}

// Readings less the mean of the two rests: the bias there, with what Earth's rotation adds to both.
void subtract_rests(const GyroscopeRest& before,
                    const GyroscopeRest& after,
                    MotionSamples& samples) {
  const Vector3d bias = 0.5 * (before.mean + after.mean);
  const Vector3d force = 0.5 * (before.force + after.force);
  for (Vector3d& reading : samples.reading) reading -= bias;
  for (Vector3d& one : samples.force) one -= force;
}

void add_motions(const GyroscopeSession& session,
                 std::size_t index,
                 const MultiPosition& accelerometer,
                 const SessionNoiseOfRate& noise,
                 GyroscopeData& data) {
  const Stepping stepping = stepping_of(session.time_s);
  const std::size_t base = data.rests.size() - session.rests.size();
  for (std::size_t k = 0; k + 1 < session.rests.size(); ++k) {
    MotionResidual& listed = data.residuals.emplace_back();
    listed.session = index;
    listed.from = k;
    listed.start_s = session.time_s[session.rests[k].last];
    listed.end_s = session.time_s[session.rests[k + 1].first];
    GyroscopeMotion motion{.samples = {}, .from = base + k, .to = base + k + 1, .noise_axes = {}};
    listed.why_unused = take_samples(session, accelerometer, k, stepping, motion.samples);
    listed.used = listed.why_unused.empty();
    if (!listed.used) continue;
    subtract_rests(data.rests[motion.from], data.rests[motion.to], motion.samples);
    const std::size_t steps = motion.samples.step_s.size();
    for (Index axis = 0; axis < 3; ++axis)
      motion.noise_axes(axis) = noise.axis[static_cast<std::size_t>(axis)].variance_of_mean(steps) *
                                motion.samples.duration_s();
    data.motions.push_back(std::move(motion));
    data.listed.push_back(data.residuals.size() - 1);
  }
}

Status add_rate(const GyroscopeSession& session,
                const TurntableRate& row,
                const MultiPosition& accelerometer,
                const SessionNoiseOfRate& noise,
                GyroscopeData& data) {
  const auto& time = session.time_s;
  const auto first = std::ranges::lower_bound(time, row.start_s) - time.begin();
  const auto end = std::ranges::upper_bound(time, row.end_s) - time.begin();
  if (end - first < 2)
    return Error{Errc::invalid_argument, fmt::format("turntable: no samples from {:g} s to {:g} s",
                                                     row.start_s, row.end_s)};
  const Dwell span{static_cast<std::size_t>(first), static_cast<std::size_t>(end) - 1};
  Vector3d reading = Vector3d::Zero(), accel = Vector3d::Zero();
  double count = 0.0;
  for (std::size_t n = span.first; n <= span.last; ++n) {
    if (!at(session.rate, n).allFinite() || !at(session.accel, n).allFinite()) continue;
    reading += at(session.rate, n);
    accel += at(session.accel, n);
    ++count;
  }
  if (count < 2.0)
    return Error{Errc::invalid_argument,
                 fmt::format("turntable: only missing samples from {:g} s", row.start_s)};
  GyroscopeRate& rate = data.rates.emplace_back();
  rate.mean = reading / count;
  rate.force = force_of(Parameters(accelerometer.estimate.data()), accel / count);
  for (Index axis = 0; axis < 3; ++axis)
    rate.variance(axis) = noise.axis[static_cast<std::size_t>(axis)].variance_of_mean(
        static_cast<std::size_t>(count));
  rate.rate_radps = std::abs(row.rate_radps);
  rate.std_radps = row.std_radps;
  return Done{};
}

void add_rests(const GyroscopeSession& session,
               std::size_t index,
               const MultiPosition& accelerometer,
               const SessionNoiseOfRate& noise,
               GyroscopeData& data) {
  const Vector3d rounding = rounding_of(session);
  for (std::size_t k = 0; k < session.rests.size(); ++k) {
    GyroscopeRest& rest = data.rests.emplace_back(
        rest_of(session.poses[k], noise.means.poses[k], rounding, accelerometer));
    rest.session = index;
    rest.span_s = {session.time_s[session.rests[k].first], session.time_s[session.rests[k].last]};
  }
  const double step_s = stepping_of(session.time_s).usual_s;
  for (Index axis = 0; axis < 3; ++axis)
    data.white(axis) =
        std::max(data.white(axis), noise.axis[static_cast<std::size_t>(axis)].white * step_s);
}

Status add_session(const GyroscopeSession& session,
                   std::size_t index,
                   const MultiPosition& accelerometer,
                   View<TurntableRate> table,
                   GyroscopeData& data) {
  if (const Status fits = check(session); !fits) return fits.error();
  if (session.rests.empty()) return Error{Errc::too_few_samples, "gyroscope: no rest"};
  const Result<SessionNoiseOfRate> noise = noise_of(session);
  if (!noise) return noise.error();
  // The accelerometer's noise and the gyroscope's: the worse known decides.
  const double dof = std::min(session.pose_noise_dof, noise->means.noise_dof);
  data.noise_dof = index == 0 ? dof : std::min(data.noise_dof, dof);
  add_rests(session, index, accelerometer, *noise, data);
  add_motions(session, index, accelerometer, *noise, data);
  for (const TurntableRate& row : table) {
    if (row.session != index) continue;
    if (const Status done = add_rate(session, row, accelerometer, *noise, data); !done)
      return done.error();
  }
  return Done{};
}

}  // namespace

Result<GyroscopeData> gyroscope_data(View<GyroscopeSession> sessions,
                                     const MultiPosition& accelerometer,
                                     View<TurntableRate> table) {
  GyroscopeData data;
  for (std::size_t s = 0; s < sessions.size(); ++s)
    if (const Status added = add_session(sessions[s], s, accelerometer, table, data); !added)
      return added.error();
  return data;
}

}  // namespace proofmass::calibrate
