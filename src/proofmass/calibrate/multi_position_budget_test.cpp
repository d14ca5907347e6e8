#include "proofmass/calibrate/multi_position_budget.hpp"

#include <cmath>
#include <gtest/gtest.h>

#include "proofmass/calibrate/multi_position_check.hpp"
#include "proofmass/calibrate/uncertainty/budget_test_support.hpp"

namespace proofmass::calibrate::multi_position_budget_test {
namespace {

struct Calibrated {
  std::vector<Pose> poses;
  MultiPositionOptions options;
  MultiPosition fit;
};

Calibrated calibrated(double gravity_std = 1e-3) {
  Calibrated out{poses_of(analog_sensor(), noise_v, true, 3), with_gravity(gravity_std, 500.0), {}};
  out.fit = calibrate_positions(out.poses, out.options).value();
  return out;
}

std::vector<TypeB> lines_of(std::initializer_list<const char*> texts) {
  std::vector<TypeB> lines;
  for (const char* text : texts) lines.push_back(parse_type_b(text).value());
  return lines;
}

TEST(BudgetOf, AddsUpToTheCovarianceOfTheFit) {
  const Calibrated it = calibrated();
  const auto budgets = budget_of(it.fit, {}, "V").value();
  ASSERT_EQ(budgets.size(), 9U);
  for (std::size_t k = 0; k < 9; ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    EXPECT_EQ(budgets[k].measurand.quantity, parameter_names()[k]);
    EXPECT_EQ(budgets[k].measurand.value, it.fit.estimate[k]);
    EXPECT_NEAR(budgets[k].combined_std, std::sqrt(it.fit.covariance(i, i)),
                1e-12 * budgets[k].combined_std);
  }
  EXPECT_EQ(budgets[0].measurand.unit, "V");
  EXPECT_EQ(budgets[3].measurand.unit, "V/(m/s^2)");
  EXPECT_EQ(budgets[8].measurand.unit, "rad");
  EXPECT_EQ(budget_of(it.fit, {}, "m/s^2").value()[3].measurand.unit, "1");
}

TEST(BudgetOf, StatesGravityByItsOwnUncertaintyAndSensitivity) {
  const Calibrated it = calibrated();
  const auto scale_x = budget_of(it.fit, {}, "V").value()[3];
  ASSERT_EQ(scale_x.lines.size(), 2U);
  EXPECT_TRUE(scale_x.lines[0].type_a);
  EXPECT_GT(scale_x.lines[0].dof, 0.0);
  EXPECT_EQ(scale_x.lines[1].source, "gravity");
  EXPECT_NEAR(scale_x.lines[1].std, 1e-3, 1e-12);
  EXPECT_EQ(scale_x.lines[1].unit, "m/s^2");
  EXPECT_NEAR(scale_x.lines[1].sensitivity, -it.fit.estimate[3] / g, 1e-12);
}

TEST(BudgetOf, HasALineOfGravityEvenWhereItIsTakenForExact) {
  const auto budgets = budget_of(calibrated(0.0).fit, {}, "V").value();
  ASSERT_EQ(budgets[3].lines.size(), 2U);
  EXPECT_EQ(budgets[3].lines[1].source, "gravity");
  EXPECT_EQ(budgets[3].lines[1].std, 0.0);
  EXPECT_EQ(budgets[0].lines.size(), 1U);
}

// If rounding explains the whole variance of a mean, no noise remains, and the sum is unchanged.
TEST(BudgetOf, TakesTheResolutionOutOfTheNoiseOfTheMeans) {
  Calibrated it = calibrated();
  const auto plain = budget_of(it.fit, {}, "V").value();
  for (const double part : {0.4, 1.0}) {
    for (Pose& pose : it.poses) pose.rounding_variance = part * pose.mean_covariance.diagonal();
    const MultiPosition fit = calibrate_positions(it.poses, it.options).value();
    const auto budgets = budget_of(fit, {}, "V").value();
    EXPECT_EQ(fit.shares[1].source, "resolution of the output");
    EXPECT_FALSE(fit.shares[1].type_a);
    for (std::size_t k = 0; k < 9; ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      EXPECT_NEAR(budgets[k].combined_std, plain[k].combined_std, 1e-9 * plain[k].combined_std);
      const double noise = it.fit.shares[0].covariance(i, i);
      EXPECT_NEAR(fit.shares[1].covariance(i, i) / noise, part, 0.2 * part);
    }
  }
}

TEST(AddTypeB, IsTheSameAsTheBudgetWithItsLines) {
  Calibrated it = calibrated();
  const auto lines =
      lines_of({"ADC reference,scale,0.05 %,uniform", "drift,bias.z,0.3 mg",
                "temperature,bias,2 K * 0.1 mV/K,uniform,50",
                "alignment,misalignment,0.1 deg,triangular", "gravity,gravity,1e-3 m/s^2"});
  const auto budgets = budget_of(it.fit, lines, "V").value();
  const MultiPosition before = it.fit;
  ASSERT_TRUE(add_type_b(it.fit, lines, "V"));
  EXPECT_EQ(it.fit.shares.size(), before.shares.size() + 5);
  for (std::size_t k = 0; k < 9; ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    EXPECT_NEAR(budgets[k].combined_std, std::sqrt(it.fit.covariance(i, i)),
                1e-12 * budgets[k].combined_std);
  }
  EXPECT_NEAR(it.fit.bias[2]->std, budgets[2].combined_std, 1e-15);
  EXPECT_EQ(budgets[2].lines.size(), 3U);
  EXPECT_NEAR(budgets[2].lines[1].sensitivity, it.fit.estimate[5], 1e-15);
  // A common reference correlates the scales of all axes; independent drifts leave the biases
  // uncorrelated.
  const double reference = 5e-4 / std::sqrt(3.0);
  EXPECT_NEAR(it.fit.covariance(3, 4) - before.covariance(3, 4),
              it.fit.estimate[3] * it.fit.estimate[4] * (reference * reference + 1e-6 / g / g),
              1e-18);
  EXPECT_EQ(it.fit.covariance(0, 1), before.covariance(0, 1));
}

TEST(AddTypeB, GivesTheReasonOfAFailureAndChangesNothing) {
  Calibrated it = calibrated();
  const MultiPosition before = it.fit;
  const auto message = [&](const char* text) {
    const auto lines = lines_of({"noise,bias,1 mV", text});
    EXPECT_FALSE(budget_of(it.fit, lines, "V"));
    const Status status = add_type_b(it.fit, lines, "V");
    EXPECT_FALSE(status);
    return status.error().message;
  };
  EXPECT_NE(message("table,angle,0.1 deg").find("tumble"), std::string::npos);
  EXPECT_NE(message("adc,bias,2 counts").find("readings in V"), std::string::npos);
  EXPECT_EQ(it.fit.covariance, before.covariance);
}

TEST(CheckByMonteCarlo, ConfirmsTheBudgetOfAGoodCalibration) {
  const Calibrated it = calibrated();
  const auto check =
      check_by_monte_carlo(
          it.poses, it.options, it.fit,
          {.lines = lines_of({"ADC reference,scale,0.01 %,uniform"}), .reading_unit = "V"})
          .value();
  EXPECT_TRUE(check.agrees) << check.verdict;
  EXPECT_EQ(check.draws, 200U);
  EXPECT_EQ(check.failed, 0U);
  ASSERT_EQ(check.parameters.size(), 9U);
  for (const ParameterCheck& one : check.parameters) {
    EXPECT_EQ(one.agreement, BudgetSize::right) << one.quantity;
    EXPECT_NEAR(one.drawn_std / one.budget_std, 1.0, 0.2);
    EXPECT_NEAR(one.inside, 0.95, 0.06);
  }
  EXPECT_EQ(check.verdict.find("200 calibrations of simulated data confirm the budget"), 0U);
}

TEST(CheckByMonteCarlo, TakesUnstatedNoiseFromTheResiduals) {
  Calibrated it{poses_of(analog_sensor(), noise_v, false, 5), with_gravity(0.0, 0.0), {}};
  it.fit = calibrate_positions(it.poses, it.options).value();
  const auto check = check_by_monte_carlo(it.poses, it.options, it.fit,
                                          {.lines = {}, .reading_unit = "V", .draws = 100})
                         .value();
  EXPECT_TRUE(check.agrees) << check.verdict;
  for (const ParameterCheck& one : check.parameters)
    EXPECT_NEAR(one.drawn_std / one.budget_std, 1.0, 0.3) << one.quantity;
}

TEST(CheckByMonteCarlo, ContradictsABudgetThatLeavesSomethingOut) {
  Calibrated it = calibrated();
  for (UncertaintyShare& share : it.fit.shares)
    if (share.source != "gravity") share.covariance *= 0.25;
  const auto check = check_by_monte_carlo(it.poses, it.options, it.fit,
                                          {.lines = {}, .reading_unit = "V", .draws = 100})
                         .value();
  EXPECT_FALSE(check.agrees);
  EXPECT_EQ(check.parameters[0].agreement, BudgetSize::too_small);
  EXPECT_NE(check.verdict.find("contradict the budget of bias x"), std::string::npos)
      << check.verdict;
}

TEST(CheckByMonteCarlo, SaysThatABudgetIsLargerThanNeeded) {
  Calibrated it = calibrated();
  for (UncertaintyShare& share : it.fit.shares) share.covariance *= 4.0;
  const auto check = check_by_monte_carlo(it.poses, it.options, it.fit,
                                          {.lines = {}, .reading_unit = "V", .draws = 100})
                         .value();
  EXPECT_TRUE(check.agrees);
  EXPECT_NE(check.verdict.find("larger than needed for bias x"), std::string::npos);
}

TEST(CheckByMonteCarlo, HasNothingToCompareForExactReadings) {
  Calibrated it{poses_of(analog_sensor(), 0.0, false, 1), with_gravity(0.0, 0.0), {}};
  it.fit = calibrate_positions(it.poses, it.options).value();
  const auto check = check_by_monte_carlo(it.poses, it.options, it.fit,
                                          {.lines = {}, .reading_unit = "V", .draws = 100})
                         .value();
  EXPECT_TRUE(check.agrees) << check.verdict;
}

TEST(CheckByMonteCarlo, DrawsUntilTwoDigitsAreStable) {
  const Calibrated it = calibrated();
  const auto check = check_by_monte_carlo(it.poses, it.options, it.fit,
                                          {.lines = {}, .reading_unit = "V", .draws = std::nullopt})
                         .value();
  EXPECT_TRUE(check.agrees) << check.verdict;
  EXPECT_GE(check.draws, 20000U);
  EXPECT_LE(check.draws, 1000000U);
  ASSERT_TRUE(check.stable.has_value());
  EXPECT_EQ(*check.stable, check.draws < 1000000U);
  EXPECT_NE(check.verdict.find("adaptive procedure"), std::string::npos) << check.verdict;
  for (const ParameterCheck& one : check.parameters) {
    EXPECT_NEAR(one.drawn_std / one.budget_std, 1.0, 0.02) << one.quantity;
    EXPECT_NEAR(one.inside, 0.95, 0.01) << one.quantity;
  }
}

TEST(CheckByMonteCarlo, NeedsAHundredDraws) {
  const Calibrated it = calibrated();
  const auto check = check_by_monte_carlo(it.poses, it.options, it.fit,
                                          {.lines = {}, .reading_unit = "V", .draws = 10});
  EXPECT_EQ(check.error().code, Errc::too_few_samples);
}

// Each model's budget compared with draws of the quantities that it assumes exact.
TEST(CheckByMonteCarlo, ConfirmsTheBudgetsOfTheOtherModels) {
  Parameters square = analog_sensor();
  square.tail<3>().setZero();
  Calibrated it{poses_of(square, noise_v, true, 7), with_gravity(1e-3, 500.0), {}};
  for (const PoseModel model : {PoseModel::norm_6, PoseModel::given_12}) {
    it.options.model = model;
    it.options.orthogonality_std_rad = 2e-3;
    it.fit = calibrate_positions(it.poses, it.options).value();
    const auto check = check_by_monte_carlo(it.poses, it.options, it.fit,
                                            {.lines = {}, .reading_unit = "V", .draws = 100})
                           .value();
    EXPECT_TRUE(check.agrees) << check.verdict;
    EXPECT_EQ(check.parameters.size(), model == PoseModel::norm_6 ? 6U : 9U);
  }
}

}  // namespace
}  // namespace proofmass::calibrate::multi_position_budget_test
