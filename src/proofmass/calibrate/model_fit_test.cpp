#include "proofmass/calibrate/model_fit.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>
#include <random>

#include "proofmass/core/statistics.hpp"
#include "proofmass/core/units.hpp"

namespace proofmass::calibrate::model_fit_test {
namespace {

using sensor::Coefficient;
using sensor::ModelEquation;
using sensor::Motion;
using enum sensor::Coefficient;

constexpr double g = standard_gravity_mps2;

constexpr ModelEquation plausible{.K1 = 0.0336,
                                  .K0 = 0.2,
                                  .K0_asym = 1e-3,
                                  .K1_asym = 2e-4,
                                  .Koq = 3e-5,
                                  .K2 = 8e-5,
                                  .K3 = 2e-6,
                                  .delta_o = 4e-3,
                                  .delta_p = -7e-3,
                                  .Kip = 5e-5,
                                  .Kio = -6e-5,
                                  .Kpo = 2e-5,
                                  .Kpp = 3e-5,
                                  .Koo = -4e-5,
                                  .Kspin = 1e-4,
                                  .Kang = 2e-4};

std::vector<Coefficient> all_coefficients() {
  std::vector<Coefficient> all;
  for (const auto& one : sensor::coefficients()) all.push_back(one.coefficient);
  return all;
}

// Excites all terms, like a centrifuge with a rate table.
std::vector<Motion> rich_motion() {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::vector<Motion> motions;
  for (int k = 0; k < 120; ++k) {
    motions.push_back({40.0 * unit(random), 40.0 * unit(random), 40.0 * unit(random),
                       5.0 * unit(random), 5.0 * unit(random), 20.0 * unit(random)});
  }
  return motions;
}

// n angles about the output axis.
std::vector<Motion> tumble(int n) {
  std::vector<Motion> motions;
  for (int k = 0; k < n; ++k) {
    const double theta = 2.0 * std::numbers::pi * k / n;
    motions.push_back({.ai_mps2 = g * std::sin(theta), .ap_mps2 = g * std::cos(theta)});
  }
  return motions;
}

// 1 g in n directions over the sphere.
std::vector<Motion> sphere(int n) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  std::vector<Motion> motions;
  for (int k = 0; k < n; ++k) {
    const double x = normal(random), y = normal(random), z = normal(random);
    const double size = g / std::sqrt(x * x + y * y + z * z);
    motions.push_back({.ai_mps2 = size * x, .ap_mps2 = size * y, .ao_mps2 = size * z});
  }
  return motions;
}

std::vector<ModelRow> rows_of(const ModelEquation& equation, const std::vector<Motion>& motions) {
  std::vector<ModelRow> rows;
  for (const Motion& motion : motions) rows.push_back({motion, sensor::output(equation, motion)});
  return rows;
}

std::vector<ModelRow> noisy(std::vector<ModelRow> rows, double std, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, std);
  for (ModelRow& row : rows) row.output += normal(random);
  return rows;
}

ModelFit fitted(const std::vector<ModelRow>& rows, std::vector<Coefficient> coefficients) {
  return fit_model_equation(rows, {std::move(coefficients), {}}).value();
}

double value_of(const ModelFit& fit, Coefficient coefficient) {
  return fit.find(coefficient)->value.value().value;
}

TEST(ModelFit, FindsAllSixteenCoefficientsWhereTheMotionIsRichEnough) {
  const ModelFit fit = fitted(rows_of(plausible, rich_motion()), all_coefficients());
  for (const auto& one : sensor::coefficients()) {
    const double truth = plausible.*one.member;
    EXPECT_NEAR(value_of(fit, one.coefficient), truth, 1e-8 * std::abs(truth)) << one.name;
    EXPECT_DOUBLE_EQ(fit.equation.*one.member, value_of(fit, one.coefficient));
  }
  EXPECT_TRUE(fit.confounded.empty());
  EXPECT_LT(fit.residual_rms, 1e-13);
  EXPECT_EQ(fit.dof, 104U);
}

// The order of the request affects only the order of the results.
TEST(ModelFit, DoesNotDependOnTheOrderOfTheRequest) {
  const auto rows = noisy(rows_of(plausible, tumble(24)), 1e-4, 1);
  const ModelFit one = fitted(rows, {K1, K0, delta_o, K2});
  const ModelFit other = fitted(rows, {K2, delta_o, K1, K0});
  for (const Coefficient c : {K1, K0, delta_o, K2}) {
    EXPECT_NEAR(value_of(one, c), value_of(other, c), 1e-14);
    EXPECT_NEAR(one.find(c)->value->std, other.find(c)->value->std, 1e-14);
  }
  EXPECT_NEAR(one.covariance(1, 3), other.covariance(3, 0), 1e-18);
}

// The formulas of the multi-point tumble test: K1 = S1 + 3 S3, K3 = −4 S3/K1, δ = C1/K1,
// K2 = −2 C2/K1, Kip = 2 S2/K1, K0 = (B0 + C2)/K1, in units of g.
TEST(ModelFit, EqualsTheHarmonicRegressionOfTheTumbleTest) {
  const int n = 24;
  const auto rows = noisy(rows_of(plausible, tumble(n)), 1e-4, 2);
  double B0 = 0.0, S[4] = {}, C[4] = {};
  for (int k = 0; k < n; ++k) {
    const double theta = 2.0 * std::numbers::pi * k / n,
                 E = rows[static_cast<std::size_t>(k)].output;
    B0 += E / n;
    for (int m = 1; m <= 3; ++m) {
      S[m] += 2.0 / n * E * std::sin(m * theta);
      C[m] += 2.0 / n * E * std::cos(m * theta);
    }
  }
  const ModelFit fit = fitted(rows, {K1, K0, delta_o, K2, Kip, K3});
  const double k1 = S[1] + 3.0 * S[3];
  EXPECT_NEAR(value_of(fit, K1) * g, k1, 1e-12);
  EXPECT_NEAR(value_of(fit, K3) * g * g, -4.0 * S[3] / k1, 1e-10);
  EXPECT_NEAR(value_of(fit, delta_o), C[1] / k1, 1e-12);
  EXPECT_NEAR(value_of(fit, K2) * g, -2.0 * C[2] / k1, 1e-12);
  EXPECT_NEAR(value_of(fit, Kip) * g, 2.0 * S[2] / k1, 1e-12);
  EXPECT_NEAR(value_of(fit, K0) / g, (B0 + C[2]) / k1, 1e-12);
}

TEST(ModelFit, TakesTheOthersAsTheyAreHeld) {
  const auto rows = rows_of(plausible, rich_motion());
  const ModelFit without_k1 = fit_model_equation(rows, {{K0, K2, delta_p}, plausible}).value();
  EXPECT_NEAR(value_of(without_k1, K0), plausible.K0, 1e-12);
  EXPECT_NEAR(value_of(without_k1, delta_p), plausible.delta_p, 1e-14);
  const ModelFit k1_alone = fit_model_equation(rows, {{K1}, plausible}).value();
  EXPECT_NEAR(value_of(k1_alone, K1), plausible.K1, 1e-15);
}

TEST(ModelFit, SaysThatTheSquaresGoOnlyByTheirDifferencesAtOneG) {
  const ModelFit fit = fitted(rows_of(plausible, sphere(60)), {K1, K0, K2, Kpp, Koo, delta_o});
  ASSERT_EQ(fit.confounded.size(), 1U);
  const Confounded& group = fit.confounded.front();
  EXPECT_EQ(group.coefficients, (std::vector{K0, K2, Kpp, Koo}));
  EXPECT_EQ(group.determined, 3U);
  EXPECT_EQ(group.relations, (std::vector<std::string>{"a_o² = 1 − a_i² − a_p²"}));
  EXPECT_EQ(
      group.words,
      "K2, Kpp and Koo only by their differences, and K0 only with one of them, while |a| is the "
      "same in every row: choose two of the three, or change |a| (a centrifuge)");
  for (const Coefficient c : group.coefficients) {
    EXPECT_FALSE(fit.find(c)->value);
    EXPECT_EQ(fit.find(c)->reason, group.words);
  }
  EXPECT_NEAR(value_of(fit, K1), plausible.K1, 1e-3 * plausible.K1);
}

// The rows determine K0 + g² Koo, K2 − Koo and Kpp − Koo.
TEST(ModelFit, OffersTheIdentifiableCombinations) {
  ModelEquation quadratic = plausible;
  quadratic.K0_asym = quadratic.K1_asym = quadratic.Koq = quadratic.K3 = quadratic.Kio =
      quadratic.Kpo = quadratic.Kip = 0.0;
  const ModelFit fit =
      fitted(rows_of(quadratic, sphere(60)), {K1, K0, K2, Kpp, Koo, delta_o, delta_p});
  const auto& combinations = fit.confounded.at(0).combinations;
  ASSERT_EQ(combinations.size(), 3U);
  EXPECT_EQ(combinations[0].name, "K0 + 96.17 Koo");
  EXPECT_NEAR(combinations[0].value.value, quadratic.K0 + g * g * quadratic.Koo, 1e-12);
  EXPECT_EQ(combinations[1].name, "K2 − Koo");
  EXPECT_NEAR(combinations[1].value.value, quadratic.K2 - quadratic.Koo, 1e-14);
  EXPECT_EQ(combinations[2].name, "Kpp − Koo");
  EXPECT_NEAR(combinations[2].value.value, quadratic.Kpp - quadratic.Koo, 1e-14);
  EXPECT_LT(fit.residual_rms, 1e-14);
}

TEST(ModelFit, DeterminesOnlyK2MinusKppInAPlane) {
  const ModelFit fit = fitted(rows_of(plausible, tumble(24)), {K1, K0, K2, Kpp, delta_o});
  ASSERT_EQ(fit.confounded.size(), 1U);
  EXPECT_EQ(fit.confounded[0].combinations[1].name, "K2 − Kpp");
  EXPECT_EQ(
      fit.confounded[0].words,
      "K2 and Kpp only by their difference, and K0 only with one of them, while |a| is the same "
      "in every row: choose one of the two, or change |a| (a centrifuge)");
}

TEST(ModelFit, SaysThatFourPositionsDoNotShowOddTermsBesideTheScaleFactor) {
  const auto rows = noisy(rows_of({.K1 = 2.0, .K0 = 0.1}, tumble(4)), 1e-6, 3);
  ModelFitOptions options{{K1, K0, K3}, {}};
  const ModelFit fit = fit_model_equation(rows, options).value();
  ASSERT_EQ(fit.confounded.size(), 1U);
  EXPECT_EQ(fit.confounded[0].words,
            "K1 and K3 are not separable: in every row a_i³ = a_i (accelerations in g); choose "
            "one of them, or add rows with other values of a_i");
  EXPECT_EQ(fit.confounded[0].combinations.at(0).name, "K1 (1 + 96.17 K3)");
  EXPECT_NEAR(fit.confounded[0].combinations[0].value.value, 2.0, 1e-6);
  EXPECT_NEAR(value_of(fit, K0), 0.1, 1e-5);
}

TEST(ModelFit, CountsSeveralRelationsOfOneGroup) {
  const ModelFit fit =
      fitted(noisy(rows_of(plausible, tumble(4)), 1e-6, 4), {K1, Koq, K3, K0, delta_o});
  ASSERT_EQ(fit.confounded.size(), 1U);
  EXPECT_EQ(fit.confounded[0].coefficients, (std::vector{K1, Koq, K3}));
  EXPECT_EQ(fit.confounded[0].determined, 1U);
  EXPECT_EQ(fit.confounded[0].relations.size(), 2U);
  EXPECT_EQ(fit.confounded[0].combinations.size(), 1U);
}

TEST(ModelFit, GivesTheReasonWhereNoRowExcitesATerm) {
  const ModelFit fit = fitted(rows_of(plausible, tumble(12)), {K1, K0, Kspin, Kang, delta_p, Kio});
  EXPECT_EQ(fit.find(Kspin)->reason,
            "Kspin: no row turns about the input and the pendulous axis at once");
  EXPECT_EQ(fit.find(Kang)->reason, "Kang: no row has angular acceleration about the output axis");
  EXPECT_EQ(fit.find(delta_p)->reason, "delta_p: no row has acceleration along the output axis");
  EXPECT_FALSE(fit.find(Kio)->value);
  EXPECT_EQ(fit.covariance.row(2).norm(), 0.0);
  EXPECT_TRUE(fit.find(K0)->value);
}

// cos 90° is not exactly zero in floating point, but is no excitation.
TEST(ModelFit, DoesNotTakeRoundingForExcitation) {
  std::vector<Motion> motions = tumble(12);
  for (std::size_t k = 0; k < motions.size(); ++k) {
    motions[k].ao_mps2 = 6e-16 * static_cast<double>(k);
  }
  const ModelFit fit = fitted(rows_of(plausible, motions), {K1, K0, delta_p});
  EXPECT_FALSE(fit.find(delta_p)->value);
}

// Accelerations rounded to three digits of g do not separate K2 from Kpp.
TEST(ModelFit, DoesNotTakeRoundedAccelerationsForEvidence) {
  std::vector<Motion> motions = tumble(24);
  for (Motion& motion : motions) {
    motion.ai_mps2 = std::round(motion.ai_mps2 * 1e4) / 1e4;
    motion.ap_mps2 = std::round(motion.ap_mps2 * 1e4) / 1e4;
  }
  EXPECT_EQ(fitted(rows_of(plausible, motions), {K1, K0, K2, Kpp}).confounded.size(), 1U);
}

TEST(ModelFit, NamesNearConfoundingWithItsSize) {
  std::vector<Motion> motions;
  for (int k = 0; k < 30; ++k) {
    motions.push_back({.ai_mps2 = 0.95 * g + 0.1 * g * k / 29.0, .ap_mps2 = std::sin(k)});
  }
  const ModelFit fit = fitted(noisy(rows_of(plausible, motions), 1e-7, 5), {K1, K0, delta_o});
  ASSERT_FALSE(fit.notes.empty());
  EXPECT_NE(fit.notes[0].find("nearly confounded, most with K0"), std::string::npos)
      << fit.notes[0];
  EXPECT_GT(fit.find(K1)->variance_inflation, 100.0);
}

TEST(ModelFit, HasUnitInflationWhereTheDesignIsOrthogonal) {
  const ModelFit fit = fitted(noisy(rows_of(plausible, tumble(24)), 1e-5, 6), {K1, K0, delta_o});
  for (const auto& one : fit.coefficients) EXPECT_NEAR(one.variance_inflation, 1.0, 1e-12);
  EXPECT_NEAR(fit.condition, 1.0, 1e-12);
}

// var(K1) = 2 s²/(n g²) and var(K0) = s²/(n K1²) (1 + …) of the literature on tumbling.
TEST(ModelFit, HasTheKnownStandardDeviations) {
  std::vector<ModelRow> rows = rows_of({.K1 = 0.5}, tumble(24));
  for (ModelRow& row : rows) row.output_std = 1e-3;
  const ModelFit fit = fitted(rows, {K1, K0, delta_o});
  EXPECT_NEAR(fit.find(K1)->value->std, 1e-3 * std::sqrt(2.0 / 24.0) / g, 1e-15);
  EXPECT_NEAR(fit.find(K0)->value->std, 1e-3 / std::sqrt(24.0) / 0.5, 1e-12);
  EXPECT_NEAR(fit.find(delta_o)->value->std, 1e-3 * std::sqrt(2.0 / 24.0) / (0.5 * g), 1e-12);
  EXPECT_TRUE(fit.std_stated);
}

TEST(ModelFit, WeighsTheRowsByTheirStandardDeviations) {
  std::vector<ModelRow> rows = rows_of({.K1 = 1.0}, tumble(12));
  for (ModelRow& row : rows) row.output_std = 0.01;
  rows.push_back(rows[3]);
  rows.back().output += 1.0;
  rows.back().output_std = 1e6;
  EXPECT_NEAR(value_of(fitted(rows, {K1, K0}), K1), 1.0, 1e-8);
}

TEST(ModelFit, WidensStandardDeviationsThatTheResidualsContradict) {
  std::vector<ModelRow> rows = noisy(rows_of(plausible, tumble(24)), 1e-2, 7);
  const ModelFit unstated = fitted(rows, {K1, K0});
  for (ModelRow& row : rows) row.output_std = 1e-3;
  const ModelFit stated = fitted(rows, {K1, K0});
  ASSERT_TRUE(stated.test);
  EXPECT_LT(stated.test->p, 1e-6);
  EXPECT_GT(stated.scatter, 5.0);
  EXPECT_EQ(stated.notes.size(), 1U);
  EXPECT_NEAR(stated.find(K1)->value->std, unstated.find(K1)->value->std, 1e-12);
}

TEST(ModelFit, PassesAResidualTestThatIsMet) {
  std::vector<ModelRow> rows = noisy(rows_of({.K1 = 1.0}, tumble(24)), 1e-2, 8);
  for (ModelRow& row : rows) row.output_std = 1e-2;
  const ModelFit fit = fitted(rows, {K1, K0});
  EXPECT_GT(fit.test->p, 0.01);
  EXPECT_EQ(fit.scatter, 1.0);
  EXPECT_TRUE(fit.notes.empty());
}

// Ratios to an uncertain K1: the delta method compared with repetition.
TEST(ModelFit, StatesTheScatterOfItsRatiosAndCoversNinetyFivePercent) {
  const ModelEquation truth{.K1 = 0.03, .K0 = 2.0, .K2 = 2e-3, .delta_o = 0.05};
  const auto rows = rows_of(truth, tumble(12));
  const std::vector<Coefficient> asked{K1, K0, delta_o, K2};
  constexpr int runs = 4000;
  std::array<Moments, 4> estimates;
  std::array<int, 4> covered{};
  double predicted[4] = {};
  for (int run = 0; run < runs; ++run) {
    const ModelFit fit = fitted(noisy(rows, 5e-3, 100U + static_cast<unsigned>(run)), asked);
    for (std::size_t c = 0; c < asked.size(); ++c) {
      const Uncertain value = fit.coefficients[c].value.value();
      const double error = value.value - truth.*sensor::info(asked[c]).member;
      estimates[c].add(value.value);
      predicted[c] += value.std * value.std / runs;
      covered[c] += std::abs(error) < fit.coefficients[c].half_width_95 ? 1 : 0;
    }
  }
  for (std::size_t c = 0; c < asked.size(); ++c) {
    EXPECT_NEAR(std::sqrt(predicted[c]), estimates[c].std(), 0.04 * estimates[c].std()) << c;
    EXPECT_GT(covered[c], 0.935 * runs) << c;
    EXPECT_LT(covered[c], 0.965 * runs) << c;
  }
}

TEST(ModelFit, RefusesWhatItCannotFit) {
  const auto rows = rows_of({.K1 = 1.0}, tumble(4));
  const auto code = [](const std::vector<ModelRow>& from, std::vector<Coefficient> asked) {
    return fit_model_equation(from, {std::move(asked), {}}).error().code;
  };
  EXPECT_EQ(code(rows, {}), Errc::invalid_argument);
  EXPECT_EQ(code(rows, {K1, K1}), Errc::invalid_argument);
  EXPECT_EQ(code({}, {K1}), Errc::too_few_samples);
  EXPECT_EQ(code({rows[0], rows[1]}, {K1, K0, delta_o}), Errc::too_few_samples);
  EXPECT_EQ(code(rows, {K1, K0, delta_o, K2}), Errc::too_few_samples);
  auto bad = rows;
  bad[1].output = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(code(bad, {K1}), Errc::not_finite);
  bad = rows;
  bad[1].output_std = 1.0;
  EXPECT_EQ(code(bad, {K1}), Errc::invalid_argument);
  bad[1].output_std = -1.0;
  EXPECT_EQ(code(bad, {K1}), Errc::invalid_argument);
  bad = rows;
  bad[1].motion.ai_mps2 = 1e200;
  EXPECT_EQ(code(bad, {K1, K0, K3}), Errc::not_finite);
}

TEST(ModelFit, RefusesToDivideByAScaleFactorThatIsNotThere) {
  std::vector<ModelRow> rows(8);
  for (ModelRow& row : rows) row = {{.ap_mps2 = g}, 1.0};
  EXPECT_EQ(fit_model_equation(rows, {{K1, K0}, {}}).error().code, Errc::not_observable);
  EXPECT_EQ(fit_model_equation(rows, {{K1}, {}}).error().code, Errc::not_observable);
  EXPECT_EQ(fit_model_equation(rows, {{Koo, Kspin}, {}}).error().code, Errc::not_observable);
  const auto noise = noisy(rows_of({.K1 = 0.0}, tumble(12)), 1.0, 9);
  EXPECT_EQ(fit_model_equation(noise, {{K1, K0}, {}}).error().code, Errc::not_observable);
}

// 41 rows of a tumble with noise of 1e-4.
std::vector<ModelRow> noisy_rows(bool stated, std::mt19937_64& random) {
  std::normal_distribution<double> noise(0.0, 1e-4);
  std::vector<ModelRow> rows;
  for (int k = 0; k <= 40; ++k) {
    const double phi = 2.0 * std::numbers::pi * k / 40.0, a = g * std::sin(phi);
    ModelRow row{.motion = {.ai_mps2 = a, .ap_mps2 = g * std::cos(phi)}};
    row.output = 0.0336 * (0.2 + a + 8e-5 * a * a) + noise(random);
    if (stated) row.output_std = 1e-4;
    rows.push_back(row);
  }
  return rows;
}

TEST(ModelFit, NamesTheRowThatContradictsTheOthers) {
  const ModelFitOptions options{.fitted = {Coefficient::K1, Coefficient::K0, Coefficient::K2},
                                .held = {}};
  for (const bool stated : {true, false}) {
    std::mt19937_64 random(21);
    int named = 0, others = 0, for_nothing = 0;
    constexpr int tests = 200;
    for (int test = 0; test < tests; ++test) {
      std::vector<ModelRow> rows = noisy_rows(stated, random);
      for_nothing += fit_model_equation(rows, options).value().suspects.empty() ? 0 : 1;
      rows[17].output += 20e-4;
      const ModelFit fit = fit_model_equation(rows, options).value();
      for (const std::size_t row : fit.suspects) ++(row == 17 ? named : others);
      EXPECT_NE(fit.notes.back().find("row 18 contradicts"), std::string::npos);
    }
    EXPECT_EQ(named, tests) << stated;
    EXPECT_LE(others, 6) << stated;
    EXPECT_LE(for_nothing, 6) << stated;
  }
}

}  // namespace
}  // namespace proofmass::calibrate::model_fit_test
