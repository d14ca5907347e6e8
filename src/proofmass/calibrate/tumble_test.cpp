#include "proofmass/calibrate/tumble.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <limits>

#include "proofmass/calibrate/tumble_test_support.hpp"

namespace proofmass::calibrate::tumble_test {
namespace {

using Q = TumbleQuantity;

constexpr double g = table_gravity_mps2;

TumbleFit fitted(const std::vector<TumblePosition>& positions,
                 const TumbleOptions& options = table_options()) {
  return fit_tumble(positions, options).value();
}

double value(const TumbleFit& fit, Q quantity, int plane = 0) {
  const TumbleCoefficient* found = fit.find(quantity, plane);
  EXPECT_TRUE(found != nullptr && found->value) << name_of(quantity);
  return found != nullptr && found->value ? *found->value
                                          : std::numeric_limits<double>::quiet_NaN();
}

bool has(const TumbleFit& fit, Q quantity) {
  const TumbleCoefficient* found = fit.find(quantity);
  return found != nullptr && found->value.has_value();
}

std::string reason(const TumbleFit& fit, Q quantity) {
  const TumbleCoefficient* found = fit.find(quantity);
  return found == nullptr ? "" : found->reason;
}

// Checks every value to a fraction of its natural size. An error of the table's angle also has
// effects of second order, its product with the misalignment, some 1e-9, which a linear model does
// not include.
void expect_truth(const TumbleFit& fit, const TableTruth& truth, double tolerance) {
  for (const TumbleCoefficient& c : fit.coefficients) {
    if (!c.value || (c.quantity == Q::misalignment && c.mount_rad > 1e-6)) continue;
    const double size =
        c.quantity == Q::K1 ? truth.K1 : std::pow(g, acceleration_power(c.quantity));
    const double expected = true_value(truth, c.quantity, fit.positions.size());
    EXPECT_NEAR(*c.value, expected, tolerance * size) << name_of(c.quantity);
  }
}

TEST(FourPointTumble, IsTheMultipointsSpecialCase) {
  std::vector<TumblePosition> positions = table_turn(4);
  const std::vector<double> readings{1.651234, 1.983456, 1.647891, 1.318765};
  for (std::size_t k = 0; k < 4; ++k) positions[k].output = readings[k];
  const TumbleFit fit = fitted(positions);
  const FourPointResult closed =
      four_point({readings[0], readings[1], readings[2], readings[3]}, g);
  EXPECT_NEAR(value(fit, Q::K1), closed.K1, 1e-15);
  EXPECT_NEAR(value(fit, Q::K0), closed.bias_0g_mps2, 1e-12);
  EXPECT_NEAR(value(fit, Q::K0_up_down), closed.bias_up_down_mps2, 1e-12);
  EXPECT_NEAR(value(fit, Q::misalignment), closed.misalignment_rad, 1e-14);
  EXPECT_NEAR(value(fit, Q::K2_minus_Kpp), closed.K2_minus_Kpp_s2pm, 1e-14);
  EXPECT_EQ(fit.dof, 0U);
}

TEST(FourPointTumble, StaysSoWhateverTheIndexingAndTheNoise) {
  std::vector<TumblePosition> positions = read_table(table_turn(4), {});
  for (std::size_t k = 0; k < 4; ++k) positions[k].output_std = 1e-5 * static_cast<double>(k + 1);
  TumbleOptions options = table_options();
  options.indexing_std_rad = 1e-4;
  const FourPointResult closed = four_point(
      {positions[0].output, positions[1].output, positions[2].output, positions[3].output}, g);
  const TumbleFit fit = fitted(positions, options);
  EXPECT_NEAR(value(fit, Q::K0), closed.bias_0g_mps2, 1e-12);
  EXPECT_NEAR(value(fit, Q::misalignment), closed.misalignment_rad, 1e-14);
  EXPECT_TRUE(fit.find(Q::K1)->std);
}

TEST(FourPointTumble, SaysThatItsScaleHoldsTheThirdOrderTerm) {
  const TableTruth truth{.K3 = 1e-4};
  const TumbleFit fit = fitted(read_table(table_turn(4), truth));
  EXPECT_NEAR(value(fit, Q::K1), truth.K1 * (1.0 + truth.K3 * g * g), 1e-14);
  EXPECT_EQ(fit.find(Q::K1)->meaning, "K1 (1 + K3 g²): the slope between +1 g and −1 g");
  EXPECT_FALSE(has(fit, Q::K3));
  EXPECT_NE(reason(fit, Q::K3).find("between the quarters"), std::string::npos);
}

// Thesis 5.1.2: E0 and E180 of x in g; the formula gives −197.9 mg, printed is −19.78.
TEST(FourPointTumble, PutsTheThesisRight) {
  const CorrectionFactors x = correction_factors({-0.17517, 1.0, -0.22057, -1.0}, 1.0, 1.0);
  EXPECT_NEAR(x.offset, -0.19787, 1e-12);
  EXPECT_DOUBLE_EQ(x.scale, 1.0);
  EXPECT_DOUBLE_EQ(x.scale_factor_error, 0.0);
  // For y the same two positions are up and down: 0.58541 and −1.0330.
  const CorrectionFactors y = correction_factors({0.0, 0.58541, 0.0, -1.0330}, 1.0, 1.0);
  EXPECT_NEAR(y.scale_factor_error, -0.1908, 5e-5);  // printed: 0.0869 %
  const FourPointResult found = four_point({0.0, 0.58541, 0.0, -1.0330}, 1.0);
  EXPECT_NEAR(found.bias_up_down_mps2 * found.K1, -0.223795, 1e-12);  // printed: +22.38 mg
}

TEST(MultipointTumble, RecoversEveryCoefficient) {
  for (const int count : {8, 12, 24, 36}) {
    SCOPED_TRACE(count);
    const TableTruth truth;
    const TumbleFit fit = fitted(read_table(table_turn(count), truth));
    expect_truth(fit, truth, 1e-12);
    for (const Q quantity : {Q::K1, Q::K0, Q::misalignment, Q::K2_minus_Kpp, Q::Kip, Q::K3})
      EXPECT_TRUE(has(fit, quantity)) << name_of(quantity);
    EXPECT_NEAR(*fit.bias_output, truth.K1 * true_value(truth, Q::K0), 1e-14);
  }
}

TEST(MultipointTumble, NeedsNoEqualSteps) {
  std::vector<TumblePosition> plan;
  for (const double degrees : {3.0, 41.0, 77.0, 95.0, 140.0, 188.0, 201.0, 266.0, 300.0, 333.0})
    plan.push_back({.angle_rad = degrees * rad_per_deg});
  const TableTruth truth;
  expect_truth(fitted(read_table(plan, truth)), truth, 1e-11);
}

TEST(MultipointTumble, DoesNotMindTheOrderOfTheRowsWhereTheyHaveATime) {
  std::vector<TumblePosition> plan = table_turn(12, true);
  TableTruth truth;
  truth.drift_mps2 = 1e-3;
  std::vector<TumblePosition> positions = read_table(plan, truth);
  for (std::size_t k = 0; k < positions.size(); ++k)
    positions[k].time_s = 30.0 * static_cast<double>(k);
  const TumbleFit in_order = fitted(positions);
  std::reverse(positions.begin() + 2, positions.end());
  const TumbleFit shuffled = fitted(positions);
  EXPECT_NEAR(value(in_order, Q::K0), value(shuffled, Q::K0), 1e-12);
  EXPECT_NEAR(value(in_order, Q::drift), 1e-3 / 30.0, 1e-12);
  EXPECT_NEAR(value(shuffled, Q::drift), 1e-3 / 30.0, 1e-12);
}

TEST(MultipointTumble, GivesTheStandardDeviationsOfEqualSteps) {
  // Variance of an amplitude 2 s²/n, of B0 s²/n; of K1 therefore 2 s² (1 + 9)/n over g², and so on.
  std::vector<TumblePosition> positions = read_table(table_turn(24), {});
  constexpr double s = 1e-6;
  for (TumblePosition& p : positions) p.output_std = s;
  const TumbleFit fit = fitted(positions);
  const TableTruth truth;
  EXPECT_NEAR(*fit.find(Q::K1)->std, std::sqrt(20.0 / 24.0) * s / g, 1e-12);
  EXPECT_NEAR(*fit.find(Q::misalignment)->std, std::sqrt(2.0 / 24.0) * s / (truth.K1 * g), 1e-9);
  EXPECT_NEAR(*fit.find(Q::Kip)->std, 2.0 * std::sqrt(2.0 / 24.0) * s / (truth.K1 * g * g), 1e-10);
  EXPECT_NEAR(*fit.find(Q::K0)->std, std::sqrt(3.0 / 24.0) * s / truth.K1, 1e-9);
  EXPECT_NEAR(*fit.find(Q::K3)->std, 4.0 * std::sqrt(2.0 / 24.0) * s / (truth.K1 * g * g * g),
              1e-11);
}

TEST(TwoPlaneTumble, RecoversTheTermsOfBothPlanes) {
  std::vector<TumblePosition> plan = table_turn(12);
  append(plan, in_plane(table_turn(12), 2));
  const TableTruth truth;
  const TumbleFit fit = fitted(read_table(plan, truth));
  expect_truth(fit, truth, 1e-12);
  for (const Q quantity : {Q::K0_second, Q::misalignment_p, Q::K2_minus_Koo, Q::Kio})
    EXPECT_TRUE(has(fit, quantity)) << name_of(quantity);
}

TEST(SixPointTumble, DeterminesScaleBothMisalignmentsAndThreeBiases) {
  std::vector<TumblePosition> plan = table_turn(4);
  append(plan, in_plane(table_turn(2), 2));
  TableTruth truth;
  truth.K3 = 0.0;
  const TumbleFit fit = fitted(read_table(plan, truth));
  expect_truth(fit, truth, 1e-12);
  EXPECT_EQ(fit.parameters, 6U);
  EXPECT_TRUE(has(fit, Q::K0_second) && has(fit, Q::misalignment_p) && has(fit, Q::K0_up_down));
  EXPECT_FALSE(has(fit, Q::Kip) || has(fit, Q::Kio) || has(fit, Q::K3));
}

TEST(ForwardAndBackwardTumble, SeparatesHysteresisAndBacklash) {
  TableTruth truth;
  truth.hysteresis_mps2 = 2e-3;
  truth.backlash_rad = 1e-6;  // small, since it affects the other terms in second order
  truth.drift_mps2 = 1e-4;
  const TumbleFit fit = fitted(read_table(there_and_back(12), truth));
  expect_truth(fit, truth, 1e-8);
  EXPECT_TRUE(has(fit, Q::hysteresis) && has(fit, Q::backlash) && has(fit, Q::drift));
}

TEST(RemountedTumble, SeparatesErrorsOnceATurnFromTheBias) {
  TableTruth truth;
  truth.index_cos = 2e-6;
  truth.index_sin = -1e-6;
  const TumbleFit once = fitted(read_table(table_turn(12), truth));
  // Appears as K2 and K0 without the second mounting.
  EXPECT_NEAR(value(once, Q::K2_minus_Kpp), truth.K2 - truth.Kpp - 2e-6 / g, 1e-9);
  EXPECT_NEAR(value(once, Q::K0), true_value(truth, Q::K0) + 2e-6 * g, 1e-7);
  EXPECT_NEAR(value(once, Q::K0_up_down), true_value(truth, Q::K0_up_down), 1e-7);
  EXPECT_FALSE(once.indexing.once_separated);
  EXPECT_NE(once.indexing.words[0].find("would look like K2 − Kpp"), std::string::npos);

  std::vector<TumblePosition> plan = table_turn(12);
  append(plan, mounted_at(table_turn(12), 180.0));
  const TumbleFit twice = fitted(read_table(plan, truth));
  expect_truth(twice, truth, 1e-8);
  EXPECT_TRUE(twice.indexing.once_separated);
  EXPECT_FALSE(twice.indexing.twice_separated);
  EXPECT_NE(reason(twice, Q::indexing_cos2).find("90°"), std::string::npos);
}

TEST(RemountedTumble, SeparatesErrorsTwiceATurnWhenTurnedBy90) {
  TableTruth truth;
  truth.index_cos = 2e-6;
  truth.index_sin2 = 1e-6;
  truth.index_cos2 = -1e-6;
  const TumbleFit once = fitted(read_table(table_turn(12), truth));
  EXPECT_NEAR(value(once, Q::K1) / truth.K1 - 1.0, 2e-6, 1e-8);  // 2 b
  std::vector<TumblePosition> plan = table_turn(12);
  append(plan, mounted_at(table_turn(12), 180.0));
  append(plan, mounted_at(table_turn(12), 90.0));
  const TumbleFit fit = fitted(read_table(plan, truth));
  expect_truth(fit, truth, 1e-8);
  EXPECT_TRUE(fit.indexing.once_separated && fit.indexing.twice_separated);
}

TEST(TumbleDrift, IsTakenOutWhereAPositionIsVisitedAgain) {
  TableTruth truth;
  truth.drift_mps2 = 1e-3;
  const TumbleFit closed = fitted(read_table(table_turn(12, true), truth));
  expect_truth(closed, truth, 1e-12);
  EXPECT_TRUE(closed.drift.known && closed.drift.removed);
  const TumbleFit open = fitted(read_table(table_turn(12), truth));
  EXPECT_FALSE(open.drift.known);
  EXPECT_NE(open.drift.words.find("unknown"), std::string::npos);
  EXPECT_GT(std::abs(value(open, Q::misalignment) - truth.delta_o), 1e-5);
}

TEST(TumbleDrift, IsNotTakenOutOfFourPositionsThatHaveNoneToSpare) {
  TableTruth truth;
  truth.drift_mps2 = 1e-3;
  std::vector<TumblePosition> positions = read_table(table_turn(4, true), truth);
  const TumbleFit fit = fitted(positions);
  EXPECT_TRUE(fit.drift.known);
  EXPECT_FALSE(fit.drift.removed);
  EXPECT_NEAR(*fit.drift.rate_mps2, 1e-3, 1e-6);
  EXPECT_TRUE(fit.find(Q::K1)->std);
  for (TumblePosition& p : positions) p.output_std = 1e-6;
  EXPECT_TRUE(fitted(positions).drift.removed);
}

TEST(TumbleDrift, IsPrintedWithATrueMinusSign) {
  TableTruth truth;
  truth.drift_mps2 = -1e-3;
  std::mt19937_64 random(4);
  const std::string taken_out = fitted(read_table(table_turn(10, true), truth, random)).drift.words;
  EXPECT_TRUE(taken_out.starts_with("drift of −")) << taken_out;
  const std::string left_in = fitted(read_table(table_turn(4, true), truth, random)).drift.words;
  EXPECT_NE(left_in.find("a drift of −"), std::string::npos) << left_in;
}

TEST(TumbleDrift, SaysHowProbableItIsByChance) {
  TableTruth truth;
  truth.noise = 3e-6;
  std::mt19937_64 random(4);
  EXPECT_GT(*fitted(read_table(table_turn(24, true), truth, random)).drift.p, 0.05);
  truth.drift_mps2 = 1e-3;
  EXPECT_LT(*fitted(read_table(table_turn(24, true), truth, random)).drift.p, 1e-6);
}

TEST(Tumble, OmitsTermsThatFewPositionsDoNotDetermine) {
  const TableTruth truth;
  const auto at = [&](std::initializer_list<double> degrees) {
    std::vector<TumblePosition> plan;
    for (const double angle : degrees) plan.push_back({.angle_rad = angle * rad_per_deg});
    return read_table(plan, truth);
  };
  const TumbleFit two = fitted(at({90.0, 270.0}));
  EXPECT_TRUE(has(two, Q::K1) && has(two, Q::K0_up_down));
  EXPECT_FALSE(has(two, Q::K0) || has(two, Q::misalignment));
  EXPECT_FALSE(reason(two, Q::K0).empty());
  EXPECT_FALSE(two.find(Q::K1)->std);
  EXPECT_NE(two.find(Q::K1)->reason.find("no standard deviation"), std::string::npos);

  EXPECT_EQ(two.find(Q::K0_up_down)->meaning,
            "K0 + K2 g²: half the sum of the readings at +1 g and −1 g");

  // Horizontal and down: the result is a bias, but not that from up and down.
  const TumbleFit corner = fitted(at({180.0, 270.0}));
  EXPECT_EQ(corner.find(Q::K0_up_down)->meaning, "bias, K2 − Kpp and misalignment taken as 0");
  EXPECT_EQ(corner.find(Q::K1)->meaning, "scale factor K1, K3 and K2 − Kpp taken as 0");

  const TumbleFit five = fitted(at({0.0, 72.0, 144.0, 216.0, 288.0}));
  EXPECT_EQ(five.parameters, 4U);
  EXPECT_EQ(five.dof, 1U);
  EXPECT_NE(reason(five, Q::Kip).find("too few"), std::string::npos);

  const TumbleFit six = fitted(at({0.0, 60.0, 120.0, 180.0, 240.0, 300.0}));
  EXPECT_TRUE(has(six, Q::Kip));
  EXPECT_FALSE(has(six, Q::K3));  // sin 3φ is 0 in all positions
}

TEST(Tumble, RefusesPositionsWithoutInformation) {
  const TableTruth truth;
  const auto error = [&](std::vector<TumblePosition> plan) {
    return fit_tumble(read_table(std::move(plan), truth), table_options()).error();
  };
  EXPECT_EQ(error({{.angle_rad = 1.0}}).code, Errc::too_few_samples);
  EXPECT_EQ(error({}).code, Errc::too_few_samples);
  EXPECT_EQ(error(table_turn(5001)).code, Errc::invalid_argument);
  EXPECT_EQ(error({{.angle_rad = 0.0}, {.angle_rad = std::numbers::pi}}).code,
            Errc::not_observable);
  std::vector<TumblePosition> positions = read_table(table_turn(8), truth);
  positions[3].plane = 3;
  EXPECT_EQ(fit_tumble(positions, table_options()).error().code, Errc::invalid_argument);
  positions[3].plane = 1;
  positions[3].label = "line 5";
  positions[3].output = std::numeric_limits<double>::quiet_NaN();
  const Error missing = fit_tumble(positions, table_options()).error();
  EXPECT_EQ(missing.code, Errc::not_finite);
  EXPECT_NE(missing.message.find("line 5"), std::string::npos);
  for (TumblePosition& p : positions) p.output = 1.65;
  EXPECT_EQ(fit_tumble(positions, table_options()).error().code, Errc::not_observable);
}

TEST(Tumble, TakesAnAxisByItsPhase) {
  TumbleOptions options = table_options();
  const TableTruth truth;
  const TumbleFit sine = fitted(read_table(table_turn(12), truth), options);
  options.phase_rad = {0.5 * std::numbers::pi, 0.0};
  // The same outputs a quarter turn earlier.
  std::vector<TumblePosition> moved = read_table(table_turn(12), truth);
  for (TumblePosition& p : moved) p.angle_rad -= 0.5 * std::numbers::pi;
  const TumbleFit cosine = fitted(moved, options);
  EXPECT_NEAR(value(cosine, Q::K1), value(sine, Q::K1), 1e-15);
  EXPECT_NEAR(value(cosine, Q::Kip), value(sine, Q::Kip), 1e-12);
}

TEST(Tumble, SaysThatAnAxisFarFromTheNominalOneHasALargerScaleFactor) {
  std::vector<TumblePosition> positions = read_table(table_turn(24), TableTruth{});
  EXPECT_NEAR(fitted(positions).own_axis_ratio(), 1.0, 1e-3);
  for (TumblePosition& p : positions) p.angle_rad -= 0.35;
  const TumbleFit turned = fitted(positions);
  EXPECT_NEAR(value(turned, Q::K1) * turned.own_axis_ratio(), TableTruth{}.K1,
              1e-3 * TableTruth{}.K1);
  EXPECT_TRUE(std::ranges::any_of(turned.notes, [](const std::string& note) {
    return note.find("from the nominal one") != std::string::npos;
  }));
}

TEST(Tumble, KeepsItsFiguresBesideALargeZero) {
  TableTruth truth;
  truth.K1 = 4182.0;
  truth.K0 = 32768.0 / truth.K1;
  truth.K2 = truth.Kpp = 0.0;
  const TumbleFit fit = fitted(read_table(table_turn(12), truth));
  EXPECT_NEAR(value(fit, Q::K1), truth.K1, 1e-8);
  EXPECT_NEAR(*fit.bias_output, 32768.0, 1e-7);
  EXPECT_NEAR(value(fit, Q::Kip), truth.Kip, 1e-11);
}

TEST(Tumble, NamesThePositionThatContradictsTheOthers) {
  TableTruth truth;
  truth.noise = 3e-6;
  std::mt19937_64 random(8);
  std::vector<TumblePosition> positions = read_table(table_turn(24, true), truth, random);
  positions[7].output += 1e-4;
  positions[7].label = "line 9";
  const TumbleFit fit = fitted(positions);
  for (std::size_t k = 0; k < positions.size(); ++k)
    EXPECT_EQ(fit.positions[k].suspect, k == 7) << k;
  ASSERT_FALSE(fit.notes.empty());
  EXPECT_NE(fit.notes[0].find("line 9 at 105°"), std::string::npos);
}

TEST(Tumble, SeesACubicCrossAxisTermAsThirdCosine) {
  TableTruth truth;
  std::vector<TumblePosition> positions = read_table(table_turn(24), truth);
  constexpr double Kppp = 1e-5;  // coefficient of a_p³
  for (TumblePosition& p : positions)
    p.output += truth.K1 * Kppp * std::pow(g * std::cos(p.angle_rad), 3);
  const TumbleFit fit = fitted(positions);
  EXPECT_NEAR(value(fit, Q::third_cosine), 0.25 * Kppp * g * g * g, 1e-10);
  EXPECT_FALSE(fit.notes.empty());
}

TEST(Tumble, ComparesWithTheStatedNoiseAndWidensWhereItIsTooSmall) {
  TableTruth truth;
  truth.noise = 3e-6;
  std::mt19937_64 random(11);
  std::vector<TumblePosition> positions = read_table(table_turn(24, true), truth, random);
  for (TumblePosition& p : positions) p.output_std = 3e-6;
  const TumbleFit good = fitted(positions);
  EXPECT_EQ(good.lack_of_fit->against, "noise of the means");
  EXPECT_GT(good.lack_of_fit->p, 0.01);
  EXPECT_EQ(good.scatter, 1.0);
  for (TumblePosition& p : positions) p.output_std = 1e-6;
  const TumbleFit narrow = fitted(positions);
  EXPECT_LT(narrow.lack_of_fit->p, 0.01);
  EXPECT_NEAR(narrow.scatter, 3.0, 0.9);
  EXPECT_NEAR(*narrow.find(Q::K1)->std / *good.find(Q::K1)->std, narrow.scatter / 3.0, 1e-9);
}

TEST(Tumble, ComparesWithRepeatedPositionsWhereNoNoiseIsStated) {
  TableTruth truth;
  truth.noise = 3e-6;
  std::mt19937_64 random(12);
  std::vector<TumblePosition> plan = table_turn(12);
  for (int turn = 0; turn < 2; ++turn) append(plan, table_turn(12));
  std::vector<TumblePosition> positions = read_table(plan, truth, random);
  const TumbleFit good = fitted(positions);
  EXPECT_EQ(good.lack_of_fit->against, "repeated positions");
  EXPECT_GT(good.lack_of_fit->p, 0.01);
  for (TumblePosition& p : positions) p.output += 1e-4 * std::cos(5.0 * p.angle_rad);
  EXPECT_LT(fitted(positions).lack_of_fit->p, 1e-6);
}

TEST(Tumble, CountsGravityAndIndexingAsSharesOfTheirOwn) {
  std::vector<TumblePosition> positions = read_table(table_turn(12), {});
  for (TumblePosition& p : positions) p.output_std = 1e-7;
  TumbleOptions options = table_options();
  options.gravity_std_mps2 = 1e-3;
  options.indexing_std_rad = 1e-5;
  const TumbleFit fit = fitted(positions, options);
  ASSERT_EQ(fit.shares.size(), 3U);
  const auto share = [&](std::size_t k, Q quantity) {
    const auto i = static_cast<Eigen::Index>(*fit.place_of(quantity));
    return std::sqrt(fit.shares[k].covariance(i, i));
  };
  EXPECT_EQ(fit.shares[1].source, "indexing of the table");
  EXPECT_EQ(fit.shares[2].source, "gravity");
  const TableTruth truth;
  EXPECT_NEAR(share(2, Q::K1), truth.K1 * 1e-3 / g, 1e-12);
  EXPECT_NEAR(share(2, Q::K0), true_value(truth, Q::K0) * 1e-3 / g, 1e-12);
  EXPECT_NEAR(share(2, Q::misalignment), 0.0, 1e-15);
  // δ = Σ 2 cos φ E/(n K1 g): 2/n √(Σ cos⁴ φ) u = √(3/(2n)) u.
  EXPECT_NEAR(share(1, Q::misalignment), std::sqrt(1.5 / 12.0) * 1e-5, 1e-9);
  Eigen::MatrixXd sum = fit.shares[0].covariance;
  for (std::size_t k = 1; k < 3; ++k) sum += fit.shares[k].covariance;
  EXPECT_NEAR((sum - fit.covariance).norm(), 0.0, 1e-20);
}

}  // namespace
}  // namespace proofmass::calibrate::tumble_test
