#pragma once

#include "proofmass/core/random.hpp"
#include "proofmass/report/tune/report.hpp"

// A tuning of synthetic data, for the tests of this module.
namespace proofmass::report {

/// White noise of 0.05 m/s² on a level with a random walk of `step_std` per sample.
inline TuneReport fake_tuned(double step_std) {
  Random random(1, "tune report");
  std::vector<double> values;
  double level = 9.8;
  for (int k = 0; k < 2000; ++k) {
    values.push_back(level + 0.05 * random.normal());
    level += step_std * random.normal();
  }
  TuneReport report;
  report.inputs = {"rest.csv"};
  report.tuning =
      estimate::tune({{"x", 100.0, {values}}}, {.model = estimate::TuneModel::rest}).value();
  report.channels = {{"x", *parse_unit("m/s^2"), 1}};
  report.consistency = estimate::consistency_of(report.tuning);
  estimate::TuneStudy study{"x", {{.study = estimate::gain_study({})}}, {}};
  const std::vector<double> steps{0.1, 1.0};
  study.steps = estimate::step_size_study({}, steps);
  report.studies.push_back(std::move(study));
  return report;
}

}  // namespace proofmass::report
