#include <cmath>
#include <gtest/gtest.h>

#include "proofmass/io/tdms/scale.hpp"
#include "proofmass/io/tdms/tdms_test_support.hpp"
#include "proofmass/io/tdms/thermocouple.hpp"

namespace proofmass::io::tdms::scaling_test {
namespace {

using namespace specimen;

/// Properties of a channel.
struct ScaleProperties {
  Properties properties;

  ScaleProperties& set(const std::string& name, double value) {
    properties[name] = value;
    return *this;
  }
  ScaleProperties& kind(const std::string& value) {
    properties["NI_Scale[0]_Scale_Type"] = value;
    return *this;
  }
  [[nodiscard]] double of(double x) const {
    const auto scale = read_scale(properties, 0);
    EXPECT_TRUE(scale.has_value()) << (scale ? "" : scale.error().message);
    double y = 0.0;
    if (scale) apply_scale(*scale, {&x, 1}, {&x, 1}, {&y, 1});
    return y;
  }
};

Read scaled(TdmsList& list, const std::vector<double>& values) {
  return tdms_or_fail(tdms_segment(tdms_whole, list.bytes(), bytes_of(values)));
}

TdmsList one_channel(std::uint64_t values) {
  TdmsList list;
  list.no_values("/").no_values("/'g'").channel("/'g'/'a'", f64, values);
  return list;
}

TEST(Scaling, ALinearScaleIsAppliedAndTold) {
  TdmsList list = one_channel(3);
  list.property("NI_Number_Of_Scales", 1U)
      .property("NI_Scaling_Status", "unscaled")
      .property("NI_Scale[0]_Scale_Type", "Linear")
      .property("NI_Scale[0]_Linear_Slope", 2.0)
      .property("NI_Scale[0]_Linear_Y_Intercept", 10.0)
      .property("unit_string", "g");
  const auto read = scaled(list, {1, 2, 3});
  EXPECT_EQ(read.columns[0], (std::vector<double>{12, 14, 16}));
  EXPECT_EQ(read.head.headings[0], "a (g)");
  EXPECT_TRUE(read.is_noted("a: scaled as the file says: linear 2 x + 10")) << read.all_notes();
}

TEST(Scaling, WhatIsScaledAlreadyIsLeftAlone) {
  TdmsList list = one_channel(1);
  list.property("NI_Number_Of_Scales", 1U)
      .property("NI_Scaling_Status", "scaled")
      .property("NI_Scale[0]_Scale_Type", "Linear")
      .property("NI_Scale[0]_Linear_Slope", 2.0)
      .property("NI_Scale[0]_Linear_Y_Intercept", 10.0);
  EXPECT_EQ(scaled(list, {1}).columns[0], (std::vector<double>{1}));
}

TEST(Scaling, AGroupOrTheFileMaySayIt) {
  for (const bool by_group : {false, true}) {
    TdmsList list;
    list.no_values(by_group ? "/'g'" : "/")
        .property("NI_Number_Of_Scales", 1U)
        .property("NI_Scale[0]_Scale_Type", "Linear")
        .property("NI_Scale[0]_Linear_Slope", -1.0)
        .property("NI_Scale[0]_Linear_Y_Intercept", 0.0);
    list.channel("/'g'/'a'", f64, 1);
    EXPECT_EQ(scaled(list, {7}).columns[0], (std::vector<double>{-7}));
  }
}

TEST(Scaling, ChainsAreFollowedFromTheLastScaleToTheStoredValues) {
  TdmsList list = one_channel(3);
  list.property("NI_Number_Of_Scales", 3U);
  for (std::uint32_t i = 0; i < 3; ++i) {
    const std::string prefix = "NI_Scale[" + std::to_string(i) + "]_";
    list.property(prefix + "Scale_Type", "Linear")
        .property(prefix + "Linear_Slope", i + 1.0)
        .property(prefix + "Linear_Y_Intercept", i + 1.0)
        .property(prefix + "Linear_Input_Source", i == 0 ? 0xFFFFFFFFU : i - 1);
  }
  // 3 (2 (x + 1) + 2) + 3
  EXPECT_EQ(scaled(list, {1, 2, 3}).columns[0], (std::vector<double>{21, 27, 33}));
}

TEST(Scaling, WhatCannotBeComputedLeavesTheStoredValuesWithoutUnit) {
  for (const char* kind : {"Logarithm", "RTD", "Polynomial"}) {
    TdmsList list = one_channel(2);
    list.property("NI_Number_Of_Scales", 1U)
        .property("NI_Scale[0]_Scale_Type", kind)
        .property("unit_string", "g");
    const auto read = scaled(list, {1, 2});
    EXPECT_EQ(read.columns[0], (std::vector<double>{1, 2}));
    EXPECT_EQ(read.head.headings[0], "a");
    EXPECT_TRUE(read.is_noted("cannot be computed")) << read.all_notes();
  }
}

TEST(Scaling, ACircleOfScalesIsNoChain) {
  TdmsList list = one_channel(1);
  list.property("NI_Number_Of_Scales", 2U);
  for (std::uint32_t i = 0; i < 2; ++i) {
    const std::string prefix = "NI_Scale[" + std::to_string(i) + "]_";
    list.property(prefix + "Scale_Type", "Add")
        .property(prefix + "Add_Left_Operand_Input_Source", 1 - i)
        .property(prefix + "Add_Right_Operand_Input_Source", 1 - i);
  }
  EXPECT_TRUE(scaled(list, {1}).is_noted("circle"));
}

TEST(Scaling, SumsOfSumsAreComputedOnce) {
  // 2^60 additions if each were evaluated separately.
  TdmsList list = one_channel(1);
  list.property("NI_Number_Of_Scales", 60U);
  for (std::uint32_t i = 0; i < 60; ++i) {
    const std::string prefix = "NI_Scale[" + std::to_string(i) + "]_";
    list.property(prefix + "Scale_Type", "Add")
        .property(prefix + "Add_Left_Operand_Input_Source", i == 0 ? 0xFFFFFFFFU : i - 1)
        .property(prefix + "Add_Right_Operand_Input_Source", i == 0 ? 0xFFFFFFFFU : i - 1);
  }
  EXPECT_EQ(scaled(list, {1}).columns[0], (std::vector<double>{0x1p60}));
}

TEST(Scaling, PolynomialsHaveFourCoefficientsIfNothingSaysOtherwise) {
  ScaleProperties scale;
  scale.kind("Polynomial");
  for (int i = 0; i < 4; ++i)
    scale.set("NI_Scale[0]_Polynomial_Coefficients[" + std::to_string(i) + "]", i + 1.0);
  EXPECT_DOUBLE_EQ(scale.of(2.0), 1 + 2 * 2 + 3 * 4 + 4 * 8);
  scale.set("NI_Scale[0]_Polynomial_Coefficients_Size", 2);
  EXPECT_DOUBLE_EQ(scale.of(2.0), 5.0);
  scale.set("NI_Scale[0]_Polynomial_Coefficients_Size", 0);
  EXPECT_EQ(scale.of(2.0), 0.0);
}

TEST(Scaling, TablesAreInterpolatedAndEndFlat) {
  for (const bool descending : {false, true}) {
    ScaleProperties scale;
    scale.kind("Table");
    scale.set("NI_Scale[0]_Table_Scaled_Values_Size", 3);
    scale.set("NI_Scale[0]_Table_Pre_Scaled_Values_Size", 3);
    const double x[] = {1, 2, 3};
    const double y[] = {2, 4, 8};
    for (int i = 0; i < 3; ++i) {
      const int from = descending ? 2 - i : i;
      scale.set("NI_Scale[0]_Table_Scaled_Values[" + std::to_string(i) + "]", x[from]);
      scale.set("NI_Scale[0]_Table_Pre_Scaled_Values[" + std::to_string(i) + "]", y[from]);
    }
    EXPECT_EQ(scale.of(0.5), 2.0);
    EXPECT_EQ(scale.of(1.5), 3.0);
    EXPECT_EQ(scale.of(2.5), 6.0);
    EXPECT_EQ(scale.of(3.5), 8.0);
    EXPECT_TRUE(std::isnan(scale.of(std::nan(""))));
  }
}

ScaleProperties platinum(double lead_ohm, double wires) {
  ScaleProperties scale;
  scale.kind("RTD")
      .set("NI_Scale[0]_RTD_Current_Excitation", 1e-3)
      .set("NI_Scale[0]_RTD_R0_Nominal_Resistance", 100.0)
      .set("NI_Scale[0]_RTD_A", 3.9083e-3)
      .set("NI_Scale[0]_RTD_B", -5.775e-7)
      .set("NI_Scale[0]_RTD_C", -4.183e-12)
      .set("NI_Scale[0]_RTD_Lead_Wire_Resistance", lead_ohm)
      .set("NI_Scale[0]_RTD_Resistance_Configuration", wires);
  return scale;
}

TEST(Scaling, PlatinumThermometersAreThoseOfIec60751) {
  // Resistances in the standard's table 1 are rounded to 0.01 ohm, 0.026 K.
  const ScaleProperties scale = platinum(0.0, 2);
  EXPECT_NEAR(scale.of(18.52e-3), -200.0, 0.02);
  EXPECT_NEAR(scale.of(60.26e-3), -100.0, 0.02);
  EXPECT_NEAR(scale.of(100.00e-3), 0.0, 1e-9);
  EXPECT_NEAR(scale.of(138.51e-3), 100.0, 0.02);
  EXPECT_NEAR(scale.of(313.71e-3), 600.0, 0.02);
}

TEST(Scaling, PlatinumThermometersInvertTheirOwnEquation) {
  const ScaleProperties scale = platinum(0.0, 2);
  for (double t = -200.0; t <= 850.0; t += 12.5) {
    const double below = t < 0.0 ? -4.183e-12 * (t - 100.0) * t * t * t : 0.0;
    const double ohm = 100.0 * (1.0 + 3.9083e-3 * t - 5.775e-7 * t * t + below);
    EXPECT_NEAR(scale.of(1e-3 * ohm), t, 1e-9);
  }
}

TEST(Scaling, LeadsCountAsOftenAsTheyAreMeasuredAlong) {
  const double bare = platinum(0.0, 2).of(0.12);
  EXPECT_NEAR(platinum(5.0, 2).of(0.13), bare, 1e-9);
  EXPECT_NEAR(platinum(5.0, 3).of(0.125), bare, 1e-9);
  EXPECT_NEAR(platinum(5.0, 4).of(0.12), bare, 1e-9);
}

/// Voltage over excitation of a bridge with resistors 1 and 2 in the left arm and 3 and 4 in the
/// right one, in National Instruments' numbering.
double bridge(double r1, double r2, double r3, double r4) {
  return r3 / (r3 + r4) - r2 / (r1 + r2);
}

TEST(Scaling, StrainIsWhatTheBridgesResistorsSay) {
  constexpr double factor = 2.1;
  constexpr double nu = 0.3;
  constexpr double excitation_volt = 2.5;
  constexpr double zero_V = 3e-4;
  for (const double strain : {-2e-3, 1e-5, 3e-3}) {
    const double up = 1.0 + factor * strain;
    const double down = 1.0 - factor * strain;
    const double across = 1.0 - nu * factor * strain;
    const double across_down = 1.0 + nu * factor * strain;
    const std::vector<std::pair<double, double>> cases{
        {10183, bridge(down, up, down, up)},
        {10184, bridge(across, across_down, down, up)},
        {10185, bridge(across, up, across, up)},
        {10188, bridge(1, 1, across, up)},
        {10189, bridge(1, 1, down, up)},
        {10271, bridge(1, 1, 1, up)},
        {10272, bridge(1, 1, 1, up)},
    };
    for (const auto& [configuration, ratio] : cases) {
      ScaleProperties scale;
      scale.kind("Strain")
          .set("NI_Scale[0]_Strain_Configuration", configuration)
          .set("NI_Scale[0]_Strain_Poisson_Ratio", nu)
          .set("NI_Scale[0]_Strain_Gage_Resistance", 350.0)
          .set("NI_Scale[0]_Strain_Lead_Wire_Resistance", 0.0)
          .set("NI_Scale[0]_Strain_Initial_Bridge_Voltage", zero_V)
          .set("NI_Scale[0]_Strain_Gage_Factor", factor)
          .set("NI_Scale[0]_Strain_Voltage_Excitation", excitation_volt);
      EXPECT_NEAR(scale.of(excitation_volt * ratio + zero_V), strain, 1e-12) << configuration;
    }
  }
}

TEST(Scaling, ThermistorsFollowSteinhartAndHart) {
  for (const bool is_divider : {false, true}) {
    ScaleProperties scale;
    scale.kind("Thermistor")
        .set("NI_Scale[0]_Thermistor_Resistance_Configuration", 4)
        .set("NI_Scale[0]_Thermistor_Excitation_Type", is_divider ? 10322 : 10134)
        .set("NI_Scale[0]_Thermistor_Excitation_Value", is_divider ? 2.5 : 1e-3)
        .set("NI_Scale[0]_Thermistor_R1_Reference_Resistance", 5000.0)
        .set("NI_Scale[0]_Thermistor_Lead_Wire_Resistance", 10.0)
        .set("NI_Scale[0]_Thermistor_A", 1.2873851e-3)
        .set("NI_Scale[0]_Thermistor_B", 2.3575235e-4)
        .set("NI_Scale[0]_Thermistor_C", 9.497806e-8)
        .set("NI_Scale[0]_Thermistor_Temperature_Offset", 273.15);
    const double ohm = 4000.0;
    const double volts = is_divider ? 2.5 * ohm / (ohm + 5000.0) : 1e-3 * ohm;
    const double r = std::log(ohm);
    const double kelvin = 1.0 / (1.2873851e-3 + 2.3575235e-4 * r + 9.497806e-8 * r * r * r);
    EXPECT_NEAR(scale.of(volts), kelvin - 273.15, 1e-9);
  }
}

TEST(Scaling, ThermocouplesHaveTheVoltagesOfTheTablesOfIts90) {
  struct Row {
    char type;
    double degC;
    double mV;
  };
  // Source: NIST Monograph 175, tables to the microvolt.
  for (const auto& [type, degC, mV] :
       {Row{'B', 1000, 4.834}, Row{'E', 100, 6.319}, Row{'E', 400, 28.946}, Row{'J', 100, 5.269},
        Row{'J', 1000, 57.953}, Row{'K', 100, 4.096}, Row{'K', 1000, 41.276},
        Row{'K', -100, -3.554}, Row{'N', 100, 2.774}, Row{'N', 1000, 36.256}, Row{'R', 100, 0.647},
        Row{'R', 1000, 10.506}, Row{'S', 100, 0.646}, Row{'S', 1000, 9.587}, Row{'T', 100, 4.279},
        Row{'T', -100, -3.379}})
    EXPECT_NEAR(thermocouple_mv(type, degC), mV, 6e-4) << type << degC;
}

TEST(Scaling, ThermocouplesInvertToASixteenthOfADegree) {
  struct Range {
    char type;
    double from_degC, to_degC;
  };
  for (const auto& [type, from, to] :
       {Range{'B', 251, 1819}, Range{'E', -200, 1000}, Range{'J', -209, 1199},
        Range{'K', -199, 1371}, Range{'N', -199, 1300}, Range{'R', -49, 1768},
        Range{'S', -49, 1768}, Range{'T', -200, 400}})
    for (double t = from; t <= to; t += 0.5)
      ASSERT_NEAR(thermocouple_degc(type, thermocouple_mv(type, t)), t, 0.06) << type << t;
  EXPECT_TRUE(std::isnan(thermocouple_degc('K', 60.0)));
  EXPECT_TRUE(std::isnan(thermocouple_mv('T', 401.0)));
}

TEST(Scaling, AThermocouplesChainAddsTheColdJunction) {
  // Microvolts and the junction's temperature, as stored by a task of NI-DAQmx.
  TdmsList list;
  list.daqmx("/'g'/'T'", 2, {list.scaler(9, 0, 0, 0), list.scaler(9, 0, 8, 1)}, {16});
  list.property("NI_Number_Of_Scales", 5U)
      .property("NI_Scale[2]_Scale_Type", "Thermocouple")
      .property("NI_Scale[2]_Thermocouple_Thermocouple_Type", 10073U)
      .property("NI_Scale[2]_Thermocouple_Scaling_Direction", 1U)
      .property("NI_Scale[2]_Thermocouple_Input_Source", 1U)
      .property("NI_Scale[3]_Scale_Type", "Add")
      .property("NI_Scale[3]_Add_Left_Operand_Input_Source", 0U)
      .property("NI_Scale[3]_Add_Right_Operand_Input_Source", 2U)
      .property("NI_Scale[4]_Scale_Type", "Thermocouple")
      .property("NI_Scale[4]_Thermocouple_Thermocouple_Type", 10073U)
      .property("NI_Scale[4]_Thermocouple_Scaling_Direction", 0U)
      .property("NI_Scale[4]_Thermocouple_Input_Source", 3U);
  const double uV = 1e3 * (thermocouple_mv('K', 150.0) - thermocouple_mv('K', 23.0));
  const auto read = tdms_or_fail(
      tdms_segment(tdms_whole | tdms_daqmx, list.bytes(), bytes_of<double>({uV, 23.0, 0.0, 20.0})));
  EXPECT_NEAR(read.columns[0][0], 150.0, 0.06);
  EXPECT_NEAR(read.columns[0][1], 20.0, 0.06);
}

}  // namespace
}  // namespace proofmass::io::tdms::scaling_test
