#include "proofmass/estimate/models/bias_models.hpp"

namespace proofmass::estimate {

BiasStep bias_step(const BiasOptions& options) {
  PM_EXPECTS(options.bias_psd_m2ps5 >= 0.0);
  const double T = options.time_constant_s;
  const auto [phi, settled] = sensor::settling_step({options.dt_s, T});
  // ∫ exp(−2s/T) ds over the step = T/2 (1 − φ²)
  return {phi, settled, options.bias_psd_m2ps5 * 0.5 * T * settled * (1.0 + phi)};
}

BiasStep random_walk_step(const RandomWalkOptions& options) {
  PM_EXPECTS(options.dt_s >= 0.0 && options.bias_psd_m2ps5 >= 0.0);
  return {1.0, 0.0, options.bias_psd_m2ps5 * options.dt_s};
}

BiasStep gauss_markov_step(const GaussMarkovOptions& options) {
  PM_EXPECTS(options.bias_std_mps2 >= 0.0 && options.time_constant_s > 0.0);
  const double variance = options.bias_std_mps2 * options.bias_std_mps2;
  return bias_step(
      {options.dt_s, options.time_constant_s, 2.0 * variance / options.time_constant_s});
}

Gaussian<1> bias_prior(const sensor::WarmUp& warm_up, double since_switch_on_s) {
  const Uncertain bias = sensor::bias_at(warm_up, since_switch_on_s);
  Gaussian<1> prior;
  prior.mean << bias.value;
  prior.cov << bias.std * bias.std;
  return prior;
}

LinearModel<1, 1, 1> bias_model(const RestOptions& options) {
  const BiasStep step = bias_step(options.bias);
  LinearModel<1, 1, 1> model;
  model.F << step.phi;
  model.Q << step.variance_m2ps4;
  model.H << 1.0;
  model.R << options.accel_variance_m2ps4;
  model.B << step.settled;
  return model;
}

template LinearRun<1, 1> filter_linear(LinearSeries<1, 1, 1>,
                                       const Start<1>&,
                                       const LinearOptions&);
template LinearRun<1, 1> smooth_linear(LinearSeries<1, 1, 1>,
                                       const Start<1>&,
                                       const LinearOptions&);

}  // namespace proofmass::estimate
