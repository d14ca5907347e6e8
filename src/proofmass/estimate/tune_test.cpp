#include "proofmass/estimate/tune.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

#include "proofmass/core/random.hpp"
#include "proofmass/estimate/tune/problem.hpp"

namespace proofmass::estimate::tune_test {
namespace {

struct Level {
  std::size_t samples;
  double reading_std = 1.0, step_std = 0.0;
  std::uint64_t seed = 1;
};

std::vector<double> simulated(const Level& level, double start = 0.0) {
  Random random(level.seed, "tuned level");
  std::vector<double> values;
  double at = start;
  for (std::size_t k = 0; k < level.samples; ++k) {
    values.push_back(at + level.reading_std * random.normal());
    at += level.step_std * random.normal();
  }
  return values;
}

const TunedParameter& find(const Tuning& tuning, const std::string& name) {
  for (const TunedParameter& parameter : tuning.parameters) {
    if (parameter.name == name) return parameter;
  }
  static const TunedParameter none;
  ADD_FAILURE() << name;
  return none;
}

Result<Tuning> tuned(const std::vector<double>& values,
                     const TuneOptions& options,
                     double rate_hz = 1.0) {
  return tune({{.name = "x", .rate_hz = rate_hz, .segments = {values}}}, options);
}

// Annual flow of the Nile at Aswan, 1871 to 1970. Source: G. W. Cobb, Biometrika 65 (1978) 243;
// J. Durbin, S. J. Koopman, Time Series Analysis by State Space Methods (2012), section 2.10.3.
const std::vector<double> nile{
    1120, 1160, 963, 1210, 1160, 1160, 813,  1230, 1370, 1140, 995,  935,  1110, 994,  1020,
    960,  1180, 799, 958,  1140, 1100, 1210, 1150, 1250, 1260, 1220, 1030, 1100, 774,  840,
    874,  694,  940, 833,  701,  916,  692,  1020, 1050, 969,  831,  726,  456,  824,  702,
    1120, 1100, 832, 764,  821,  768,  845,  864,  862,  698,  845,  744,  796,  1040, 759,
    781,  865,  845, 944,  984,  897,  822,  1010, 771,  676,  649,  846,  812,  742,  801,
    1040, 860,  874, 848,  890,  744,  749,  838,  1050, 918,  986,  797,  923,  975,  815,
    1020, 906,  901, 1170, 912,  746,  919,  718,  714,  740};

TEST(Tune, FindsThePublishedVariancesOfTheNile) {
  const Tuning found = tuned(nile, {.model = TuneModel::local_level}).value();
  EXPECT_NEAR(find(found, "reading_variance").value->value, 15098.5, 1.0);
  EXPECT_NEAR(find(found, "level_psd").value->value, 1469.1, 0.2);
  EXPECT_NEAR(found.log_likelihood, -632.5456, 1e-4);
  EXPECT_TRUE(found.converged);
  EXPECT_LT(found.gradient, 1e-6);
}

TEST(Tune, EstimatesLieWithinTheirStandardDeviations) {
  const auto values = simulated({.samples = 20'000, .reading_std = 0.05, .step_std = 0.002}, 9.8);
  const Tuning found = tuned(values, {.model = TuneModel::rest}, 100.0).value();
  const Uncertain white = *find(found, "white").value, walk = *find(found, "random_walk").value;
  EXPECT_NEAR(white.value, 0.005, 3.0 * white.std);
  EXPECT_NEAR(walk.value, 0.02, 3.0 * walk.std);
  EXPECT_LT(white.std, 0.01 * white.value);
  EXPECT_LT(walk.std, 0.1 * walk.value);
  // For white noise alone the relative std of a standard deviation is 1/√(2N).
  EXPECT_NEAR(white.std / white.value, 1.0 / std::sqrt(2.0 * 20'000), 2e-3);
}

TEST(Tune, ExpectationMaximisationNeverLosesAndMaximumLikelihoodGainsMore) {
  const auto values = simulated({.samples = 2000, .step_std = 0.1});
  TuneOptions options{.model = TuneModel::local_level,
                      .start = {{"reading_variance", 3.0}, {"level_psd", 1.0}},
                      .em_steps = 60};
  const Tuning found = tuned(values, options).value();
  ASSERT_EQ(found.em_log_likelihood.size(), 61U);
  for (std::size_t k = 1; k < found.em_log_likelihood.size(); ++k)
    EXPECT_GE(found.em_log_likelihood[k], found.em_log_likelihood[k - 1]);
  EXPECT_GT(found.log_likelihood, found.em_log_likelihood.back());
  const TunedParameter& q = find(found, "level_psd");
  EXPECT_LT(std::abs(q.value->value - 0.01), std::abs(q.after_em - 0.01));
}

TEST(Tune, TheStandardDeviationIsThatOfTheCurvatureOfTheLikelihood) {
  const auto values = simulated({.samples = 5000, .step_std = 0.3});
  const Tuning found =
      tuned(values, {.model = TuneModel::local_level, .fixed = {{"reading_variance", 1.0}}})
          .value();
  const Uncertain q = *find(found, "level_psd").value;
  const auto at = [&](double log_step) {
    const std::vector<double> figures{1.0, q.value * std::exp(log_step)};
    return log_likelihood(system_of(TuneModel::local_level, figures, 1.0), values).log_likelihood;
  };
  constexpr double step = 1e-2;
  const double curvature = (2.0 * at(0.0) - at(step) - at(-step)) / (step * step);
  EXPECT_NEAR(q.std / q.value, 1.0 / std::sqrt(curvature), 1e-3 * q.std / q.value);
}

TEST(Tune, AWalkThatIsNotThereHasALimitAndNoValue) {
  const Tuning found =
      tuned(simulated({.samples = 4000}, 32768.0), {.model = TuneModel::rest}).value();
  const TunedParameter& walk = find(found, "random_walk");
  EXPECT_EQ(walk.verdict, TuneVerdict::not_observable);
  EXPECT_FALSE(walk.value.has_value());
  ASSERT_TRUE(walk.upper_95.has_value());
  EXPECT_GT(*walk.upper_95, 0.0);
  EXPECT_LT(*walk.upper_95, 0.02);
  EXPECT_FALSE(walk.reason.empty());
  EXPECT_NEAR(find(found, "white").value->value, 1.0, 0.05);
}

TEST(Tune, FindsAMarkovBiasWithItsTimeConstant) {
  Random random(5, "markov");
  constexpr double tau_s = 0.5, rate_hz = 50.0, sigma = 1.0;
  const double phi = std::exp(-1.0 / (tau_s * rate_hz));
  std::vector<double> values;
  double bias = sigma * random.normal();
  for (int k = 0; k < 6000; ++k) {
    values.push_back(bias + 0.5 * random.normal());
    bias = phi * bias + sigma * std::sqrt(1.0 - phi * phi) * random.normal();
  }
  const Tuning found = tuned(values, {.model = TuneModel::rest_markov}, rate_hz).value();
  const TunedParameter& tau = find(found, "markov_time_constant");
  ASSERT_TRUE(tau.value.has_value()) << tau.reason;
  EXPECT_NEAR(tau.value->value, tau_s, 3.0 * tau.value->std);
  EXPECT_NEAR(find(found, "markov_std").value->value, sigma, 0.25);
  EXPECT_FALSE(find(found, "random_walk").value.has_value());
}

TEST(Tune, WithoutAMarkovBiasThereIsNoTimeConstant) {
  const Tuning found =
      tuned(simulated({.samples = 3000, .step_std = 0.2}), {.model = TuneModel::pva_bias}).value();
  EXPECT_FALSE(find(found, "bias_std").value.has_value());
  EXPECT_FALSE(find(found, "bias_time_constant").value.has_value());
  EXPECT_NEAR(find(found, "jerk_psd").value->value, 0.04, 0.02);
}

TEST(Tune, AFixedParameterStaysAndTheOthersFollow) {
  const Tuning found =
      tuned(nile, {.model = TuneModel::local_level, .fixed = {{"level_psd", 0.0}}}).value();
  EXPECT_EQ(find(found, "level_psd").verdict, TuneVerdict::fixed);
  EXPECT_EQ(find(found, "level_psd").value->value, 0.0);
  double mean = 0.0, squares = 0.0;
  for (const double x : nile) mean += x / 100.0;
  for (const double x : nile) squares += (x - mean) * (x - mean);
  EXPECT_NEAR(find(found, "reading_variance").value->value, squares / 99.0, 1e-3);
}

TEST(Tune, ASharedParameterIsMorePreciseThanEachAlone) {
  const auto x = simulated({.samples = 3000, .step_std = 0.1, .seed = 1});
  const auto y = simulated({.samples = 3000, .reading_std = 2.0, .step_std = 0.1, .seed = 2});
  const std::vector<TuneSeries> both{{"x", 1.0, {x}}, {"y", 1.0, {y}}};
  const Tuning alone = tune(both, {.model = TuneModel::local_level}).value();
  const Tuning shared =
      tune(both, {.model = TuneModel::local_level, .shared = {"level_psd"}}).value();
  ASSERT_EQ(alone.parameters.size(), 4U);
  ASSERT_EQ(shared.parameters.size(), 3U);
  EXPECT_LT(find(shared, "level_psd").value->std, find(alone, "level_psd").value->std);
  EXPECT_LE(shared.log_likelihood, alone.log_likelihood + 1e-9);
}

TEST(Tune, SegmentsAreSeriesThatShareEverything) {
  const auto x = simulated({.samples = 500, .step_std = 0.3, .seed = 1});
  const auto y = simulated({.samples = 700, .step_std = 0.3, .seed = 2}, 1000.0);
  const Tuning together = tune({{"z", 1.0, {x, y}}}, {.model = TuneModel::local_level}).value();
  const Tuning shared =
      tune({{"x", 1.0, {x}}, {"y", 1.0, {y}}},
           {.model = TuneModel::local_level, .shared = {"level_psd", "reading_variance"}})
          .value();
  EXPECT_NEAR(together.log_likelihood, shared.log_likelihood, 1e-6);
  EXPECT_NEAR(find(together, "level_psd").value->value, find(shared, "level_psd").value->value,
              1e-6);
}

TEST(Tune, ItsFilterIsConsistent) {
  const auto values = simulated({.samples = 5000, .step_std = 0.2});
  const Consistency consistency =
      consistency_of(tuned(values, {.model = TuneModel::pva}, 10.0).value());
  EXPECT_EQ(consistency.verdict, Verdict::consistent);
  EXPECT_NEAR(consistency.nis, 1.0, 1e-3);
}

TEST(Tune, SaysWhyItCannot) {
  const std::vector<double> few(9, 1.0), same(50, 2.0);
  std::vector<double> endless = simulated({.samples = 50}), ramp;
  endless[7] = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 50; ++k) ramp.push_back(0.5 * k);
  EXPECT_EQ(tuned(few, {}).error().code, Errc::too_few_samples);
  EXPECT_EQ(tuned(same, {}).error().code, Errc::not_observable);
  EXPECT_EQ(tuned(ramp, {.model = TuneModel::local_trend}).error().code, Errc::not_observable);
  EXPECT_EQ(tuned(endless, {}).error().code, Errc::not_finite);
  EXPECT_EQ(tuned(nile, {.fixed = {{"jerk_psd", 1.0}}}).error().code, Errc::invalid_argument);
  EXPECT_EQ(tuned(nile, {.fixed = {{"white", -1.0}}}).error().code, Errc::invalid_argument);
  EXPECT_EQ(tuned(nile, {.shared = {"nothing"}}).error().code, Errc::invalid_argument);
  EXPECT_EQ(tune({}, {}).error().code, Errc::invalid_argument);
}

}  // namespace
}  // namespace proofmass::estimate::tune_test
