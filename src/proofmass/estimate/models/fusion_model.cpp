#include "proofmass/estimate/models/fusion_model.hpp"

namespace proofmass::estimate {

LinearModel<14, 4, 2> fusion_model(const FusionModelOptions& options) {
  PM_EXPECTS(options.bias_x.dt_s == options.bias_y.dt_s);
  LinearModel<14, 4, 2> model;
  model.F.setZero();
  model.Q.setZero();
  model.H.setZero();
  for (int i = 0; i < fusion::axes; ++i) {
    const PvaOptions& axis = options.axes[static_cast<std::size_t>(i)];
    PM_EXPECTS(axis.dt_s == options.bias_x.dt_s);
    const LinearModel<3, 1> motion = pva_model(axis);
    const int at = 3 * i;
    model.F.block<3, 3>(at, at) = motion.F;
    model.Q.block<3, 3>(at, at) = motion.Q;
    model.H(i, at + pva::accel_mps2) = 1.0;
    model.H(i, i % 2 == 0 ? fusion::bias_x_mps2 : fusion::bias_y_mps2) = 1.0;
    model.R(i) = motion.R.value();
  }
  for (int i = 0; i < 2; ++i) {
    const BiasStep bias = bias_step(i == 0 ? options.bias_x : options.bias_y);
    const int at = fusion::bias_x_mps2 + i;
    model.F(at, at) = bias.phi;
    model.Q(at, at) = bias.variance_m2ps4;
    model.B(at, i) = bias.settled;
  }
  return model;
}

template LinearRun<14, 4> filter_linear(LinearSeries<14, 4, 2>,
                                        const Start<14>&,
                                        const LinearOptions&);
template LinearRun<14, 4> smooth_linear(LinearSeries<14, 4, 2>,
                                        const Start<14>&,
                                        const LinearOptions&);

}  // namespace proofmass::estimate
