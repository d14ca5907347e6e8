#include "proofmass/sensor/model_equation.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <set>
#include <string>

#include "proofmass/core/units.hpp"

namespace proofmass::sensor::model_equation_test {
namespace {

constexpr double g = standard_gravity_mps2;

constexpr Motion busy{.ai_mps2 = -7.0,
                      .ap_mps2 = 3.0,
                      .ao_mps2 = -2.0,
                      .omega_i_radps = 0.5,
                      .omega_p_radps = -4.0,
                      .omega_dot_o_radps2 = 6.0};

TEST(ModelEquation, OfTheIdealSensorIsTheAccelerationAlongItsInputAxis) {
  EXPECT_EQ(output({}, busy), -7.0);
}

TEST(ModelEquation, ScalesWhateverStandsInTheBracket) {
  ModelEquation equation{.K0 = 0.2, .K2 = 1e-3, .delta_p = 0.01};
  const double bracket = output(equation, busy);
  equation.K1 = 0.0336;
  EXPECT_DOUBLE_EQ(output(equation, busy), 0.0336 * bracket);
}

// Every term written out as in the standard.
TEST(ModelEquation, IsTheStandardsWithAllSixteenCoefficients) {
  const ModelEquation c{.K1 = 2.0,
                        .K0 = 0.1,
                        .K0_asym = 0.02,
                        .K1_asym = 0.003,
                        .Koq = 4e-3,
                        .K2 = 5e-3,
                        .K3 = 6e-4,
                        .delta_o = 0.07,
                        .delta_p = 0.08,
                        .Kip = 9e-3,
                        .Kio = 1.1e-2,
                        .Kpo = 1.2e-2,
                        .Kpp = 1.3e-2,
                        .Koo = 1.4e-2,
                        .Kspin = 0.15,
                        .Kang = 0.16};
  const double i = -7.0, p = 3.0, o = -2.0;
  const double expected =
      2.0 * (0.1 - 0.02 / 2.0 + (1.0 - 0.003 / 2.0) * i + 4e-3 * i * 7.0 + 5e-3 * i * i +
             6e-4 * i * i * i + 0.07 * p - 0.08 * o + 9e-3 * i * p + 1.1e-2 * i * o +
             1.2e-2 * p * o + 1.3e-2 * p * p + 1.4e-2 * o * o + 0.15 * 0.5 * -4.0 + 0.16 * 6.0);
  EXPECT_NEAR(output(c, busy), expected, 1e-13);
}

TEST(ModelEquation, HasNoAsymmetryWhereNothingPullsAlongTheInputAxis) {
  EXPECT_EQ(output({.K0_asym = 1.0, .K1_asym = 1.0}, {.ap_mps2 = g}), 0.0);
}

// sin θ along the input axis, cos θ along the pendulous axis: the harmonics of methods/calibration.
TEST(ModelEquation, TumbledAboutTheOutputAxisHasTheHarmonicsOfTheTumbleTest) {
  const ModelEquation c{.K0 = 0.3, .K2 = 2e-3, .K3 = 1e-4, .delta_o = 0.01, .Kpp = 5e-4};
  for (const double theta : {0.0, 0.7, 2.0, 4.5}) {
    const double harmonics = c.K0 + (c.K2 + c.Kpp) / 2.0 * g * g + g * c.delta_o * std::cos(theta) +
                             (g + 0.75 * c.K3 * g * g * g) * std::sin(theta) -
                             (c.K2 - c.Kpp) / 2.0 * g * g * std::cos(2.0 * theta) -
                             c.K3 * g * g * g / 4.0 * std::sin(3.0 * theta);
    const Motion pose{.ai_mps2 = g * std::sin(theta), .ap_mps2 = g * std::cos(theta)};
    EXPECT_NEAR(output(c, pose), harmonics, 1e-12) << theta;
  }
}

TEST(Coefficients, AreListedInTheirOwnOrderUnderDifferentNames) {
  std::set<std::string> names, symbols;
  for (std::size_t k = 0; k < coefficient_count; ++k) {
    const CoefficientInfo& one = coefficients()[k];
    EXPECT_EQ(static_cast<std::size_t>(one.coefficient), k);
    EXPECT_EQ(&info(one.coefficient), &one);
    names.emplace(one.name);
    symbols.emplace(one.symbol);
    EXPECT_FALSE(one.description.empty());
  }
  EXPECT_EQ(names.size(), coefficient_count);
  EXPECT_EQ(symbols.size(), coefficient_count);
}

// Each column of the design is the derivative with respect to the listed member.
TEST(Coefficients, HaveTheTermThatTheOutputChangesByWithTheirMember) {
  for (const CoefficientInfo& one : coefficients()) {
    ModelEquation with;
    with.*one.member += 1.0;
    EXPECT_DOUBLE_EQ(output(with, busy) - output({}, busy), term(one.coefficient, busy))
        << one.name;
  }
}

TEST(Coefficients, AreFoundByNameInAnyCaseAndWithThePrimesOfTheStandard) {
  EXPECT_EQ(coefficient_named("K2"), Coefficient::K2);
  EXPECT_EQ(coefficient_named("kPP"), Coefficient::Kpp);
  EXPECT_EQ(coefficient_named("Delta_O"), Coefficient::delta_o);
  EXPECT_EQ(coefficient_named("K0'"), Coefficient::K0_asym);
  EXPECT_EQ(coefficient_named("k1'"), Coefficient::K1_asym);
  EXPECT_EQ(coefficient_named("K4"), std::nullopt);
  EXPECT_EQ(coefficient_named(""), std::nullopt);
}

// The same output in both systems of units.
TEST(Coefficients, SayTheSameInTheUnitsOfTheStandard) {
  for (const CoefficientInfo& one : coefficients()) {
    ModelEquation si{.K1 = 3.0}, standard{.K1 = 3.0 * g};
    if (one.coefficient != Coefficient::K1) {
      si.*one.member = 0.01;
      standard.*one.member = in_standard_unit(one.coefficient, 0.01);
    }
    Motion in_g = busy;
    for (double* a : {&in_g.ai_mps2, &in_g.ap_mps2, &in_g.ao_mps2}) *a /= g;
    EXPECT_NEAR(output(standard, in_g), output(si, busy), 1e-12) << one.name;
  }
  EXPECT_DOUBLE_EQ(in_standard_unit(Coefficient::K1, 1.0 / g), 1.0);
}

}  // namespace
}  // namespace proofmass::sensor::model_equation_test
