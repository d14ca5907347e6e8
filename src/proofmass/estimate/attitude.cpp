#include "proofmass/estimate/attitude.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "proofmass/core/chi_square.hpp"
#include "proofmass/core/linalg.hpp"
#include "proofmass/estimate/attitude/model.hpp"

namespace proofmass::estimate {
namespace {

constexpr int N = inertial::states;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Limits the influence of a shock at a rest to this many standard deviations.
constexpr Gate gate{.huber = 5.0};

/// Rate due to the hand or flicker that is not a rotation within the rest.
constexpr double idle_turn_radps = 2e-3;

/// Whether the gyroscope measures its bias in the rest that begins at sample k.
bool is_still(const AttitudeModel& model,
              std::size_t k,
              const NominalState& before,
              const Mat<N, N>& cov) {
  const std::vector<InertialSample>& samples = model.series().samples;
  Mat<3> sum = Mat<3>::Zero();
  double count = 0.0;
  for (std::size_t i = k; i < samples.size() && samples[i].rest == samples[k].rest; ++i) {
    if (i > k && samples[i].starts) break;
    sum += samples[i].rate;
    count += 1.0;
  }
  const Mat<3> off = sum / count - before.rate_bias;
  Mat<3, 3> expected = cov.block<3, 3>(inertial::rate_bias, inertial::rate_bias);
  expected.diagonal().array() += idle_turn_radps * idle_turn_radps;
  return off.dot(positive_inverse(expected) * off) < chi_square_quantile(1.0 - 1e-6, 3.0);
}

Symmetric3 packed(const Mat<N, N>& cov, int at) {
  return {cov(at, at),         cov(at, at + 1),     cov(at, at + 2),
          cov(at + 1, at + 1), cov(at + 1, at + 2), cov(at + 2, at + 2)};
}

/// The filter, with each estimate as the nominal motion of the next step.
void follow(AttitudeModel& model, Attitude& out) {
  FilterState<N> state;
  StepOf<AttitudeModel> step;
  for (std::size_t k = 0; k < model.size(); ++k) {
    const InertialSample& sample = model.series().samples[k];
    if (k == 0) {
      model.nominal[0] = model.start(0);
      state.x = model.prior();
    }
    if (sample.enters_rest && !is_still(model, k, model.nominal[k > 0 ? k - 1 : 0], state.x.cov)) {
      model.rest_used[static_cast<std::size_t>(sample.rest)] = 0;
      if (k == 0) state.x = model.prior();
    }
    if (k > 0) model.nominal[k] = model.moved(model.nominal[k - 1], k);
    advance(model, k, gate, state, step);
    model.nominal[k].move_by(state.x.mean);
    state.x.mean.setZero();
    out.filtered_velocity_mps[sample.row] = model.nominal[k].v;
    out.filtered_position_m[sample.row] = model.nominal[k].p;
    out.filtered_position_cov_m2[sample.row] = packed(state.x.cov, inertial::position);
  }
}

/// One pass of the smoother about the nominal motion, which it then updates.
class Pass {
 public:
  explicit Pass(AttitudeModel& model) : model_(&model), errors_(model.size()) {}

  /// Correction by the last pass at sample k.
  [[nodiscard]] const InertialError& error(std::size_t k) const { return errors_[k]; }

  /// Returns the largest tilt correction, rad. Heading does not count: it is not observable and may
  /// change a lot without effect on anything else.
  template <class Forward, class Backward>
  double run(Forward&& forward, Backward&& backward) {
    smooth(
        *model_, FilterState<N>{model_->prior()}, gate, std::forward<Forward>(forward),
        [&](std::size_t k, const StepOf<AttitudeModel>& step, const BackwardInformation<N>& later) {
          errors_[k] = later.mean(step.filtered);
          backward(k, step, later);
        });
    double largest = 0.0;
    for (std::size_t k = 0; k < errors_.size(); ++k) {
      largest = std::max(largest, errors_[k].segment<2>(inertial::attitude).norm());
      model_->nominal[k].move_by(errors_[k]);
    }
    return largest;
  }

 private:
  AttitudeModel* model_;
  std::vector<InertialError> errors_;
};

Mat<3> stds(const Mat<N, N>& cov, int at) {
  return cov.diagonal().segment<3>(at).cwiseMax(0.0).cwiseSqrt();
}

Attitude without_estimates(std::size_t size) {
  const Mat<3> none = Mat<3>::Constant(nan);
  Symmetric3 no_cov;
  no_cov.fill(nan);
  Attitude out;
  out.quaternion.assign(size, {nan, nan, nan, nan});
  for (auto* covs : {&out.attitude_cov_rad2, &out.velocity_cov_m2ps2, &out.position_cov_m2,
                     &out.filtered_position_cov_m2})
    covs->assign(size, no_cov);
  for (auto* vectors : {&out.velocity_mps, &out.position_m, &out.filtered_velocity_mps,
                        &out.filtered_position_m, &out.rate_bias_radps, &out.rate_bias_std_radps,
                        &out.accel_bias_mps2, &out.accel_bias_std_mps2})
    vectors->assign(size, none);
  out.nis.assign(size, 0.0F);
  out.readings.assign(size, 0);
  return out;
}

void take_covariances(const Mat<N, N>& cov, std::size_t row, Attitude& out) {
  out.attitude_cov_rad2[row] = packed(cov, inertial::attitude);
  out.velocity_cov_m2ps2[row] = packed(cov, inertial::velocity);
  out.position_cov_m2[row] = packed(cov, inertial::position);
  out.rate_bias_std_radps[row] = stds(cov, inertial::rate_bias);
  out.accel_bias_std_mps2[row] = stds(cov, inertial::accel_bias);
}

void take_nis(const AttitudeModel& model,
              std::size_t k,
              const StepOf<AttitudeModel>& step,
              Attitude& out) {
  const std::size_t row = model.series().samples[k].row;
  double nis = 0.0;
  const int count = model.sensor_readings(k);
  for (int i = 0; i < count; ++i) nis += step.updates[static_cast<std::size_t>(i)].nis();
  out.nis[row] = static_cast<float>(nis);
  out.readings[row] = static_cast<unsigned char>(count);
}

void take_motion(const AttitudeModel& model, Attitude& out) {
  std::array<double, 4> beside = {1.0, 0.0, 0.0, 0.0};
  for (std::size_t k = 0; k < model.size(); ++k) {
    const std::size_t row = model.series().samples[k].row;
    const NominalState& state = model.nominal[k];
    out.quaternion[row] = beside = quaternion_of(state.R, beside);
    out.velocity_mps[row] = state.v;
    out.position_m[row] = state.p;
    out.rate_bias_radps[row] = state.rate_bias;
    out.accel_bias_mps2[row] = state.accel_bias;
  }
}

/// Whether the last pass changed no attitude by more than a tenth of its standard deviation.
bool has_settled(const AttitudeModel& model, const Pass& pass, const Attitude& out) {
  for (std::size_t k = 0; k < model.size(); ++k) {
    const Symmetric3& cov = out.attitude_cov_rad2[model.series().samples[k].row];
    const Mat<3> variance(cov[0], cov[3], cov[5]);
    const Mat<3> step = pass.error(k).segment<3>(inertial::attitude);
    if ((step.cwiseAbs2().array() > (0.01 * variance.array()).max(1e-10)).any()) return false;
  }
  return true;
}

void say(const AttitudeModel& model, const std::vector<signal::Rest>& rests, Attitude& out) {
  std::vector<unsigned char> reached(rests.size(), 0);
  for (const InertialSample& sample : model.series().samples)
    if (sample.rest >= 0) reached[static_cast<std::size_t>(sample.rest)] = 1;
  bool any = false;
  for (std::size_t r = 0; r < rests.size(); ++r) {
    RestUse use{rests[r], reached[r] != 0 && model.rest_used[r] != 0, ""};
    if (reached[r] == 0)
      use.why_not = "none of its samples has values of both sensors";
    else if (!use.used)
      use.why_not = "the gyroscope turns while the accelerometer is at rest";
    any = any || use.used;
    out.rests.push_back(std::move(use));
  }
  out.notes.push_back({Severity::info,
                       "heading is not observable from a gyroscope and an accelerometer: it counts "
                       "from 0 at the start, and its standard deviation grows with time"});
  if (!any)
    out.notes.push_back({Severity::warning,
                         "no rest was used: the vertical and the biases rest on the bound of the "
                         "velocity alone"});
  if (out.stretches.size() > 1)
    out.notes.push_back(
        {Severity::warning, std::to_string(out.stretches.size() - 1) +
                                " gaps: heading, velocity and position restart after each"});
  if (!out.converged)
    out.notes.push_back({Severity::warning,
                         "the smoothed attitude had not settled when the iteration was stopped"});
}

}  // namespace

Result<Attitude> estimate_attitude(const InertialSeries& series,
                                   const std::vector<signal::Rest>& rests,
                                   const AttitudeOptions& options) {
  PM_EXPECTS(options.gravity_mps2 > 0.0 && options.speed_std_mps > 0.0 &&
             options.speed_interval_s > 0.0 && options.rest_speed_std_mps > 0.0);
  const Result<PreparedSeries> prepared = prepare(series, rests, options);
  if (!prepared) return prepared.error();
  AttitudeModel model(*prepared, options);
  model.rest_used.resize(rests.size(), 0);
  const auto report = [&](double fraction) {
    if (options.progress) options.progress("attitude", fraction);
  };
  Attitude out = without_estimates(series.time_s.size());
  follow(model, out);
  Pass pass(model);
  const auto nothing = [](const auto&...) {};
  // Gauss–Newton squares its step approximately, so the pass after a step below this is the last.
  constexpr double nearly_rad = 2e-3;
  constexpr int most_passes = 10;
  double tilt_rad = 1.0;
  while (tilt_rad > nearly_rad && out.iterations < most_passes) {
    report(0.2 + 0.1 * std::min(out.iterations, 4));
    tilt_rad = pass.run(nothing, nothing);
    ++out.iterations;
  }
  report(0.7);
  pass.run(
      [&](std::size_t k, const StepOf<AttitudeModel>& step) { take_nis(model, k, step, out); },
      [&](std::size_t k, const StepOf<AttitudeModel>& step, const BackwardInformation<N>& later) {
        take_covariances(later.cov<N>(step.filtered), model.series().samples[k].row, out);
      });
  ++out.iterations;
  out.converged = has_settled(model, pass, out);
  take_motion(model, out);
  out.stretches = prepared->stretches;
  out.interpolated = prepared->interpolated;
  out.rate_noise_radps_rthz = prepared->rate_noise;
  out.accel_noise_mps2_rthz = prepared->accel_noise;
  out.gravity_mps2 = options.gravity_mps2;
  say(model, rests, out);
  report(1.0);
  return out;
}

std::array<std::vector<double>, 3> gravity_free_acceleration(const InertialSeries& series,
                                                             const Attitude& attitude) {
  const std::size_t size = series.time_s.size();
  PM_EXPECTS(attitude.quaternion.size() == size);
  std::array<std::vector<double>, 3> out;
  for (std::vector<double>& axis : out) axis.resize(size);
  for (std::size_t k = 0; k < size; ++k) {
    const Mat<3> force(series.accel_mps2[0][k], series.accel_mps2[1][k], series.accel_mps2[2][k]);
    Mat<3> accel = rotation_of(attitude.quaternion[k]) * (force - attitude.accel_bias_mps2[k]);
    accel.z() -= attitude.gravity_mps2;
    for (int i = 0; i < 3; ++i) out[static_cast<std::size_t>(i)][k] = accel(i);
  }
  return out;
}

double inclination_std_rad(const Symmetric3& attitude_cov_rad2) {
  const double xx = attitude_cov_rad2[0], xy = attitude_cov_rad2[1], yy = attitude_cov_rad2[3];
  const double half = 0.5 * (xx - yy);
  return std::sqrt(0.5 * (xx + yy) + std::hypot(half, xy));
}

}  // namespace proofmass::estimate
