#include "proofmass/estimate/gain_study.hpp"

#include <cmath>

#include "proofmass/core/contract.hpp"
#include "proofmass/estimate/motion_models.hpp"

namespace proofmass::estimate {
namespace {

constexpr double settled_within = 0.02;

struct Limit {
  std::array<double, 3> gain{};
  double variance = 0.0, predicted = 0.0;  // of the acceleration, after and before a measurement
};

// Fixed point of the covariances with the acceleration, one after the other: of the acceleration
// itself, then of the velocity with it, then of the position.
Limit limit_of(const GainStudyOptions& options, const LinearModel<3, 1>& model) {
  const double h = options.step_s, R = options.accel_variance_m2ps4, rho = model.Q(2, 2) / R;
  Limit limit;
  const double k = 2.0 * rho / (std::sqrt(rho * rho + 4.0 * rho) + rho);
  if (!(rho > 0.0)) return limit;
  const double P = R * k, S = P + model.Q(2, 2) + R;
  const double va = (h * P + model.Q(1, 2)) / k;
  const double pa = (h * (1.0 - k) * va + 0.5 * h * h * P + model.Q(0, 2)) / k;
  limit.gain = {pa / S, va / S, k};
  limit.variance = P;
  limit.predicted = P + model.Q(2, 2);
  return limit;
}

LinearModel<3, 1> model_of(const GainStudyOptions& options) {
  PM_EXPECTS(options.step_s > 0.0 && options.accel_variance_m2ps4 > 0.0);
  PM_EXPECTS(options.jerk_psd_m2ps5 >= 0.0 && options.prior_variance > 0.0);
  return pva_model({.dt_s = options.step_s,
                    .jerk_psd_m2ps5 = options.jerk_psd_m2ps5,
                    .accel_variance_m2ps4 = options.accel_variance_m2ps4});
}

}  // namespace

GainStudy gain_study(const GainStudyOptions& options) {
  const LinearModel<3, 1> model = model_of(options);
  GainStudy study{.options = options, .epochs = {}};
  const Limit limit = limit_of(options, model);
  study.limit = limit.gain;
  study.limit_variance_m2ps4 = limit.variance;
  Mat<3, 3> P = Mat<3, 3>::Identity() * options.prior_variance;
  const auto steps =
      static_cast<std::size_t>(std::floor(options.duration_s / options.step_s + 1e-9));
  study.epochs.reserve(steps + 1);
  for (std::size_t k = 0; k <= steps; ++k) {
    if (k > 0) P = (model.F * P * model.F.transpose() + model.Q).eval();
    const double S = P(2, 2) + options.accel_variance_m2ps4;
    const Mat<3> gain = P.col(2) / S;
    P = (P - S * gain * gain.transpose()).eval();
    GainEpoch& epoch = study.epochs.emplace_back();
    epoch.t_s = static_cast<double>(k) * options.step_s;
    for (int i = 0; i < 3; ++i) {
      epoch.gain[static_cast<std::size_t>(i)] = gain(i);
      epoch.variance[static_cast<std::size_t>(i)] = P(i, i);
    }
  }
  for (std::size_t i = 0; i < 3; ++i) study.settling_s[i] = settling_s(study, i, settled_within);
  return study;
}

std::optional<double> settling_s(const GainStudy& study, std::size_t state, double within) {
  const double limit = study.limit[state];
  std::optional<double> since;
  for (const GainEpoch& epoch : study.epochs) {
    const bool near = std::abs(epoch.gain[state] - limit) <= within * std::abs(limit);
    if (near && !since) since = epoch.t_s;
    if (!near) since.reset();
  }
  return since;
}

std::vector<StepSizeEffect> step_size_study(const GainStudyOptions& options, View<double> steps_s) {
  std::vector<StepSizeEffect> effects;
  for (const double step_s : steps_s) {
    GainStudyOptions own = options;
    own.step_s = step_s;
    const Limit limit = limit_of(own, model_of(own));
    effects.push_back({.step_s = step_s,
                       .gain = limit.gain[2],
                       .accel_std_mps2 = std::sqrt(limit.variance),
                       .predicted_std_mps2 = std::sqrt(limit.predicted),
                       .settling_s = gain_study(own).settling_s[2]});
  }
  return effects;
}

}  // namespace proofmass::estimate
