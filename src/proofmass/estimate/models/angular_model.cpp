#include "proofmass/estimate/models/angular_model.hpp"

#include <numbers>

#include "proofmass/estimate/motion_models.hpp"

namespace proofmass::estimate {

LinearModel<4, 3, 1> angular_model(const AngularOptions& options) {
  PM_EXPECTS(options.bias_time_constant_s >= 0.0);
  // The same equations as along a line, with angles for lengths.
  const LinearModel<3, 1> motion =
      pva_model({options.dt_s, options.jerk_psd_rad2ps5, options.accel_variance_rad2ps4});
  const BiasStep bias =
      options.bias_time_constant_s > 0.0
          ? bias_step({options.dt_s, options.bias_time_constant_s, options.bias_psd_rad2ps5})
          : random_walk_step({options.dt_s, options.bias_psd_rad2ps5});
  LinearModel<3, 3> turning;
  turning.F = motion.F;
  turning.Q = motion.Q;
  turning.H.setZero();
  turning.H(angular::accel_channel, angular::accel_radps2) = 1.0;
  turning.H(angular::rate_channel, angular::rate_radps) = 1.0;
  turning.H(angular::angle_channel, angular::angle_rad) = 1.0;
  turning.R << options.accel_variance_rad2ps4, options.rate_variance_rad2ps2,
      options.angle_variance_rad2;
  return with_bias(turning, bias, Mat<3>(1.0, 0.0, 0.0));
}

Uncertain angular_accel(const OppositePair& pair) {
  PM_EXPECTS(pair.radius_m > 0.0 && pair.variance_m2ps4 >= 0.0);
  return {(pair.first_mps2 - pair.second_mps2) / (2.0 * pair.radius_m),
          std::sqrt(pair.variance_m2ps4) / (std::numbers::sqrt2 * pair.radius_m)};
}

LinearModel<2, 1, 1> tilt_rate_model(const TiltRateOptions& options) {
  PM_EXPECTS(options.dt_s >= 0.0 && options.rate_psd_rad2ps >= 0.0 &&
             options.bias_psd_rad2ps3 >= 0.0);
  const double t = options.dt_s, q = options.bias_psd_rad2ps3;
  LinearModel<2, 1, 1> model;
  model.F << 1.0, -t, 0.0, 1.0;
  model.Q << options.rate_psd_rad2ps * t + q * t * t * t / 3.0, -q * t * t / 2.0, -q * t * t / 2.0,
      q * t;
  model.H << 1.0, 0.0;
  model.R << options.angle_variance_rad2;
  model.B << t, 0.0;
  return model;
}

template LinearRun<4, 3> filter_linear(LinearSeries<4, 3, 1>,
                                       const Start<4>&,
                                       const LinearOptions&);
template LinearRun<4, 3> smooth_linear(LinearSeries<4, 3, 1>,
                                       const Start<4>&,
                                       const LinearOptions&);
template LinearRun<2, 1> filter_linear(LinearSeries<2, 1, 1>,
                                       const Start<2>&,
                                       const LinearOptions&);
template LinearRun<2, 1> smooth_linear(LinearSeries<2, 1, 1>,
                                       const Start<2>&,
                                       const LinearOptions&);

}  // namespace proofmass::estimate
