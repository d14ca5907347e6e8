// A drifting level, measured with noise and with missing measurements, without prior knowledge:
// filtered, smoothed and tested by its likelihood from an exactly diffuse start. The measurements
// determine the start; no large variance replaces "unknown".
//
// A trend is the same with two states, F = (1 dt; 0 1), H = (1 0), and Start<2>::diffuse(): two
// measurements determine it, wherever they are. A state with a prior keeps it:
// Start<2>::diffuse({1}, known) makes only the slope diffuse.
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <limits>
#include <vector>

#include "proofmass/estimate/filter/linear_gaussian.hpp"

namespace pm = proofmass::estimate;

int main() {
  constexpr double missing = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> readings{missing, 10.2, 9.1, missing, missing, 7.4, 7.9, 6.2, missing};
  std::vector<pm::Epoch<1>> epochs;
  for (const double z : readings) epochs.push_back({.dt_s = 1.0, .z = pm::Mat<1>(z)});

  // x[k] = x[k−1] + w, z[k] = x[k] + v.
  const auto model_at = [](double dt_s) {
    pm::LinearModel<1, 1> model;
    model.F << 1.0;
    model.Q << 0.8 * dt_s;
    model.H << 1.0;
    model.R << 0.5;
    return model;
  };
  const auto series = pm::LinearSeries<1, 1>::make(epochs, model_at);
  if (!series) {
    std::fprintf(stderr, "%s\n", series.error().message.c_str());
    return 1;
  }
  const auto run = pm::smooth_linear(*series, pm::Start<1>::diffuse(), {.lag_one = true});

  for (std::size_t k = 0; k < run.steps.size(); ++k) {
    const auto& step = run.steps[k];
    if (step.filtered.determined(0))
      std::printf("epoch %zu: so far %7.4f ± %.4f", k, step.filtered.mean(0),
                  std::sqrt(step.filtered.cov(0, 0)));
    else
      std::printf("epoch %zu: so far nothing known  ", k);
    std::printf(", given all readings %7.4f ± %.4f\n", step.smoothed.mean(0),
                std::sqrt(step.smoothed.cov(0, 0)));
  }
  std::printf("correlation of the first two levels %.4f\n",
              run.lag_one[0](0, 0) /
                  std::sqrt(run.steps[0].smoothed.cov(0, 0) * run.steps[1].smoothed.cov(0, 0)));
  std::printf("log-likelihood %.6f, %zu of %zu readings spent on the start\n", run.log_likelihood,
              run.diffuse_readings, run.readings + run.diffuse_readings);
  return run.steps.back().smoothed.determined(0) ? 0 : 1;
}
