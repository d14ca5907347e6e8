// Noise of a filter's model from the recording itself: an acceleration driven by a motor, measured
// with noise; Q and R by maximum likelihood with their errors, and the settling time of the gain.
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

#include "proofmass/estimate/gain_study.hpp"
#include "proofmass/estimate/tune.hpp"

namespace pm = proofmass;

int main() {
  // White jerk of density 0.5 m²/s⁵, sampled at 100 Hz with a standard deviation of 0.2 m/s².
  constexpr double rate_hz = 100.0, jerk_psd = 0.5, accel_std = 0.2;
  std::mt19937_64 bits(1);
  std::normal_distribution<double> normal;
  std::vector<double> readings;
  double accel_mps2 = 0.0;
  for (int k = 0; k < 6000; ++k) {
    readings.push_back(accel_mps2 + accel_std * normal(bits));
    accel_mps2 += std::sqrt(jerk_psd / rate_hz) * normal(bits);
  }

  const auto tuning =
      pm::estimate::tune({{.name = "x", .rate_hz = rate_hz, .segments = {readings}}},
                         {.model = pm::estimate::TuneModel::pva})
          .value();
  bool right = true;
  for (const auto& parameter : tuning.parameters) {
    if (!parameter.value) return 1;
    const double truth = parameter.name == "jerk_psd" ? jerk_psd : accel_std * accel_std;
    std::printf("%-15s %8.5f +- %.5f  (95 %%: %.5f to %.5f; truth %.5f)\n", parameter.name.c_str(),
                parameter.value->value, parameter.value->std, *parameter.lower_95,
                *parameter.upper_95, truth);
    right = right && std::abs(parameter.value->value - truth) < 4.0 * parameter.value->std;
  }
  std::printf("log-likelihood %.3f: %.3f at the start, %.3f after EM\n", tuning.log_likelihood,
              tuning.em_log_likelihood.front(), tuning.em_log_likelihood.back());

  const auto consistency = pm::estimate::consistency_of(tuning);
  std::printf("mean NIS %.3f, expected %.3f to %.3f\n", consistency.nis, consistency.nis_lower,
              consistency.nis_upper);

  const auto study =
      pm::estimate::gain_study({.jerk_psd_m2ps5 = tuning.parameters[1].value->value,
                                .accel_variance_m2ps4 = tuning.parameters[0].value->value,
                                .step_s = 1.0 / rate_hz,
                                .duration_s = 20.0});
  std::printf("gain of the acceleration %.4f, settled after %.2f s\n", study.limit[2],
              study.settling_s[2].value_or(-1.0));
  return right && study.settling_s[2] ? 0 : 1;
}
