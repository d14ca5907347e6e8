#include "proofmass/sensor/calibration.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace proofmass::sensor::calibration_test {
namespace {

const Unit mps2 = parse_unit("m/s^2").value();
const Unit volts = parse_unit("V").value();
const Unit counts = parse_unit("counts").value();
using Force = std::array<double, 3>;

Recording recording_of(const std::vector<Force>& rows, const Unit& unit) {
  Recording recording;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Channel& channel = recording.channels.emplace_back();
    channel.name = std::string("acc_") + "xyz"[axis];
    channel.unit = unit;
    for (const Force& row : rows) channel.values.edit().push_back(row[axis]);
  }
  return recording;
}

SensorModel thesis_sensor() {
  SensorModel model;
  model.electrical.supply = make_figure(3.3, "V", "");
  model.electrical.reference_supply = make_figure(3.3, "V", "");
  model.electrical.sensitivity = make_axis_figures({330, 330, 330}, "mV/g", "");
  model.electrical.zero_g_fraction = make_axis_figures({0.5, 0.5, 0.5}, "1", "");
  return model;
}

const std::vector<Force> forces{{9.8, 0.1, -0.2}, {-3.0, 9.0, 1.0}, {0.5, -0.5, -9.7}};

/// reading = diag(scale) T⁻¹ f + bias, by back substitution.
Force reading_of(const Force& f) {
  constexpr double yz = 0.01, zy = -0.02, zx = 0.03;
  const double u2 = f[2];
  const double u1 = f[1] + zx * u2;
  const double u0 = f[0] + yz * u1 - zy * u2;
  return {1.1 * u0 + 0.3, 0.9 * u1 - 0.2, 1.05 * u2 + 0.1};
}

Calibration its_calibration() {
  Calibration calibration;
  calibration.bias = make_axis_figures({0.3, -0.2, 0.1}, "m/s^2", "");
  calibration.scale = make_axis_figures({1.1, 0.9, 1.05}, "1", "");
  calibration.misalignment = make_axis_figures({0.01, -0.02, 0.03}, "rad", "");
  return calibration;
}

TEST(ApplySensor, UndoesTheModelEquation) {
  std::vector<Force> readings;
  for (const Force& f : forces) readings.push_back(reading_of(f));
  Recording recording = recording_of(readings, mps2);
  SensorModel model;
  model.calibration = its_calibration();
  ASSERT_TRUE(apply(model, recording));
  for (std::size_t k = 0; k < forces.size(); ++k)
    for (std::size_t axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(recording.channels[axis].values[k], forces[k][axis], 1e-14);
  EXPECT_TRUE(recording.notes.empty());
}

// The thesis prints 1.98 V for −1 g; the sensor described in it gives 1.32 V.
TEST(ApplySensor, ReadsVoltsOfTheThesissSensor) {
  Recording recording = recording_of({{1.32, 1.65, 1.98}}, volts);
  ASSERT_TRUE(apply(thesis_sensor(), recording));
  EXPECT_NEAR(recording.channels[0].values[0], -standard_gravity_mps2, 1e-12);
  EXPECT_NEAR(recording.channels[1].values[0], 0.0, 1e-12);
  EXPECT_NEAR(recording.channels[2].values[0], standard_gravity_mps2, 1e-12);
  EXPECT_EQ(recording.channels[0].unit, mps2);
}

TEST(ApplySensor, FollowsTheSupplyOfARatiometricSensor) {
  SensorModel model = thesis_sensor();
  model.electrical.supply_channel = "supply";
  // Half the supply plus a tenth of it is 1 g at any supply.
  Recording recording = recording_of({{0.6 * 3.3, 0, 0}, {0.6 * 3.0, 0, 0}}, volts);
  recording.channels.push_back({"supply", parse_unit("mV").value(), {3300.0, 3000.0}});
  ASSERT_TRUE(apply(model, accelerometer_triads(recording).at(0), recording));
  EXPECT_NEAR(recording.channels[0].values[0], standard_gravity_mps2, 1e-12);
  EXPECT_NEAR(recording.channels[0].values[1], standard_gravity_mps2, 1e-12);
  EXPECT_EQ(recording.channels[3].values[1], 3000.0);
}

TEST(ApplySensor, TakesAGivenSupplyWhereNoChannelRecordsIt) {
  SensorModel model = thesis_sensor();
  model.electrical.supply = make_figure(3.0, "V", "");
  Recording recording = recording_of({{0.6 * 3.0, 0.5 * 3.0, 0.4 * 3.0}}, volts);
  ASSERT_TRUE(apply(model, recording));
  EXPECT_NEAR(recording.channels[0].values[0], standard_gravity_mps2, 1e-12);
  EXPECT_NEAR(recording.channels[1].values[0], 0.0, 1e-12);
  EXPECT_NEAR(recording.channels[2].values[0], -standard_gravity_mps2, 1e-12);
}

TEST(ApplySensor, OfOneThatIsNotRatiometricLeavesTheVoltsAlone) {
  SensorModel model = thesis_sensor();
  model.electrical.reference_supply.reset();
  model.electrical.supply = make_figure(3.0, "V", "");
  Recording recording = recording_of({{1.83, 1.5, 1.5}}, volts);
  ASSERT_TRUE(apply(model, recording));
  EXPECT_NEAR(recording.channels[0].values[0], standard_gravity_mps2, 1e-12);
}

TEST(ApplySensor, TakesCountsThroughTheLsb) {
  SensorModel model = thesis_sensor();
  model.electrical.lsb = make_figure(0.1, "mV", "");
  Recording analog = recording_of({{13200, 16500, 19800}}, counts);
  ASSERT_TRUE(apply(model, analog));
  EXPECT_NEAR(analog.channels[0].values[0], -standard_gravity_mps2, 1e-12);

  SensorModel digital;
  digital.electrical.lsb = make_figure(1.0 / 16384.0, "g", "");
  Recording recording = recording_of({{16384, 0, -8192}}, counts);
  ASSERT_TRUE(apply(digital, recording));
  EXPECT_NEAR(recording.channels[0].values[0], standard_gravity_mps2, 1e-12);
  EXPECT_NEAR(recording.channels[2].values[0], -standard_gravity_mps2 / 2, 1e-12);
}

// Parameters typical of published calibrations in counts.
TEST(ApplySensor, TakesACalibrationInCountsDirectly) {
  SensorModel model;
  model.calibration.bias = make_axis_figures({33123.8, 33275.2, 32364.5}, "counts", "");
  model.calibration.scale = make_axis_figures({414.418, 412.031, 414.622}, "counts/(m/s^2)", "");
  Recording recording = recording_of({{33123.8, 33275.2, 32364.5 + 4146.22}}, counts);
  ASSERT_TRUE(apply(model, recording));
  EXPECT_NEAR(recording.channels[0].values[0], 0.0, 1e-12);
  EXPECT_NEAR(recording.channels[2].values[0], 10.0, 1e-10);
}

TEST(ApplySensor, WithoutFiguresOnlyConvertsTheUnit) {
  Recording recording = recording_of({{1.0, 0.0, -1.0}}, parse_unit("g").value());
  ASSERT_TRUE(apply(SensorModel{}, recording));
  EXPECT_EQ(recording.channels[0].values[0], standard_gravity_mps2);
  EXPECT_EQ(recording.channels[2].values[0], -standard_gravity_mps2);
}

TEST(ApplySensor, KeepsANanWhereItWas) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Recording recording = recording_of({{nan, 1.0, 2.0}, {1.0, 1.0, 2.0}}, mps2);
  SensorModel model;
  model.calibration.bias = make_axis_figures({0.5, 0.5, 0.5}, "m/s^2", "");
  ASSERT_TRUE(apply(model, recording));
  EXPECT_TRUE(std::isnan(recording.channels[0].values[0]));
  EXPECT_EQ(recording.channels[1].values[0], 0.5);
  EXPECT_EQ(recording.channels[0].values[1], 0.5);
}

TEST(ApplySensor, SaysThatAnAxisIsMissing) {
  Recording recording = recording_of({reading_of({1.0, 2.0, 0.0})}, mps2);
  recording.channels.pop_back();
  SensorModel model;
  model.calibration = its_calibration();
  ASSERT_TRUE(apply(model, recording));
  EXPECT_NEAR(recording.channels[0].values[0], 1.0, 1e-14);
  EXPECT_NEAR(recording.channels[1].values[0], 2.0, 1e-14);
  ASSERT_EQ(recording.notes.size(), 1U);
  EXPECT_EQ(recording.notes[0].severity, Severity::warning);
}

TEST(ApplySensor, GivesTheReasonOfAFailureAndChangesNothing) {
  Recording recording = recording_of({{1, 2, 3}}, counts);
  const auto no_lsb = apply(thesis_sensor(), recording);
  ASSERT_FALSE(no_lsb);
  EXPECT_NE(no_lsb.error().message.find("acc_x is in counts"), std::string::npos);
  EXPECT_NE(no_lsb.error().message.find("electrical.lsb"), std::string::npos);
  EXPECT_EQ(recording.channels[0].values[0], 1.0);
  EXPECT_EQ(recording.channels[0].unit, counts);

  SensorModel mixed;
  mixed.calibration.bias = make_axis_figures({1, 1, 1}, "V", "");
  EXPECT_FALSE(apply(mixed, recording));
  SensorModel zero;
  zero.calibration.scale = make_axis_figures({1, 0, 1}, "counts/(m/s^2)", "");
  EXPECT_FALSE(apply(zero, recording));
  SensorModel two_units;
  two_units.calibration.scale = make_axis_figures({400, 400, 400}, "counts/(m/s^2)", "");
  two_units.calibration.scale[1] = make_figure(1.0, "V/g", "");
  EXPECT_FALSE(apply(two_units, recording));
  SensorModel two_axes;
  two_axes.calibration.scale = make_axis_figures({400, 400, 400}, "counts/(m/s^2)", "");
  two_axes.calibration.scale[2].reset();
  EXPECT_FALSE(apply(two_axes, recording));
  SensorModel in_volts;
  in_volts.calibration.scale = make_axis_figures({1, 1, 1}, "V/g", "");
  Recording in_g = recording_of({{1, 2, 3}}, parse_unit("g").value());
  EXPECT_FALSE(apply(in_volts, in_g));
  SensorModel supplied = thesis_sensor();
  supplied.electrical.supply_channel = "rail";
  Recording in_v = recording_of({{1, 2, 3}}, volts);
  EXPECT_FALSE(apply(supplied, in_v));
  Recording nothing;
  EXPECT_FALSE(apply(SensorModel{}, nothing));
}

TEST(AlignmentStd, IsGivenInRadians) {
  SensorModel model;
  EXPECT_FALSE(alignment_std_rad(model));
  model.calibration.alignment_std = make_figure(0.1, "deg", "ADXL335 datasheet");
  EXPECT_DOUBLE_EQ(*alignment_std_rad(model), 0.1 * rad_per_deg);
}

TEST(BringToReferenceSupply, ScalesVoltagesAndNothingElse) {
  Electrical electrical = thesis_sensor().electrical;
  electrical.supply_channel = "supply";
  Recording recording = recording_of({{1.65, 1.98, 1.32}, {1.5, 1.8, 1.2}}, volts);
  recording.channels.push_back({"supply", parse_unit("mV").value(), {3300.0, 3000.0}});
  const Triad triad{"acc", 0, 1, 2};
  ASSERT_TRUE(bring_to_reference_supply(electrical, triad, recording));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Samples& values = recording.channels[axis].values;
    EXPECT_NEAR(values[1], values[0], 1e-12) << axis;
  }
  EXPECT_EQ(recording.channels[3].values[1], 3000.0);
  recording.channels.pop_back();
  EXPECT_EQ(bring_to_reference_supply(electrical, triad, recording).error().code,
            Errc::invalid_argument);
}

}  // namespace
}  // namespace proofmass::sensor::calibration_test
