#include "proofmass/calibrate/uncertainty/type_b.hpp"

#include <cmath>
#include <gtest/gtest.h>

#include "proofmass/core/units.hpp"

namespace proofmass::calibrate::type_b_test {
namespace {

constexpr double g = standard_gravity_mps2;

TEST(TypeBText, OfAUniformWidthIsItsStandardDeviation) {
  const TypeB line = parse_type_b("ADC reference, scale, 0.05 %, uniform").value();
  EXPECT_EQ(line.source, "ADC reference");
  EXPECT_EQ(line.target, TypeBTarget::scale);
  EXPECT_FALSE(line.axis);
  EXPECT_TRUE(line.common);
  EXPECT_EQ(line.distribution, Distribution::uniform);
  EXPECT_DOUBLE_EQ(line.std, 5e-4 / std::sqrt(3.0));
  EXPECT_EQ(line.unit, "1");
  EXPECT_EQ(line.dof, 0.0);
}

TEST(TypeBText, WithoutADistributionIsAStandardDeviation) {
  const TypeB line = parse_type_b("drift,bias.z,0.3mg").value();
  EXPECT_EQ(line.axis, 2U);
  EXPECT_FALSE(line.common);
  EXPECT_EQ(line.distribution, Distribution::normal);
  EXPECT_DOUBLE_EQ(line.std, 0.3e-3 * g);
  EXPECT_EQ(line.unit, "m/s^2");
}

TEST(TypeBText, TakesATemperatureTimesItsCoefficient) {
  const TypeB line = parse_type_b("temperature, bias, 2 K * 1 mg/K, rectangular").value();
  EXPECT_DOUBLE_EQ(line.std, 2e-3 * g / std::sqrt(3.0));
  EXPECT_DOUBLE_EQ(parse_type_b("temperature,scale,5 K x 0.01 %/K").value().std, 5e-4);
  EXPECT_DOUBLE_EQ(parse_type_b("temperature,bias,2 K × 3 counts/K").value().std, 6.0);
}

TEST(TypeBText, TakesDegreesOfFreedomAndAnyCase) {
  const TypeB line = parse_type_b("gravity, GRAVITY, 1e-4 m/s^2, Student-T, 6").value();
  EXPECT_EQ(line.target, TypeBTarget::gravity);
  EXPECT_TRUE(line.common);
  EXPECT_EQ(line.distribution, Distribution::student_t);
  EXPECT_EQ(line.dof, 6.0);
  EXPECT_EQ(parse_type_b("indexing,angle,0.01 deg,triangular").value().target, TypeBTarget::angle);
  EXPECT_EQ(parse_type_b("table,k0.X,1 mV").value().axis, 0U);
  EXPECT_EQ(parse_type_b("noise,K1,1e-3 V/g,normal,12").value().dof, 12.0);
}

TEST(TypeBText, SaysInOneLineWhatWasExpected) {
  const auto message = [](const char* text) {
    const auto line = parse_type_b(text);
    EXPECT_FALSE(line) << text;
    EXPECT_EQ(line.error().code, Errc::invalid_argument);
    EXPECT_EQ(line.error().message.find('\n'), std::string::npos);
    return line.error().message;
  };
  const auto says = [&](const char* text, const char* what) {
    const std::string found = message(text);
    EXPECT_NE(found.find(what), std::string::npos) << found;
  };
  says("", "NAME,TARGET,VALUE UNIT");
  says("noise,bias", "NAME,TARGET,VALUE UNIT");
  says(",bias,1 mg", "NAME,TARGET,VALUE UNIT");
  says("a,bias,1 mg,normal,3,4", "NAME,TARGET,VALUE UNIT");
  says("a,offset,1 mg", "expected bias, scale, misalignment");
  says("a,bias.w,1 mg", "with .x, .y or .z");
  says("a,bias,1", "a unit of bias (\"mg\")");
  says("a,scale,1 mg", "a unit of scale (\"%\")");
  says("a,bias,one mg", "a number above 0");
  says("a,bias,-1 mg", "a number above 0");
  says("a,bias,0 mg", "a number above 0");
  says("a,bias,nan mg", "a number above 0");
  says("a,bias,1e999 mg", "a number above 0");
  says("temperature,bias,2 K", "a unit of bias");
  says("temperature,bias,2 K * 1 mg", "2 K * 1 mg/K");
  says("temperature,bias,2 V * 1 mg/K", "2 K * 1 mg/K");
  says("a,bias,1 mg,square", "student-t");
  says("a,bias,1 mg,student-t", "the degrees of freedom after student-t");
  says("a,bias,1 mg,normal,0.5", "degrees of freedom of 1 or more");
  says("a,bias,1 mg,normal,ten", "degrees of freedom of 1 or more");
}

TEST(LineOf, TurnsItsUnitIntoTheParameters) {
  const ParameterUnit volts{"V", 0.03};
  const auto sensitivity = [&](const char* text) {
    return line_of(parse_type_b(text).value(), volts).value().sensitivity;
  };
  EXPECT_EQ(sensitivity("a,bias,1 mV"), 1.0);
  EXPECT_EQ(sensitivity("a,bias,1 mg"), 0.03);
  EXPECT_EQ(sensitivity("a,K0,1 mg"), 1.0);
  EXPECT_DOUBLE_EQ(sensitivity("a,K0,1 mV"), 1.0 / 0.03);
  EXPECT_EQ(sensitivity("a,scale,1 %"), 0.03);
  EXPECT_EQ(sensitivity("a,K1,1 mV/g"), 1.0);
  EXPECT_EQ(sensitivity("a,misalignment,1 mrad"), 1.0);
}

TEST(LineOf, RefusesAUnitOfAnotherReading) {
  const auto error = line_of(parse_type_b("adc,bias,2 counts").value(), {"V", 0.03}).error();
  EXPECT_EQ(error.message, "adc: a contribution to bias in counts does not go with readings in V");
  EXPECT_FALSE(line_of(parse_type_b("adc,scale,2 counts/g").value(), {"V", 0.03}));
  EXPECT_FALSE(line_of(parse_type_b("adc,K0,2 counts").value(), {"V", 0.03}));
  EXPECT_FALSE(line_of(parse_type_b("adc,scale,2 %").value(), {"V", 0.0}));
}

}  // namespace
}  // namespace proofmass::calibrate::type_b_test
