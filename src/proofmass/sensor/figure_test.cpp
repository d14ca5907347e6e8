#include "proofmass/sensor/figure.hpp"

#include <gtest/gtest.h>
#include <string>
#include <tuple>

#include "proofmass/core/units.hpp"

namespace proofmass::sensor::figure_test {
namespace {

constexpr double g = standard_gravity_mps2;

TEST(FigureUnit, ReadsWhatSensorsAreDescribedIn) {
  using Row = std::tuple<const char*, const char*, double>;
  for (const auto& [text, si, to_si] : {Row{"", "1", 1.0},
                                        {"1", "1", 1.0},
                                        {"%", "1", 0.01},
                                        {"ppm", "1", 1e-6},
                                        {"Hz", "Hz", 1.0},
                                        {"kHz", "Hz", 1e3},
                                        {"mg", "m/s^2", 1e-3 * g},
                                        {"mV", "V", 1e-3},
                                        {"counts", "counts", 1.0},
                                        {"deg", "rad", rad_per_deg},
                                        {"m/s", "m/s", 1.0},
                                        {"m/s^2/sqrt(Hz)", "m/s^2/sqrt(Hz)", 1.0},
                                        {"ug/rtHz", "m/s^2/sqrt(Hz)", 1e-6 * g},
                                        {"µg/√Hz", "m/s^2/sqrt(Hz)", 1e-6 * g},
                                        {"m/s^2/sqrt(s)", "m/s^2/sqrt(s)", 1.0},
                                        {"m/s^3/sqrt(Hz)", "m/s^2/sqrt(s)", 1.0},
                                        {"m/s^3", "m/s^3", 1.0},
                                        {"mg/h", "m/s^3", 1e-3 * g / 3600.0},
                                        {"V/(m/s^2)", "V/(m/s^2)", 1.0},
                                        {"mV/g", "V/(m/s^2)", 1e-3 / g},
                                        {"counts/(m/s^2)", "counts/(m/s^2)", 1.0},
                                        {"LSB/mg", "counts/(m/s^2)", 1e3 / g}}) {
    const auto unit = parse_figure_unit(text);
    ASSERT_TRUE(unit) << text;
    EXPECT_EQ(unit->si_symbol, si) << text;
    EXPECT_NEAR(unit->to_si, to_si, 1e-12 * to_si) << text;
  }
}

TEST(FigureUnit, KnowsNoFurlongs) {
  for (const char* text : {"furlong", "V/furlong", "V/s", "m/s^2/sqrt(kg)", "g/sqrt(Hz)/s", "/"})
    EXPECT_FALSE(parse_figure_unit(text)) << text;
}

TEST(Figure, OffsetShiftsTheValueButNotItsStandardDeviation) {
  Figure figure = make_figure(25.0, "degC", "thermometer");
  figure.std = 0.5;
  EXPECT_DOUBLE_EQ(figure.si(), 298.15);
  EXPECT_EQ(figure.std_si(), 0.5);
}

TEST(Figure, OfTheThesisIsTheSensitivityInSi) {
  EXPECT_DOUBLE_EQ(make_figure(330.0, "mV/g", "").si(), 0.330 / g);
}

}  // namespace
}  // namespace proofmass::sensor::figure_test
