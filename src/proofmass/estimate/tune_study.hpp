#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/estimate/gain_study.hpp"
#include "proofmass/estimate/tune.hpp"

// Gain and covariance of the filter that a tuning determines.
namespace proofmass::estimate {

/// The filter with Q and R multiplied by these factors.
struct GainCase {
  double Q_factor = 1.0, R_factor = 1.0;
  GainStudy study;
};

struct TuneStudy {
  std::string channel;
  std::vector<GainCase> cases;        ///< as tuned, Q four times, R four times
  std::vector<StepSizeEffect> steps;  ///< 1 to 50 times the first step
};

/// Gain against time for the noise of one series (k) of a tuning, and the effect of the step. Each
/// case lasts ten settling times of the slowest one, at most 2e5 steps. Absent unless the model has
/// two white noises, that of a measurement and that which drives the acceleration (rest, pva), and
/// both are above zero. `step_s` 0: that of the series. Cost: O(duration / step).
[[nodiscard]] std::optional<TuneStudy> tune_study(const Tuning& tuning,
                                                  std::size_t k,
                                                  double step_s = 0.0);

}  // namespace proofmass::estimate
