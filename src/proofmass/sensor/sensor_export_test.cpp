#include "proofmass/sensor/sensor_export.hpp"

#include <gtest/gtest.h>
#include <limits>
#include <string>

namespace proofmass::sensor::sensor_export_test {
namespace {

SensorModel measured() {
  SensorModel model;
  model.name = "ADXL335 at the rim";
  model.noise.white = make_axis_figures({1.04e-3, 1.1e-3, 2.08e-3}, "m/s^2/sqrt(Hz)", "noise, 2 h");
  model.noise.white[2]->std = 1e-5;
  model.noise.random_walk = make_axis_figures({1.5e-5, 0.0, 1e-5}, "m/s^2/sqrt(s)", "noise, 2 h");
  model.noise.random_walk[1]->origin = "noise, 2 h: below 3e-06 m/s^2/sqrt(s) (95 %)";
  return model;
}

SensorModel calibrated() {
  SensorModel model = measured();
  model.calibration.bias = make_axis_figures({0.1, -0.2, 0.3}, "m/s^2", "tumble");
  model.calibration.scale = make_axis_figures({2.0, 0.5, 1.0}, "1", "tumble");
  model.calibration.misalignment = make_axis_figures({0.01, 0.02, 0.04}, "rad", "tumble");
  model.electrical.reference_supply = make_figure(3.0, "V", "datasheet");
  model.electrical.sensitivity = make_axis_figures({300, 300, 300}, "mV/g", "datasheet");
  model.electrical.zero_g_fraction = make_axis_figures({0.5, 0.5, 0.5}, "1", "datasheet");
  return model;
}

bool has(const std::string& text, std::string_view line) {
  return ("\n" + text).find("\n" + std::string(line) + "\n") != std::string::npos;
}

TEST(ImuYaml, TakesTheWorstAxisAndShowsAllThree) {
  const std::string yaml = imu_yaml(measured(), {.rate_hz = 100.0}).value();
  EXPECT_TRUE(has(yaml, "accelerometer_noise_density: 0.00208")) << yaml;
  EXPECT_TRUE(has(yaml, "accelerometer_random_walk: 1.5e-05")) << yaml;
  EXPECT_TRUE(has(yaml, "#   x: 0.00104, noise, 2 h")) << yaml;
  EXPECT_TRUE(has(yaml, "#   z: 0.00208 ± 1e-05, noise, 2 h")) << yaml;
  EXPECT_TRUE(has(yaml, "#   y: 0, noise, 2 h: below 3e-06 m/s^2/sqrt(s) (95 %)")) << yaml;
  EXPECT_TRUE(has(yaml, "rostopic: \"/imu0\"")) << yaml;
  EXPECT_TRUE(has(yaml, "update_rate: 100.0  # Hz")) << yaml;
}

TEST(ImuYaml, IsInSiWhateverTheSensorFileIsIn) {
  SensorModel model = measured();
  model.noise.white = make_axis_figures({100, 200, 100}, "ug/sqrt(Hz)", "");
  const std::string yaml = imu_yaml(model, {}).value();
  EXPECT_NE(yaml.find("accelerometer_noise_density: 0.00196133"), std::string::npos) << yaml;
  EXPECT_TRUE(has(yaml, "#   x: 0.000980665")) << yaml;
}

TEST(ImuYaml, LeavesTheGyroscopeAndWhatIsNotKnownToFillIn) {
  SensorModel model = measured();
  model.noise.random_walk = {};
  const std::string yaml = imu_yaml(model, {}).value();
  EXPECT_TRUE(has(yaml, "# gyroscope_noise_density:  # rad/s/sqrt(Hz); measure it at rest"))
      << yaml;
  EXPECT_TRUE(has(yaml, "# accelerometer_random_walk:")) << yaml;
  EXPECT_TRUE(has(yaml, "#   y: not in the sensor file")) << yaml;
  EXPECT_TRUE(has(yaml, "# update_rate:  # Hz; fill in")) << yaml;
}

TEST(ImuYaml, IsCompleteWithAGyroscope) {
  SensorModel model = measured();
  model.gyroscope.white = make_axis_figures({0.3, 0.2, 0.1}, "deg/sqrt(h)", "");
  model.gyroscope.random_walk = make_axis_figures({1e-5, 2e-5, 1e-5}, "rad/s/sqrt(s)", "");
  const std::string yaml = imu_yaml(model, {.rate_hz = 100.0}).value();
  // 0.3 °/√h is 0.3/60 °/√s.
  EXPECT_NE(yaml.find("\ngyroscope_noise_density: 8.72664625997164"), std::string::npos) << yaml;
  EXPECT_TRUE(has(yaml, "gyroscope_random_walk: 2.0e-05")) << yaml;
  EXPECT_FALSE(has(yaml, "fill in")) << yaml;
}

TEST(ImuYaml, WritesNumbersThatYamlDoesNotTakeForText) {
  SensorModel model = measured();
  model.noise.random_walk = make_axis_figures({1e-5, 0.0, 0.0}, "m/s^2/sqrt(s)", "");
  EXPECT_TRUE(has(imu_yaml(model, {}).value(), "accelerometer_random_walk: 1.0e-05"));
}

TEST(ImuYaml, KeepsNamesAndTopicsFromBreakingOut) {
  SensorModel model = measured();
  model.name = "a\nupdate_rate: 7";
  const std::string yaml = imu_yaml(model, {.rate_hz = {}, .rostopic = "/a \"b\" \\\n"}).value();
  EXPECT_FALSE(has(yaml, "update_rate: 7"));
  EXPECT_TRUE(has(yaml, R"(rostopic: "/a \"b\" \\\x0A")")) << yaml;
}

TEST(ImuYaml, SaysWhyItCannot) {
  SensorModel model = measured();
  model.noise.white[1].reset();
  const auto missing = imu_yaml(model, {});
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, Errc::invalid_argument);
  EXPECT_TRUE(missing.error().message.starts_with("noise.white is missing on axis y: measure"));
  model.noise.white = make_axis_figures({0, 0, 0}, "m/s^2/sqrt(Hz)", "");
  const auto zero = imu_yaml(model, {});
  ASSERT_FALSE(zero);
  EXPECT_EQ(zero.error().code, Errc::not_observable);
  for (const double rate_hz : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_FALSE(imu_yaml(measured(), {.rate_hz = rate_hz}));
}

TEST(CHeader, HasTheCorrectionAsTheCalibrationAppliesIt) {
  const std::string header = c_header(calibrated()).value();
  EXPECT_TRUE(has(header,
                  "static const float adxl335_at_the_rim_bias_mps2[3] = "
                  "{0.1f, -0.2f, 0.3f};"))
      << header;
  // T diag(1/scale) with T = [1 −0.01 0.02; 0 1 −0.04; 0 0 1].
  EXPECT_NE(header.find("adxl335_at_the_rim_correction[3][3] = {\n"
                        "    {0.5f, -0.02f, 0.02f},\n"
                        "    {0.0f, 2.0f, -0.04f},\n"
                        "    {0.0f, 0.0f, 1.0f},\n};"),
            std::string::npos)
      << header;
}

TEST(CHeader, HasNoiseAndElectricalConstantsInSiWithUnitAndOrigin) {
  const std::string header = c_header(calibrated()).value();
  EXPECT_NE(header.find("/* m/s^2/sqrt(Hz); noise, 2 h */\nstatic const float "
                        "adxl335_at_the_rim_white_mps2_rthz[3] = {0.00104f, 0.0011f, 0.00208f};"),
            std::string::npos)
      << header;
  EXPECT_TRUE(has(header, "static const float adxl335_at_the_rim_reference_supply_v = 3.0f;"));
  EXPECT_NE(header.find("_sensitivity_v_per_mps2[3] = {0.030591"), std::string::npos) << header;
  EXPECT_NE(header.find("reading = (V / V_s - zero_g_fraction) * reference_supply_v"),
            std::string::npos);
  EXPECT_TRUE(has(header, "#ifndef PROOFMASS_ADXL335_AT_THE_RIM_H"));
}

TEST(CHeader, LeavesOutWhatIsNotKnownOnEveryAxis) {
  SensorModel model = calibrated();
  model.noise.white[2].reset();
  const std::string header = c_header(model).value();
  EXPECT_EQ(header.find("white_mps2_rthz"), std::string::npos) << header;
  EXPECT_TRUE(has(header, "/* noise.white is left out: not known on axis z */"));
  EXPECT_TRUE(has(header, "/* noise.flicker is left out: not known on axis x, y, z */"));
  EXPECT_EQ(header.find("supply_v ="), header.find("reference_supply_v =") + 10);
}

TEST(CHeader, OfAnEmptySensorCorrectsNothing) {
  const std::string header = c_header(SensorModel{}).value();
  EXPECT_TRUE(has(header, "static const float sensor_bias_mps2[3] = {0.0f, 0.0f, 0.0f};"));
  EXPECT_NE(header.find("    {1.0f, 0.0f, 0.0f},"), std::string::npos) << header;
  EXPECT_TRUE(has(header, "#ifndef PROOFMASS_SENSOR_H"));
}

TEST(CHeader, NamesTheUnitOfTheReadingThatTheCalibrationIsOf) {
  SensorModel model = calibrated();
  model.calibration.bias = make_axis_figures({1.5, 1.5, 1.5}, "V", "");
  model.calibration.scale = make_axis_figures({300, 300, 300}, "mV/g", "");
  const std::string header = c_header(model).value();
  EXPECT_NE(header.find("_bias_v[3]"), std::string::npos);
  EXPECT_NE(header.find("where reading is the output in V * reference_supply_v / supply in V"),
            std::string::npos);
  EXPECT_NE(header.find("m/s^2 per V;"), std::string::npos);
}

TEST(CHeader, TurnsAnyNameIntoAnIdentifierAndAHarmlessComment) {
  SensorModel model;
  model.name = "3*/ int x; /* π \?\?/\\\n__end__";
  const std::string header = c_header(model).value();
  EXPECT_NE(header.find("sensor_3_int_x_end_bias_mps2"), std::string::npos) << header;
  EXPECT_TRUE(header.starts_with("/* 3* / int x; / * π ? ?/  __end__: ")) << header;
}

TEST(CHeader, SaysWhyItCannot) {
  const auto error_of = [](auto spoil) {
    SensorModel model = calibrated();
    spoil(model);
    const auto header = c_header(model);
    return header ? std::string("no error") : header.error().message;
  };
  EXPECT_EQ(error_of([](SensorModel& m) { m.calibration.scale[1]->value = 0.0; }),
            "calibration.scale must not be 0");
  EXPECT_TRUE(error_of([](SensorModel& m) {
                m.calibration.bias = make_axis_figures({1, 1, 1}, "V", "");
              }).starts_with("calibration.bias is in V"));
  EXPECT_TRUE(error_of([](SensorModel& m) {
                m.calibration.bias = {};
                m.calibration.scale = make_axis_figures({300, 300, 300}, "mV/g", "");
                m.calibration.scale[2].reset();
              }).starts_with("calibration.scale is missing on axis z"));
  EXPECT_TRUE(error_of([](SensorModel& m) {
                m.noise.white[0]->value = 1e300;
              }).starts_with("white is too large for a float"));
}

}  // namespace
}  // namespace proofmass::sensor::sensor_export_test
