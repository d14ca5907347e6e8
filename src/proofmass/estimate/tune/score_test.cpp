#include "proofmass/estimate/tune/score.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

#include "proofmass/core/random.hpp"

namespace proofmass::estimate::tune_score_test {
namespace {

constexpr double missing = std::numeric_limits<double>::quiet_NaN();

std::vector<double> walk(std::size_t samples) {
  Random random(1, "tune score");
  std::vector<double> values;
  double level = 3.0;
  for (std::size_t k = 0; k < samples; ++k) {
    level += 0.1 * random.normal();
    const bool gone = k < 2 || k % 17 == 3 || (k > 100 && k < 120);
    values.push_back(gone ? missing : level + random.normal());
  }
  return values;
}

std::vector<double> some_values(TuneModel model) {
  std::vector<double> values;
  for (const TuneParameter& parameter : parameters_of(model)) {
    switch (parameter.role) {
      case TuneRole::reading:
        values.push_back(0.9);
        break;
      case TuneRole::process:
        values.push_back(0.05);
        break;
      case TuneRole::markov_std:
        values.push_back(0.4);
        break;
      case TuneRole::time_constant:
        values.push_back(3.0);
        break;
    }
  }
  return values;
}

// Results of the package KFAS for a local level with an exact diffuse start.
TEST(LogLikelihood, OfALocalLevelIsThatOfAnIndependentPackage) {
  const std::vector<double> series{10.2394, 1, 1, 1, 1, 1, 1, 1, 1, 1};
  const TuneSystem system =
      system_of(TuneModel::local_level, std::vector<double>{1.993, 8.253}, 1.0);
  EXPECT_NEAR(log_likelihood(system, series).log_likelihood, -23.0163218509366, 1e-12);
}

class EveryModel : public testing::TestWithParam<TuneModel> {};

TEST_P(EveryModel, HasTheGradientThatDifferencesHave) {
  const std::vector<double> series = walk(300), values = some_values(GetParam());
  const TuneScore score = likelihood_score(system_of(GetParam(), values, 0.5), series);
  EXPECT_EQ(score.log_likelihood,
            log_likelihood(system_of(GetParam(), values, 0.5), series).log_likelihood);
  constexpr double step = 1e-5;
  for (std::size_t j = 0; j < values.size(); ++j) {
    const auto moved = [&](double by) {
      std::vector<double> other = values;
      other[j] *= std::exp(by);
      return log_likelihood(system_of(GetParam(), other, 0.5), series).log_likelihood;
    };
    const double difference = (moved(step) - moved(-step)) / (2.0 * step);
    EXPECT_NEAR(score.by_log[j], difference, 1e-6 * (1.0 + std::abs(difference)))
        << parameters_of(GetParam())[j].name;
  }
}

// Q(2h) = F Q Fᵀ + Q, and the corresponding relation if every other measurement is omitted.
TEST_P(EveryModel, TwoShortStepsAreALongOne) {
  const TuneSystem once = system_of(GetParam(), some_values(GetParam()), 0.2);
  const TuneSystem twice = system_of(GetParam(), some_values(GetParam()), 0.4);
  const TuneMatrix F = once.F * once.F, Q = once.F * once.Q * once.F.transpose() + once.Q;
  EXPECT_LT((twice.F - F).norm(), 1e-14);
  EXPECT_LT((twice.Q - Q).norm(), 1e-14);
}

TEST_P(EveryModel, IsUnaffectedByAMissingMeasurement) {
  const std::vector<double> series = walk(50);
  std::vector<double> longer{missing, missing, missing};
  longer.insert(longer.end(), series.begin(), series.end());
  longer.push_back(missing);
  const TuneSystem system = system_of(GetParam(), some_values(GetParam()), 0.5);
  EXPECT_DOUBLE_EQ(log_likelihood(system, series).log_likelihood,
                   log_likelihood(system, longer).log_likelihood);
}

INSTANTIATE_TEST_SUITE_P(Models, EveryModel, testing::ValuesIn(all_tune_models));

TEST(LikelihoodScore, StaysFiniteWhereANoiseVanishes) {
  const TuneSystem system = system_of(TuneModel::local_level, std::vector<double>{1.0, 0.0}, 1.0);
  const TuneScore score = likelihood_score(system, walk(200));
  EXPECT_TRUE(std::isfinite(score.log_likelihood));
  EXPECT_EQ(score.by_log[1], 0.0);
}

TEST(LikelihoodScore, IsMinusInfinityWithoutAnyNoise) {
  const TuneSystem system = system_of(TuneModel::local_level, std::vector<double>{0.0, 0.0}, 1.0);
  EXPECT_EQ(log_likelihood(system, walk(10)).log_likelihood,
            -std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace proofmass::estimate::tune_score_test
