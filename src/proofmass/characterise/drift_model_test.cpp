#include "proofmass/characterise/drift_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <optional>
#include <string_view>

#include "proofmass/characterise/drift/drift_test_support.hpp"
#include "proofmass/characterise/drift/state.hpp"

namespace proofmass::characterise::drift_model_test {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::Series;

DriftCurve curve_of(DriftShape shape) {
  DriftCurve curve;
  curve.shape = shape;
  curve.a2 = 1.5;
  curve.a1 = 5.0;
  curve.time_constant_s = 900.0;
  curve.second_a1 = -2.0;
  curve.second_time_constant_s = 60.0;
  curve.slope_per_s = 1e-3;
  if (shape == DriftShape::steps) curve.steps = {{100.0, {2.0, 0.1}}, {700.0, {-3.0, 0.1}}};
  return curve;
}

/// Changes the j-th parameter of the covariance.
void move(DriftCurve& curve, Index j, double by) {
  const bool line = curve.shape == DriftShape::line;
  const bool steps = curve.shape == DriftShape::steps;
  const bool both = curve.shape == DriftShape::exponential_and_line;
  if (j == 0) curve.a2 += by;
  if (steps && j > 0) curve.steps[static_cast<std::size_t>(j - 1)].size.value += by;
  if ((line && j == 1) || (both && j == 3)) curve.slope_per_s += by;
  if (line || steps) return;
  if (j == 1) curve.a1 += by;
  if (j == 2) curve.time_constant_s *= std::exp(by);
  if (both) return;
  if (j == 3) curve.second_a1 += by;
  if (j == 4) curve.second_time_constant_s *= std::exp(by);
}

constexpr std::array<DriftShape, 6> all_shapes{DriftShape::constant,
                                               DriftShape::line,
                                               DriftShape::steps,
                                               DriftShape::exponential,
                                               DriftShape::exponential_and_line,
                                               DriftShape::two_exponentials};

TEST(DriftCurve, HasANameForEachShape) {
  const std::array<std::string_view, 6> names{
      "constant", "line", "steps", "exponential", "exponential_and_line", "two_exponentials"};
  for (std::size_t k = 0; k < all_shapes.size(); ++k) EXPECT_EQ(name_of(all_shapes[k]), names[k]);
}

TEST(DriftCurve, IsTheSumOfItsParts) {
  constexpr double t_s = 600.0;
  const double first = 5.0 * (1.0 - std::exp(-600.0 / 900.0));
  const double second = -2.0 * (1.0 - std::exp(-10.0));
  const std::array<double, 6> values{1.5, 2.1, 3.5, 1.5 + first, 2.1 + first, 1.5 + first + second};
  for (std::size_t k = 0; k < all_shapes.size(); ++k)
    EXPECT_NEAR(curve_of(all_shapes[k]).value(t_s), values[k], 1e-12) << name_of(all_shapes[k]);
}

TEST(DriftCurve, TakesAStepAtItsTime) {
  const DriftCurve curve = curve_of(DriftShape::steps);
  EXPECT_EQ(curve.value(std::nextafter(100.0, 0.0)), 1.5);
  EXPECT_EQ(curve.value(100.0), 3.5);
  EXPECT_EQ(curve.value(700.0), 0.5);
}

TEST(DriftCurve, HasTheGradientOfItsDifferences) {
  constexpr double by = 1e-6;
  for (const DriftShape shape : all_shapes)
    for (const double t_s : {0.0, 30.0, 600.0, 1e5}) {
      const VectorXd gradient = curve_of(shape).gradient(t_s);
      for (Index j = 0; j < gradient.size(); ++j) {
        DriftCurve up = curve_of(shape), down = up;
        move(up, j, by);
        move(down, j, -by);
        const double difference = (up.value(t_s) - down.value(t_s)) / (2.0 * by);
        EXPECT_NEAR(gradient(j), difference, 1e-6 * std::max(1.0, std::abs(gradient(j))))
            << name_of(shape) << " at " << t_s << " s, entry " << j;
      }
    }
}

TEST(DriftCurve, CarriesItsCovarianceThrough) {
  DriftCurve curve = curve_of(DriftShape::line);
  curve.covariance = (MatrixXd(2, 2) << 4.0, -1.0, -1.0, 0.5).finished();
  // 4 − 2 t + ½ t².
  EXPECT_DOUBLE_EQ(curve.std(0.0), 2.0);
  EXPECT_NEAR(curve.std(2.0), std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(curve.std(10.0), std::sqrt(34.0), 1e-12);
}

TEST(DriftNoise, OfAMarkovTermHasItsStandardDeviation) {
  EXPECT_DOUBLE_EQ((DriftNoise{.markov = 0.5, .markov_time_constant_s = 32.0}).markov_std(), 2.0);
}

/// A warm-up with known parameters; only the drift is uncertain.
DriftFit known(const DriftNoise& noise, const Eigen::Vector3d& slow_noise) {
  DriftFit fit;
  fit.curve = curve_of(DriftShape::exponential);
  fit.curve.covariance = MatrixXd::Zero(3, 3);
  fit.noise = noise;
  fit.identified = true;
  fit.end = {3600.0, slow_noise, MatrixXd::Zero(6, 6)};
  fit.block_s = 4.0;
  return fit;
}

TEST(DriftForecast, RefusesAWarmUpThatIsNotIdentified) {
  DriftFit fit = known({}, Eigen::Vector3d::Zero());
  fit.identified = false;
  fit.reason = "steps instead of an exponential";
  const auto found = forecast(fit, 4000.0);
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, Errc::not_observable);
  EXPECT_EQ(found.error().message, fit.reason);
}

TEST(DriftForecast, RefusesPastAndNonFiniteTimes) {
  const DriftFit fit = known({}, Eigen::Vector3d::Zero());
  for (const double t_s : {3599.0, -1.0, std::numeric_limits<double>::quiet_NaN(),
                           std::numeric_limits<double>::infinity()}) {
    const auto found = forecast(fit, t_s);
    ASSERT_FALSE(found);
    EXPECT_EQ(found.error().code, Errc::invalid_argument);
  }
  EXPECT_TRUE(forecast(fit, 3600.0));
}

TEST(DriftForecast, AtTheEndIsTheStateAndNoChange) {
  DriftFit fit = known({.random_walk = 0.1}, {0.3, 0.0, 0.0});
  fit.end.covariance.diagonal() << 0.04, 0.01, 0.0, 0.09, 0.0, 0.0;
  const DriftForecast now = forecast(fit, 3600.0).value();
  EXPECT_NEAR(now.bias.value, fit.curve.value(3600.0) + 0.3, 1e-12);
  const double rise = 1.0 - std::exp(-4.0);
  EXPECT_NEAR(now.bias.std, std::sqrt(0.04 + 0.01 * rise * rise + 0.09), 1e-12);
  EXPECT_NEAR(*now.bias.upper_95 - *now.bias.lower_95, 2.0 * 1.959964 * now.bias.std, 1e-6);
  EXPECT_EQ(now.change.value, 0.0);
  EXPECT_EQ(now.change.std, 0.0);
}

TEST(DriftForecast, WidensWithTheRootOfTheTimeAheadInARandomWalk) {
  const DriftFit fit = known({.random_walk = 0.1}, {0.3, 0.0, 0.0});
  for (const double ahead_s : {1.0, 100.0, 10000.0}) {
    const DriftForecast found = forecast(fit, 3600.0 + ahead_s).value();
    EXPECT_NEAR(found.bias.std, 0.1 * std::sqrt(ahead_s), 1e-12);
    EXPECT_NEAR(found.change.std, found.bias.std, 1e-12);
    EXPECT_NEAR(found.bias.value - found.change.value, fit.curve.value(3600.0) + 0.3, 1e-12);
  }
}

TEST(DriftForecast, LetsMarkovNoiseRelaxToItsMean) {
  DriftFit fit = known({.markov = 0.5, .markov_time_constant_s = 32.0}, {0.0, 0.0, 3.0});
  const DriftForecast soon = forecast(fit, 3600.0 + 32.0).value();
  EXPECT_NEAR(soon.bias.value, fit.curve.value(3632.0) + 3.0 * std::exp(-1.0), 1e-12);
  EXPECT_NEAR(soon.bias.std, 2.0 * std::sqrt(1.0 - std::exp(-2.0)), 1e-12);
  const DriftForecast late = forecast(fit, 36000.0).value();
  EXPECT_NEAR(late.bias.value, 6.5, 1e-12);
  EXPECT_NEAR(late.bias.std, 2.0, 1e-12);
  EXPECT_NEAR(late.change.value, 5.0 * std::exp(-4.0) - 3.0, 1e-12);
}

TEST(DriftForecast, IncludesTheCorrelationOfCurveAndSlowNoise) {
  DriftFit fit = known({}, {0.3, 0.0, 0.0});
  fit.end.covariance(0, 0) = fit.end.covariance(3, 3) = 1.0;
  fit.end.covariance(0, 3) = fit.end.covariance(3, 0) = -0.99;
  EXPECT_NEAR(forecast(fit, 5000.0).value().bias.std, std::sqrt(0.02), 1e-12);
}

/// The exponential of a record with known noise; its time constant by Gauss–Newton steps.
class KnownNoise {
 public:
  KnownNoise(const DriftEvidence& evidence, const Eigen::Vector2d& strength, double start_time_s)
      : evidence_(evidence), z_(evidence.ordinates().tail(evidence.blocks() - 1)) {
    trial_.noise = NoiseChoice(evidence).base();
    trial_.at = {DriftShape::exponential, {std::log(start_time_s)}, {}};
    for (int step = 0; step < 3; ++step) {
      const OrdinateMeans both{tangent_columns(evidence, trial_.at), {}};
      const VectorXd b = evaluate_ordinates(z_, trial_.noise.P, both, strength).coefficients;
      trial_.at.log_times[0] += b(1) / b(0);
    }
    trial_.fit =
        evaluate_ordinates(z_, trial_.noise.P, {linear_columns(evidence, trial_.at), {}}, strength);
  }

  [[nodiscard]] DriftFit fit() const {
    DriftFit fit;
    PlacedCurve placed = place(evidence_, trial_);
    fit.curve = std::move(placed.curve);
    fit.end = std::move(placed.end);
    fit.noise = noise_of(trial_);
    fit.block_s = evidence_.block_s();
    fit.identified = true;
    return fit;
  }

 private:
  const DriftEvidence& evidence_;
  VectorXd z_;
  DriftFitAtShape trial_;
};

bool holds(const Interval95& interval, double truth) {
  return *interval.lower_95 <= truth && truth <= *interval.upper_95;
}

// Each record continues after its end with its own random walk; its noise is known, its curve is
// not.
TEST(DriftForecast, HoldsNinetyFivePercentOfTwoThousandContinuations) {
  constexpr int records = 2000;
  constexpr std::size_t n = 64, ahead = 40;
  constexpr double h = 4.0, N = 1.0, K = 0.05, T = 40.0, a1 = 30.0, a2 = 1.0;
  int bias_held = 0, change_held = 0;
  const Series curve = test::sum_of({test::warm_up(a1, T, 1.0 / h, n), test::level(a2, n)});
  const double end_s = h * static_cast<double>(n), then_s = end_s + h * static_cast<double>(ahead);
  const auto truth = [&](double t_s) { return a2 - a1 * std::expm1(-t_s / T); };
  for (unsigned record = 0; record < records; ++record) {
    // Steps of half a block, so that power-on, samples and the end all coincide with points of the
    // walk.
    const Series walk = test::random_walk(K, 2.0 / h, 2 * (n + ahead), 2 * record);
    Series samples = test::sum_of({curve, test::white(N, 1.0 / h, n, 2 * record + 1)});
    for (std::size_t k = 0; k < n; ++k) samples[k] += walk[2 * k];
    const DriftEvidence evidence = test::evidence_of(samples, {1.0 / h, 1});
    const KnownNoise known_noise(evidence, {N * N, K * K}, T);
    const DriftForecast found = forecast(known_noise.fit(), then_s).value();
    const double bias = truth(then_s) + walk[2 * (n + ahead) - 1];
    bias_held += holds(found.bias, bias) ? 1 : 0;
    change_held += holds(found.change, bias - truth(end_s) - walk[2 * n - 1]) ? 1 : 0;
  }
  EXPECT_GE(bias_held, 0.93 * records);
  EXPECT_LE(bias_held, 0.97 * records);
  EXPECT_GE(change_held, 0.93 * records);
  EXPECT_LE(change_held, 0.97 * records);
}

/// Coverage of the band for flicker noise a given number of blocks after the end, with known noise.
double share_of_flicker_held(std::size_t ahead) {
  constexpr unsigned records = 150;
  constexpr std::size_t n = 128;
  constexpr double h = 4.0, white = 0.5, B = 1.0;
  int held = 0;
  for (unsigned record = 0; record < records; ++record) {
    const Series flicker = test::flicker(B, n + ahead, 2 * record);
    Series samples = test::white(white, 1.0 / h, n, 2 * record + 1);
    for (std::size_t k = 0; k < n; ++k) samples[k] += flicker[k];
    const DriftEvidence evidence = test::evidence_of(samples, {1.0 / h, 1});
    DriftFitAtShape trial;
    trial.noise = NoiseChoice(evidence).white();
    const Index rows = evidence.blocks() - 1;
    trial.noise.P.conservativeResize(rows, 2);
    for (Index k = 0; k < rows; ++k)
      trial.noise.P(k, 1) =
          term_density(Term::flicker, evidence.frequency_hz(k + 1), evidence.sampling());
    trial.noise.terms.push_back(Term::flicker);
    trial.fit = evaluate_ordinates(evidence.ordinates().tail(rows), trial.noise.P, {},
                                   Eigen::Vector2d(white * white, B * B));
    DriftFit fit;
    PlacedCurve placed = place(evidence, trial);
    fit.curve = std::move(placed.curve);
    fit.end = std::move(placed.end);
    fit.noise = noise_of(trial);
    fit.block_s = h;
    fit.identified = true;
    const double then_s = evidence.end_s() + h * (static_cast<double>(ahead) - 0.5);
    held += holds(forecast(fit, then_s).value().bias, flicker.back()) ? 1 : 0;
  }
  return static_cast<double>(held) / records;
}

// The scatter of 5 % of 150 is 1.8 %.
TEST(DriftForecast, HoldsFlickerThatGoesOn) {
  for (const std::size_t ahead : {8UL, 64UL}) {
    const double share = share_of_flicker_held(ahead);
    EXPECT_GE(share, 0.91) << ahead;
    EXPECT_LE(share, 0.99) << ahead;
  }
}

TEST(PositionError, IsHalfTheBiasTimesTheTimeSquared) {
  const Interval95 position = position_error({2.0, 0.5, 1.0, std::nullopt}, 10.0);
  EXPECT_DOUBLE_EQ(position.value, 100.0);
  EXPECT_DOUBLE_EQ(position.std, 25.0);
  EXPECT_DOUBLE_EQ(*position.lower_95, 50.0);
  EXPECT_FALSE(position.upper_95);
}

}  // namespace
}  // namespace proofmass::characterise::drift_model_test
