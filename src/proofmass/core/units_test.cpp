#include "proofmass/core/units.hpp"

#include <gtest/gtest.h>

namespace proofmass::units_test {
namespace {

TEST(ParseUnit, KnowsTheSpellingsOfHeaders) {
  for (const char* text :
       {"m/s^2", "m/s²", "(m/s2)", "[mps2]", " m/s^2 ", "m/s**2", "M/S^2", "m·s⁻²"})
    EXPECT_EQ(parse_unit(text).value().symbol, "m/s^2") << text;
  for (const char* text : {"µs", "μs", "us", "\xB5s", "usec"})
    EXPECT_DOUBLE_EQ(parse_unit(text).value().to_si, 1e-6) << text;
  for (const char* text : {"deg/s", "°/s", "dps"})
    EXPECT_EQ(parse_unit(text).value().quantity, Quantity::angular_rate) << text;
  EXPECT_EQ(parse_unit("counts").value().quantity, Quantity::counts);
  EXPECT_EQ(parse_unit("Volts").value().symbol, "V");
}

TEST(ParseUnit, TellsMilliGFromGauss) {
  EXPECT_DOUBLE_EQ(parse_unit("mg").value().si(1.0), 9.80665e-3);
  EXPECT_DOUBLE_EQ(parse_unit("g").value().si(1.0), 9.80665);
  EXPECT_EQ(parse_unit("G").value().quantity, Quantity::magnetic_field);
}

TEST(ParseUnit, TurnsCelsiusIntoKelvin) {
  EXPECT_DOUBLE_EQ(parse_unit("°C").value().si(25.0), 298.15);
  EXPECT_NEAR(parse_unit("degF").value().si(32.0), 273.15, 1e-9);
}

TEST(ParseUnit, RefusesWhatItDoesNotKnow) {
  for (const char* text : {"", "()", "furlong", "xyz", "S"}) EXPECT_FALSE(parse_unit(text)) << text;
}

}  // namespace
}  // namespace proofmass::units_test
