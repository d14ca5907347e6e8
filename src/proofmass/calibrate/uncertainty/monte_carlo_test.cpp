#include "proofmass/calibrate/uncertainty/monte_carlo.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numeric>

#include "proofmass/calibrate/uncertainty/draw.hpp"
#include "proofmass/core/statistics.hpp"

namespace proofmass::calibrate::monte_carlo_test {
namespace {

using D = Distribution;

double sum(View<double> x) {
  return std::accumulate(x.begin(), x.end(), 0.0);
}

// Budget of a sum, or of a function with these sensitivities.
UncertaintyBudget budget_of_inputs(double y, View<Input> inputs, std::vector<double> sensitivity) {
  std::vector<BudgetLine> lines;
  for (std::size_t i = 0; i < inputs.size(); ++i)
    lines.push_back(
        {"x", false, inputs[i].distribution, inputs[i].std, "1", sensitivity[i], inputs[i].dof});
  return combine({"y", "1", y}, std::move(lines)).value();
}

// JCGM 101, 9.2.2: four normal inputs.
TEST(Propagate, OfFourNormalInputsIsNormal) {
  const std::vector<Input> inputs(4, Input{0.0, 1.0, D::normal});
  const auto found = propagate(sum, inputs).value();
  EXPECT_NEAR(found.mean, 0.0, 0.02);
  EXPECT_NEAR(found.std, 2.0, 0.01);
  EXPECT_NEAR(found.symmetric_95.lower, -3.92, 0.04);
  EXPECT_NEAR(found.symmetric_95.upper, 3.92, 0.04);
  EXPECT_EQ(validate(budget_of_inputs(0.0, inputs, {1, 1, 1, 1}), found).agreement, Agreement::yes);
}

// JCGM 101, 9.2.3: four rectangular inputs of equal width, ± 3.88.
TEST(Propagate, OfFourRectangularInputsIsNarrowerThanNormal) {
  const std::vector<Input> inputs(4, Input{0.0, 1.0, D::uniform});
  const double exact = 2.0 * std::sqrt(3.0) * (2.0 - std::pow(3.0 / 5.0, 0.25));
  EXPECT_NEAR(exact, 3.88, 0.005);
  const auto found = propagate(sum, inputs, {.draws = 300000, .seed = 2}).value();
  EXPECT_NEAR(found.std, 2.0, 0.005);
  EXPECT_NEAR(found.symmetric_95.lower, -exact, 0.03);
  EXPECT_NEAR(found.symmetric_95.upper, exact, 0.03);
  EXPECT_NEAR(found.shortest_95.upper - found.shortest_95.lower, 2.0 * exact, 0.06);
  const auto budget = budget_of_inputs(0.0, inputs, {1, 1, 1, 1});
  EXPECT_EQ(validate(budget, found, 1).agreement, Agreement::yes);
}

// JCGM 101, 9.2.4: one of them ten times as wide: u = 10.1; the GUM gives ± 19.9, the correct
// interval is ± 17.0.
TEST(Validate, ContradictsTheBudgetThatOneRectangleDominates) {
  std::vector<Input> inputs(4, Input{0.0, 1.0, D::uniform});
  inputs[3].std = 10.0;
  const auto found = propagate(sum, inputs, {.draws = 1000000, .seed = 3}).value();
  EXPECT_NEAR(found.std, 10.1, 0.1);
  EXPECT_NEAR(found.symmetric_95.upper, 17.0, 0.1);
  const auto budget = budget_of_inputs(0.0, inputs, {1, 1, 1, 1});
  EXPECT_NEAR(budget.expanded_95, 19.9, 0.05);
  const auto judged = validate(budget, found);
  EXPECT_DOUBLE_EQ(judged.tolerance, 0.5);
  EXPECT_NEAR(judged.upper_difference, 2.8, 0.1);
  EXPECT_EQ(judged.agreement, Agreement::no);
  EXPECT_NE(judged.verdict.find("contradicts the budget"), std::string::npos);
}

// JCGM 101, 9.3: calibration of a mass, 1.2341 mg, u 0.0754 mg, [1.0834, 1.3825] mg; the
// first-order GUM gives u 0.0539 mg, [1.1285, 1.3395] mg.
TEST(Propagate, GivesTheMassCalibrationOfTheSupplement) {
  const std::vector<Input> inputs{{100000.0, 0.050, D::normal},
                                  {1.234, 0.020, D::normal},
                                  {1.20, 0.10 / std::sqrt(3.0), D::uniform},
                                  {8e3, 1e3 / std::sqrt(3.0), D::uniform},
                                  {8.00e3, 0.05e3 / std::sqrt(3.0), D::uniform}};
  const Measurement mass = [](View<double> x) {
    return (x[0] + x[1]) * (1.0 + (x[2] - 1.2) * (1.0 / x[3] - 1.0 / x[4])) - 100000.0;
  };
  const auto found = propagate(mass, inputs, {.draws = 1000000, .seed = 4}).value();
  EXPECT_NEAR(found.mean, 1.2341, 0.0005);
  EXPECT_NEAR(found.std, 0.0754, 0.0003);
  EXPECT_NEAR(found.shortest_95.lower, 1.0834, 0.003);
  EXPECT_NEAR(found.shortest_95.upper, 1.3825, 0.003);
  const auto budget = budget_of_inputs(1.234, inputs, {1.0, 1.0, 0.0, 0.0, 0.0});
  EXPECT_NEAR(budget.combined_std, 0.0539, 5e-5);
  EXPECT_NEAR(budget.measurand.value - budget.expanded_95, 1.1285, 1e-4);
  EXPECT_EQ(validate(budget, found, 1).agreement, Agreement::no);
}

// JCGM 101, 9.4: comparison loss δY = X1² + X2² in 1e-6, u(x) = 0.005.
TEST(Propagate, GivesTheComparisonLossOfTheSupplement) {
  const Measurement loss = [](View<double> x) { return 1e6 * (x[0] * x[0] + x[1] * x[1]); };
  struct Case {
    double x1, mean, std, lower, upper;
  };
  for (const Case& c : {Case{0.000, 50, 50, 0, 150}, Case{0.010, 150, 112, 0, 367},
                        Case{0.050, 2551, 502, 1590, 3543}}) {
    const std::vector<Input> inputs{{c.x1, 0.005}, {0.0, 0.005}};
    const auto found = propagate(loss, inputs, {.draws = 200000, .seed = 5}).value();
    EXPECT_NEAR(found.mean, c.mean, 0.01 * c.mean);
    EXPECT_NEAR(found.std, c.std, 0.01 * c.std);
    EXPECT_NEAR(found.shortest_95.lower, c.lower, 0.08 * c.std);
    EXPECT_NEAR(found.shortest_95.upper, c.upper, 0.08 * c.std);
  }
}

// JCGM 101, 9.4.3: the same with correlation 0.9 at x1 = 0.050: E = x1² + 2u², var = 4 x1² u² + 4
// u⁴ (1 + r²).
TEST(Propagate, IncludesCorrelation) {
  const Measurement loss = [](View<double> x) { return 1e6 * (x[0] * x[0] + x[1] * x[1]); };
  Eigen::MatrixXd r = Eigen::MatrixXd::Identity(2, 2);
  r(0, 1) = r(1, 0) = 0.9;
  const std::vector<Input> inputs{{0.050, 0.005}, {0.0, 0.005}};
  const auto found = propagate(loss, inputs, {.draws = 200000, .seed = 6, .correlation = r});
  EXPECT_NEAR(found->mean, 2550.0, 5.0);
  EXPECT_NEAR(found->std, 1e6 * std::sqrt(4 * 25e-4 * 25e-6 + 4 * 625e-12 * 1.81), 4.0);
}

TEST(Propagate, IsTheSameForTheSameSeed) {
  const std::vector<Input> inputs(2, Input{0.0, 1.0, D::student_t, 5.0});
  const auto one = propagate(sum, inputs, {.draws = 1000, .seed = 7}).value();
  const auto again = propagate(sum, inputs, {.draws = 1000, .seed = 7}).value();
  const auto other = propagate(sum, inputs, {.draws = 1000, .seed = 8}).value();
  EXPECT_EQ(one.mean, again.mean);
  EXPECT_NE(one.mean, other.mean);
}

TEST(Propagate, CountsWhatHasNoResultAndSaysWhyItCannot) {
  const std::vector<Input> inputs{{0.0, 1.0}};
  const Measurement root = [](View<double> x) { return std::sqrt(x[0]); };
  const auto found = propagate(root, inputs, {.draws = 1000}).value();
  EXPECT_EQ(found.draws + found.without, 1000U);
  EXPECT_NEAR(static_cast<double>(found.draws), 500.0, 60.0);
  EXPECT_EQ(propagate(root, inputs, {.draws = 150}).error().code, Errc::too_few_samples);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Input> bad{{nan, 1.0}}, negative{{0.0, -1.0}}, uniform{{0.0, 1.0, D::uniform}};
  EXPECT_EQ(propagate(root, bad).error().code, Errc::not_finite);
  EXPECT_EQ(propagate(root, negative).error().code, Errc::invalid_argument);
  EXPECT_EQ(propagate(root, uniform, {.correlation = Eigen::MatrixXd::Identity(1, 1)}).error().code,
            Errc::invalid_argument);
}

TEST(Propagate, OfWhatDoesNotVaryIsThatValue) {
  const std::vector<Input> inputs{{2.0, 0.0}};
  const auto found = propagate(sum, inputs, {.draws = 200}).value();
  EXPECT_EQ(found.std, 0.0);
  EXPECT_EQ(found.symmetric_95.lower, 2.0);
  EXPECT_EQ(validate(budget_of_inputs(2.0, inputs, {1.0}), found).agreement, Agreement::yes);
}

TEST(Validate, IsUndecidedWithTooFewDraws) {
  const std::vector<Input> inputs(4, Input{0.0, 1.0, D::normal});
  const auto found = propagate(sum, inputs, {.draws = 200}).value();
  const auto judged = validate(budget_of_inputs(0.0, inputs, {1, 1, 1, 1}), found);
  EXPECT_EQ(judged.agreement, Agreement::cannot_tell);
  EXPECT_NE(judged.verdict.find("too few"), std::string::npos);
}

// JCGM 101, 8.1.3: 0.00035 is 35e-5, so δ = 5e-6; 0.0996 rounds to 10e-2 with two digits.
TEST(Validate, TakesHalfOfTheLastDigit) {
  const auto tolerance = [](double u, int digits) {
    const std::vector<Input> inputs{{0.0, u}};
    const auto found = propagate(sum, inputs, {.draws = 200}).value();
    return validate(budget_of_inputs(0.0, inputs, {1.0}), found, digits).tolerance;
  };
  EXPECT_NEAR(tolerance(0.00035, 2), 5e-6, 1e-15);
  EXPECT_NEAR(tolerance(0.00035, 1), 5e-5, 1e-15);
  EXPECT_NEAR(tolerance(2.0, 2), 0.05, 1e-12);
  EXPECT_NEAR(tolerance(0.0996, 2), 0.005, 1e-12);
}

TEST(Draw, HasTheMomentsOfEachDistribution) {
  struct Case {
    D distribution;
    double dof, variance, fourth;  // fourth: kurtosis ⟨x⁴⟩/⟨x²⟩²
  };
  for (const Case& c : {Case{D::normal, 0, 1, 3}, Case{D::uniform, 0, 1, 1.8},
                        Case{D::triangular, 0, 1, 2.4}, Case{D::arcsine, 0, 1, 1.5},
                        Case{D::student_t, 12, 1.2, 3.75}, Case{D::student_t, 0, 1, 3}}) {
    Draw draw(9);
    double second = 0.0, fourth = 0.0;
    constexpr int n = 200000;
    Moments spread;
    for (int k = 0; k < n; ++k) {
      const double x = draw(c.distribution, c.dof);
      spread.add(x);
      second += x * x / n;
      fourth += x * x * x * x / n;
    }
    EXPECT_NEAR(spread.mean, 0.0, 0.01);
    EXPECT_NEAR(second, c.variance, 0.015);
    EXPECT_NEAR(fourth / (second * second), c.fourth, 0.05 * c.fourth);
  }
}

}  // namespace
}  // namespace proofmass::calibrate::monte_carlo_test
