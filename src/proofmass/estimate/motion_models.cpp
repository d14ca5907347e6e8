#include "proofmass/estimate/motion_models.hpp"

#include "proofmass/estimate/bias_models.hpp"

namespace proofmass::estimate {

LinearModel<3, 1> pva_model(const PvaOptions& options) {
  PM_EXPECTS(options.dt_s >= 0.0 && options.jerk_psd_m2ps5 >= 0.0);
  const double t = options.dt_s;
  const double t2 = t * t, t3 = t2 * t, t4 = t3 * t, t5 = t4 * t;
  LinearModel<3, 1> model;
  // clang-format off
  model.F << 1, t, t2 / 2,
             0, 1, t,
             0, 0, 1;
  model.Q << t5 / 20, t4 / 8, t3 / 6,
             t4 / 8,  t3 / 3, t2 / 2,
             t3 / 6,  t2 / 2, t;
  // clang-format on
  model.Q *= options.jerk_psd_m2ps5;
  model.H.setZero();
  model.H(pva::accel_mps2) = 1.0;
  model.R << options.accel_variance_m2ps4;
  return model;
}

LinearModel<4, 1, 1> pva_bias_model(const PvaBiasOptions& options) {
  const BiasStep step =
      bias_step({options.motion.dt_s, options.time_constant_s, options.bias_psd_m2ps5});
  return with_bias(pva_model(options.motion), step, Mat<1>(1.0));
}

template LinearRun<3, 1> filter_linear(LinearSeries<3, 1>, const Gaussian<3>&, const Gate&);
template LinearRun<3, 1> smooth_linear(LinearSeries<3, 1>, const Gaussian<3>&, const Gate&);
template LinearRun<4, 1> filter_linear(LinearSeries<4, 1, 1>, const Gaussian<4>&, const Gate&);
template LinearRun<4, 1> smooth_linear(LinearSeries<4, 1, 1>, const Gaussian<4>&, const Gate&);

}  // namespace proofmass::estimate
