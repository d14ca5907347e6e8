#include "proofmass/characterise/temperature_model.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>

#include "proofmass/characterise/noise/noise_test_support.hpp"

namespace proofmass::characterise::temperature_model_test {
namespace {

using test::Series;

constexpr double missing = std::numeric_limits<double>::quiet_NaN();

/// Sinusoidal cycles between 290 and 310 K.
Series cycles(double count, std::size_t n) {
  Series T(n);
  for (std::size_t k = 0; k < n; ++k) {
    const double share = static_cast<double>(k) / static_cast<double>(n);
    T[k] = 300.0 - 10.0 * std::cos(2.0 * std::numbers::pi * count * share);
  }
  return T;
}

/// Linear change from one temperature to another.
Series sweep(double from_k, double to_k, std::size_t n) {
  Series T(n);
  for (std::size_t k = 0; k < n; ++k)
    T[k] = from_k + (to_k - from_k) * static_cast<double>(k) / static_cast<double>(n - 1);
  return T;
}

Series joined(const std::vector<Series>& parts) {
  Series all;
  for (const Series& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

double cubic(double T) {
  const double x = (T - 300.0) / 10.0;
  return 0.5 + 2.0 * x - 1.5 * x * x + 2.0 * x * x * x;
}

template <class Curve>
Series of(const Series& T, Curve curve) {
  Series y;
  for (const double temperature_k : T) y.push_back(curve(temperature_k));
  return y;
}

TemperatureModel fitted(const Series& y, const Series& T) {
  return fit_temperature(y, T, {.rate_hz = 1.0}).value();
}

Series without_mean(Series e) {
  double mean = 0.0;
  for (const double x : e) mean += x / static_cast<double>(e.size());
  for (double& x : e) x -= mean;
  return e;
}

TEST(TemperatureModel, RecoversACubicWithoutNoise) {
  const Series T = cycles(3.0, 6000);
  const TemperatureModel model = fitted(of(T, cubic), T);
  EXPECT_EQ(model.verdict, Verdict::identified) << model.reason;
  ASSERT_EQ(model.degree, 3);
  const double x = (model.reference_k - 300.0) / 10.0;  // the reference is not exactly at 300 K
  const double expected[] = {cubic(model.reference_k), (2.0 - 3.0 * x + 6.0 * x * x) / 10.0,
                             (-1.5 + 6.0 * x) / 100.0, 2.0 / 1000.0};
  for (std::size_t j = 0; j < 4; ++j)
    EXPECT_NEAR(model.coefficients[j].value, expected[j],
                1e-9 * std::max(std::abs(expected[j]), std::abs(expected[3])))
        << j;
  for (const double at : {290.1, 296.0, 300.0, 307.3})
    EXPECT_NEAR(model.at(at).value().value, cubic(at), 1e-10);
  EXPECT_NEAR(model.bias_span, cubic(model.highest_k) - cubic(model.lowest_k), 1e-9);
  EXPECT_LT(model.residual_std, 1e-10);
}

TEST(TemperatureModel, GivesOneCurveInPowersAndInOrthogonalPolynomials) {
  const Series T = cycles(3.0, 4096);
  const TemperatureModel model = fitted(test::sum_of({of(T, cubic), test::normals(4096, 1)}), T);
  ASSERT_GE(model.degree, 2);
  for (const double at : {291.0, 300.0, 309.0}) {
    double value = 0.0, variance = 0.0;
    for (std::size_t i = 0; i < model.coefficients.size(); ++i) {
      const double power = std::pow(at - model.reference_k, static_cast<double>(i));
      value += model.coefficients[i].value * power;
      for (std::size_t j = 0; j < model.coefficients.size(); ++j) {
        variance += power * std::pow(at - model.reference_k, static_cast<double>(j)) *
                    model.covariance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
      }
    }
    const Uncertain bias = model.at(at).value();
    EXPECT_NEAR(bias.value, value, 1e-9);
    EXPECT_NEAR(bias.std, std::sqrt(variance), 1e-6 * bias.std);
  }
}

TEST(TemperatureModel, ItsPolynomialsAreOrthogonalWhereTemperatureIsEven) {
  const Series T = sweep(290.0, 310.0, 4096);
  const TemperatureModel model = fitted(of(T, cubic), T);
  ASSERT_EQ(model.basis.alpha.size(), 5u);
  // Legendre's recurrence, monic: α = 0, β_j = j²/(4j² − 1).
  for (std::size_t j = 0; j < 5; ++j) {
    const auto square = static_cast<double>(j * j);
    EXPECT_NEAR(model.basis.alpha[j], 0.0, 1e-3);
    EXPECT_NEAR(model.basis.beta[j], square / (4.0 * square - (j > 0 ? 1.0 : -1.0)), 0.01) << j;
  }
}

TEST(TemperatureModel, NeverExtrapolates) {
  const Series T = cycles(2.0, 4096);
  const TemperatureModel model = fitted(of(T, cubic), T);
  EXPECT_TRUE(model.at(model.lowest_k));
  EXPECT_TRUE(model.at(model.highest_k));
  for (const double at : {model.lowest_k - 1e-6, model.highest_k + 1e-6, missing}) {
    const Result<Uncertain> bias = model.at(at);
    ASSERT_FALSE(bias) << at;
    EXPECT_EQ(bias.error().code, Errc::invalid_argument);
  }
  EXPECT_GE(model.lowest_k, 290.0);
  EXPECT_LE(model.highest_k, 310.0);
}

TEST(TemperatureModel, ChoosesTheDegreeInNineOfTenNoisyRecordings) {
  const Series T = cycles(2.5, 800);
  const Series curves[] = {of(T, [](double) { return 0.0; }),
                           of(T, [](double at) { return (at - 300.0) / 10.0; }), of(T, cubic)};
  const int degrees[] = {0, 1, 3};
  for (std::size_t which = 0; which < 3; ++which) {
    int right = 0;
    for (unsigned run = 0; run < 200; ++run)
      right += fitted(test::sum_of({curves[which], test::normals(800, 100 + run)}), T).degree ==
               degrees[which];
    EXPECT_GE(right, 180) << degrees[which];
  }
}

TEST(TemperatureModel, ItsIntervalsHoldForResidualsWithSlowNoise) {
  const Series T = joined({sweep(290.0, 310.0, 512), sweep(310.0, 290.0, 512)});
  const Series line = of(T, [](double at) { return 0.8 * (at - 300.0); });
  for (const double walk : {0.02, 0.05}) {
    double slope = 0.0, bias = 0.0, runs = 0.0;
    for (unsigned run = 0; run < 200; ++run) {
      const Series e = without_mean(test::sum_of(
          {test::normals(1024, 500 + run), test::random_walk(walk, 1.0, 1024, 9000 + run)}));
      const TemperatureModel model = fitted(test::sum_of({line, e}), T);
      if (model.degree < 1) continue;
      const Uncertain at = model.at(306.0).value();
      slope += std::abs(model.coefficients[1].value - 0.8) < 1.96 * model.coefficients[1].std;
      bias += std::abs(at.value - 0.8 * 6.0) < 1.96 * at.std;
      runs += 1.0;
    }
    EXPECT_GE(runs, 180.0) << walk;
    EXPECT_GE(slope / runs, 0.90) << walk;
    EXPECT_LE(slope / runs, 0.98) << walk;
    EXPECT_GE(bias / runs, 0.90) << walk;
    EXPECT_LE(bias / runs, 0.98) << walk;
  }
}

TEST(TemperatureModel, FindsHysteresis) {
  const Series T = joined({sweep(290.0, 310.0, 2000), sweep(310.0, 290.0, 2000)});
  Series y = test::sum_of({of(T, cubic), test::normals(4000, 3)});
  for (std::size_t k = 0; k < y.size(); ++k) y[k] += k < 2000 ? 0.4 : -0.4;
  const TemperatureModel model = fitted(y, T);
  ASSERT_TRUE(model.hysteresis);
  EXPECT_TRUE(model.hysteresis_significant);
  EXPECT_NEAR(model.hysteresis->value, 0.8, 3.0 * model.hysteresis->std);
  EXPECT_NEAR(model.at(303.0).value().value, cubic(303.0), 0.2) << "midway";
  EXPECT_TRUE(model.notes.empty());
}

TEST(TemperatureModel, FindsHysteresisWhereThereIsNoneInFewRecordings) {
  const Series T = cycles(2.5, 800);
  int found = 0;
  for (unsigned run = 0; run < 200; ++run) {
    const Series e = test::sum_of(
        {test::normals(800, 700 + run), test::random_walk(0.02, 1.0, 800, 5000 + run)});
    found += fitted(test::sum_of({of(T, cubic), e}), T).hysteresis_significant;
  }
  EXPECT_LE(found, 14) << "7 % of 200";
}

TEST(TemperatureModel, ReportsWhatOneSweepDoesNotDetermine) {
  const Series T = sweep(290.0, 310.0, 4096);
  const TemperatureModel rose = fitted(of(T, cubic), T);
  EXPECT_FALSE(rose.hysteresis);
  ASSERT_EQ(rose.notes.size(), 1u);
  EXPECT_NE(rose.notes[0].find("only rose"), std::string::npos) << rose.notes[0];
  const Series down = sweep(310.0, 290.0, 4096);
  const TemperatureModel fell = fitted(of(down, cubic), down);
  ASSERT_EQ(fell.notes.size(), 1u);
  EXPECT_NE(fell.notes[0].find("only fell"), std::string::npos) << fell.notes[0];
}

TEST(TemperatureModel, ADwellDoesNotOutvoteTheRamp) {
  Series T;
  for (int cycle = 0; cycle < 5; ++cycle)
    T = joined({T, sweep(290.0, 310.0, 200), Series(1200, 310.0), sweep(310.0, 290.0, 200)});
  const Series kink = of(T, [](double at) { return std::abs(at - 300.0); });
  const Series e = test::scaled(test::normals(T.size(), 4), 0.1);
  const TemperatureModel model =
      fit_temperature(test::sum_of({kink, e}), T, {.rate_hz = 1.0, .most_degree = 3}).value();
  // |x| over [−1, 1] is P0/2 + 5/8 P2 up to degree 3, which is 9/8 at its ends. If the dwells,
  // three quarters of the time, dominated, the curve would take the value 10 that holds there.
  EXPECT_NEAR(model.at(310.0).value().value, 11.25, 0.6);
}

TEST(TemperatureModel, RefusesASpanTooSmall) {
  const Series T = sweep(300.0, 301.5, 4096);
  const TemperatureModel model = fitted(of(T, [](double at) { return at; }), T);
  EXPECT_EQ(model.verdict, Verdict::not_observable);
  EXPECT_EQ(model.degree, 0);
  EXPECT_FALSE(model.slope_upper_95);
  EXPECT_NE(model.reason.find("spans 1.49 K; a curve needs 2 K"), std::string::npos)
      << model.reason;
}

TEST(TemperatureModel, RefusesAConstantTemperature) {
  const Series T(4096, 300.0);
  const TemperatureModel model =
      fit_temperature(test::normals(4096, 5), T, {.rate_hz = 1.0, .least_span_k = 0.0}).value();
  EXPECT_EQ(model.verdict, Verdict::not_observable);
  ASSERT_EQ(model.coefficients.size(), 1u);
  EXPECT_NEAR(model.at(300.0).value().value, 0.0, 0.05);
  EXPECT_TRUE(fit_temperature(Series(4096, 0.0), T, {.rate_hz = 1.0}));
}

TEST(TemperatureModel, SaysHowSmallASlopeThatItDoesNotFindMustBe) {
  const Series T = cycles(2.0, 4096);
  const TemperatureModel model = fitted(test::normals(4096, 6), T);
  EXPECT_EQ(model.verdict, Verdict::not_observable);
  ASSERT_TRUE(model.slope_upper_95);
  EXPECT_GT(*model.slope_upper_95, 1.645 / (64.0 * 7.07));
  EXPECT_LT(*model.slope_upper_95, 10.0 / (64.0 * 7.07));
  EXPECT_NE(model.reason.find("beyond its scatter"), std::string::npos) << model.reason;
}

TEST(TemperatureModel, PassesOverMissingSamples) {
  Series T = cycles(3.0, 6000), y = of(T, cubic);
  for (std::size_t k = 1000; k < 1300; ++k) y[k] = missing;
  for (std::size_t k = 3000; k < 3300; ++k) T[k] = missing;
  for (std::size_t k = 0; k < y.size(); k += 7) y[k] = missing;
  const TemperatureModel model = fitted(y, T);
  ASSERT_EQ(model.degree, 3);
  EXPECT_NEAR(model.at(304.0).value().value, cubic(304.0), 1e-9);
}

TEST(TemperatureModel, ReportsTemperaturesWithoutData) {
  Series T = cycles(3.0, 6000);
  for (double& at : T) at = at > 296.0 && at < 304.0 ? missing : at;
  const TemperatureModel model = fitted(of(T, cubic), T);
  ASSERT_FALSE(model.notes.empty());
  EXPECT_NE(model.notes.back().find("nothing was recorded between 295.8 and 304.2 K"),
            std::string::npos)
      << model.notes.back();
}

TEST(TemperatureModel, HasPointsOfEachSweepToDraw) {
  const Series T =
      joined({sweep(290.0, 310.0, 2000), Series(500, 310.0), sweep(310.0, 290.0, 2000)});
  std::size_t heating = 0, cooling = 0, dwell = 0;
  for (const TemperaturePoint& point : fitted(of(T, cubic), T).points) {
    EXPECT_NEAR(point.mean, cubic(point.temperature_k), 0.05);
    (point.sweep == Sweep::heating   ? heating
     : point.sweep == Sweep::cooling ? cooling
                                     : dwell) += point.blocks;
  }
  EXPECT_NEAR(static_cast<double>(heating), 114.0, 4.0);
  EXPECT_NEAR(static_cast<double>(cooling), 114.0, 4.0);
  EXPECT_EQ(heating + cooling + dwell, 256u);
}

TEST(TemperatureModel, SaysWhyItCannot) {
  const Series T = cycles(1.0, 4096), y = of(T, cubic);
  const auto code = [](const Result<TemperatureModel>& result) { return result.error().code; };
  EXPECT_EQ(code(fit_temperature(y, T, {.rate_hz = 0.0})), Errc::invalid_argument);
  EXPECT_EQ(code(fit_temperature(y, T, {.rate_hz = missing})), Errc::invalid_argument);
  EXPECT_EQ(code(fit_temperature(y, T, {.rate_hz = 1.0, .least_span_k = -1.0})),
            Errc::invalid_argument);
  EXPECT_EQ(code(fit_temperature(y, T, {.rate_hz = 1.0, .most_degree = 0})),
            Errc::invalid_argument);
  EXPECT_EQ(code(fit_temperature(y, T, {.rate_hz = 1.0, .most_degree = 9})),
            Errc::invalid_argument);
  EXPECT_EQ(code(fit_temperature(View<double>(y).first(240), View<double>(T).first(240),
                                 {.rate_hz = 1.0})),
            Errc::too_few_samples);
  EXPECT_EQ(code(fit_temperature(Series(4096, missing), T, {.rate_hz = 1.0})),
            Errc::too_few_samples);
}

}  // namespace
}  // namespace proofmass::characterise::temperature_model_test
