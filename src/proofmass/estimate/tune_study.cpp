#include "proofmass/estimate/tune_study.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace proofmass::estimate {
namespace {

// The spectral density that drives the acceleration, of a parameter given as its root or as itself.
double driving_density(const Tuning& tuning, std::size_t k) {
  constexpr std::size_t driving = 1;
  const double value = tuning.series[k].values[driving];
  return parameters_of(tuning.model)[driving].variance_power() == 2 ? value * value : value;
}

}  // namespace

std::optional<TuneStudy> tune_study(const Tuning& tuning, std::size_t k, double step_s) {
  if (tuning.model != TuneModel::rest && tuning.model != TuneModel::pva) return std::nullopt;
  const TunedSeries& series = tuning.series[k];
  const double q = driving_density(tuning, k), R = series.system.R;
  if (!(q > 0.0 && R > 0.0)) return std::nullopt;
  const double own_step_s = step_s > 0.0 ? step_s : 1.0 / series.rate_hz;
  // The slowest case has a quarter of the gain's rate, hence ten times four.
  const double settle_s = own_step_s / std::min(1.0, std::sqrt(q * own_step_s / R));
  const GainStudyOptions options{.jerk_psd_m2ps5 = q,
                                 .accel_variance_m2ps4 = R,
                                 .step_s = own_step_s,
                                 .duration_s = std::min(40.0 * settle_s, 2e5 * own_step_s),
                                 .prior_variance = 100.0};
  TuneStudy study{.channel = series.name, .cases = {}, .steps = {}};
  constexpr double larger = 4.0;
  for (const auto& [Q_factor, R_factor] :
       {std::array{1.0, 1.0}, std::array{larger, 1.0}, std::array{1.0, larger}}) {
    GainStudyOptions own = options;
    own.jerk_psd_m2ps5 *= Q_factor;
    own.accel_variance_m2ps4 *= R_factor;
    study.cases.push_back({Q_factor, R_factor, gain_study(own)});
  }
  std::vector<double> steps_s;
  for (const double factor : {1.0, 2.0, 5.0, 10.0, 20.0, 50.0})
    steps_s.push_back(factor * own_step_s);
  study.steps = step_size_study(options, steps_s);
  return study;
}

}  // namespace proofmass::estimate
