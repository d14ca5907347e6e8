#include "proofmass/sensor/calibration_update.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

#include "proofmass/sensor/calibration.hpp"
#include "proofmass/sensor/file/folder_test_support.hpp"
#include "proofmass/sensor/sensor_file.hpp"

namespace proofmass::sensor::calibration_update_test {
namespace {

using Covariance = std::array<std::array<double, 9>, 9>;
constexpr std::array<double, 9> stds{0.25, 0.14, 0.15, 0.027, 0.014, 0.016, 1.3e-4, 4.8e-4, 1.2e-4};

Covariance covariance_of(const std::array<double, 9>& std) {
  Covariance C{};
  for (std::size_t i = 0; i < 9; ++i)
    for (std::size_t j = 0; j < 9; ++j) C[i][j] = (i == j ? 1.0 : 0.1) * std[i] * std[j];
  return C;
}

// Figures typical of published calibrations of raw counts.
MeasuredCalibration in_counts() {
  MeasuredCalibration m;
  m.bias = {Uncertain{33123.83, stds[0]}, Uncertain{33275.16, stds[1]},
            Uncertain{32364.49, stds[2]}};
  m.scale = {Uncertain{414.422, stds[3]}, Uncertain{412.031, stds[4]}, Uncertain{414.62, stds[5]}};
  m.misalignment = {Uncertain{3.39e-3, stds[6]}, Uncertain{-9.17e-3, stds[7]},
                    Uncertain{21.36e-3, stds[8]}};
  m.bias_unit = "counts";
  m.scale_unit = "counts/(m/s^2)";
  m.covariance = covariance_of(stds);
  m.gravity_mps2 = Uncertain{9.81744, 1e-4};
  m.origin = "proofmass calibrate poses.csv, 38 positions";
  return m;
}

MeasuredCalibration in_volts() {
  MeasuredCalibration m = in_counts();
  m.bias = {Uncertain{1.65, 1e-3}, Uncertain{1.60, 1e-3}, Uncertain{1.70, 1e-3}};
  m.scale = {Uncertain{0.034, 1e-5}, Uncertain{0.033, 1e-5}, Uncertain{0.035, 1e-5}};
  m.bias_unit = "V";
  m.scale_unit = "V/(m/s^2)";
  m.covariance = covariance_of({1e-3, 1e-3, 1e-3, 1e-5, 1e-5, 1e-5, 1.3e-4, 4.8e-4, 1.2e-4});
  return m;
}

MeasuredCalibration x_alone() {
  MeasuredCalibration m;
  m.bias[0] = Uncertain{0.1, 0.002};
  m.scale[0] = Uncertain{1.01, 0.0003};
  m.origin = "proofmass tumble x.csv";
  return m;
}

/// The reading of a force by the model equation, reading = diag(scale) T⁻¹ f + bias.
std::array<double, 3> reading_of(const std::array<double, 3>& f, const MeasuredCalibration& m) {
  const double u2 = f[2];
  const double u1 = f[1] + m.misalignment[2]->value * u2;
  const double u0 = f[0] + m.misalignment[0]->value * u1 - m.misalignment[1]->value * u2;
  return {m.scale[0]->value * u0 + m.bias[0]->value, m.scale[1]->value * u1 + m.bias[1]->value,
          m.scale[2]->value * u2 + m.bias[2]->value};
}

Recording recording_of(const std::array<double, 3>& reading, const std::string& unit) {
  Recording recording;
  for (std::size_t axis = 0; axis < 3; ++axis)
    recording.channels.push_back(
        {std::string("acc_") + "xyz"[axis], parse_unit(unit).value(), {reading[axis]}});
  return recording;
}

/// Checks that the file's calibration converts a reading of the force back to it.
void expect_undone(const SensorModel& model, Recording recording, double tolerance) {
  constexpr std::array<double, 3> f{3.0, -5.0, 7.8};
  const Status done = apply(model, recording);
  ASSERT_TRUE(done) << done.error().message;
  for (std::size_t axis = 0; axis < 3; ++axis)
    EXPECT_NEAR(recording.channels[axis].values[0], f[axis], tolerance);
}

constexpr std::array<double, 3> force{3.0, -5.0, 7.8};

std::vector<Note> updated(SensorModel& model, const MeasuredCalibration& measured) {
  auto notes = update_calibration(model, measured);
  EXPECT_TRUE(notes) << (notes ? "" : notes.error().message);
  return notes ? std::move(notes).value() : std::vector<Note>{};
}

class CalibrationFileUpdate : public FolderTest {};

TEST(CalibrationUpdate, InCountsIsAppliedToCountsWhateverTheLsb) {
  const auto reading = reading_of(force, in_counts());
  for (const char* lsb : {"none", "mV", "m/s^2"}) {
    SensorModel model;
    if (lsb != std::string_view("none")) model.electrical.lsb = make_figure(0.3, lsb, "");
    EXPECT_TRUE(updated(model, in_counts()).empty());
    expect_undone(model, recording_of(reading, "counts"), 1e-11);
  }
}

TEST(CalibrationUpdate, WritesNoStandardDeviationsThatLackAShare) {
  MeasuredCalibration m = in_counts();
  m.std_known = false;
  SensorModel model;
  EXPECT_FALSE(update_calibration(model, m));
  m.covariance.reset();
  ASSERT_TRUE(update_calibration(model, m));
  EXPECT_EQ(model.calibration.bias[1]->value, 33275.16);
  EXPECT_FALSE(model.calibration.bias[1]->std);
  EXPECT_FALSE(model.calibration.misalignment[2]->std);
}

TEST(CalibrationUpdate, InCountsIsAppliedToWhatTheLsbMadeOfThem) {
  SensorModel model;
  model.electrical.lsb = make_figure(0.3, "mV", "");
  updated(model, in_counts());
  auto reading = reading_of(force, in_counts());
  for (double& r : reading) r *= 0.3;
  expect_undone(model, recording_of(reading, "mV"), 1e-11);
  Recording in_g = recording_of(reading, "g");
  EXPECT_FALSE(apply(model, in_g));
}

TEST(CalibrationUpdate, InVoltsIsAppliedToVoltsMillivoltsAndCounts) {
  SensorModel model;
  model.electrical.lsb = make_figure(0.5, "mV", "");
  updated(model, in_volts());
  const auto v = reading_of(force, in_volts());
  expect_undone(model, recording_of(v, "V"), 1e-12);
  expect_undone(model, recording_of({1e3 * v[0], 1e3 * v[1], 1e3 * v[2]}, "mV"), 1e-12);
  expect_undone(model, recording_of({2e3 * v[0], 2e3 * v[1], 2e3 * v[2]}, "counts"), 1e-12);
}

TEST(CalibrationUpdate, InVoltsOfARatiometricSensorHoldsAtAnySupply) {
  SensorModel model;
  model.electrical.reference_supply = make_figure(3.0, "V", "datasheet");
  model.electrical.supply = make_figure(3.3, "V", "meter");
  const auto notes = updated(model, in_volts());
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].text.find("3.3 V"), std::string::npos);
  const auto v = reading_of(force, in_volts());
  expect_undone(model, recording_of(v, "V"), 1e-12);
  EXPECT_NEAR(model.calibration.bias[0]->si(), 1.65 * 3.0 / 3.3, 1e-15);
  EXPECT_NEAR((*model.calibration.covariance)[0][0], 1e-6 * 9.0 / 10.89, 1e-20);
  EXPECT_NEAR((*model.calibration.covariance)[8][8], stds[8] * stds[8], 1e-20);

  // The same sensor with a supply recorded in a separate channel.
  model.electrical.supply_channel = "rail";
  Recording at_2_7 = recording_of({v[0] * 2.7 / 3.3, v[1] * 2.7 / 3.3, v[2] * 2.7 / 3.3}, "V");
  at_2_7.channels.push_back({"rail", parse_unit("V").value(), {2.7}});
  ASSERT_TRUE(apply(model, accelerometer_triads(at_2_7).at(0), at_2_7));
  EXPECT_NEAR(at_2_7.channels[0].values[0], force[0], 1e-12);
}

TEST(CalibrationUpdate, InVoltsNeedsToKnowASupplyThatIsRecorded) {
  SensorModel model;
  model.electrical.reference_supply = make_figure(3.0, "V", "datasheet");
  model.electrical.supply_channel = "rail";
  const auto unknown = update_calibration(model, in_volts());
  ASSERT_FALSE(unknown);
  EXPECT_NE(unknown.error().message.find("\"rail\""), std::string::npos);
  MeasuredCalibration measured = in_volts();
  measured.supply_v = 3.0;
  EXPECT_TRUE(updated(model, measured).empty());
  EXPECT_EQ(model.calibration.bias[0]->value, 1.65);
  measured.supply_v = 3.3;
  updated(model, measured);
  EXPECT_NEAR(model.calibration.bias[0]->value, 1.65 * 3.0 / 3.3, 1e-15);
  measured.supply_v = 0.0;
  EXPECT_FALSE(update_calibration(model, measured));
}

TEST(CalibrationUpdate, OfCorrectedReadingsHasAScaleWithoutUnit) {
  SensorModel model;
  model.electrical.lsb = make_figure(1.0 / 16384.0, "g", "");
  MeasuredCalibration m = in_counts();
  m.bias = {Uncertain{0.3, 0.01}, Uncertain{-0.2, 0.01}, Uncertain{0.1, 0.01}};
  m.scale = {Uncertain{1.1, 1e-3}, Uncertain{0.9, 1e-3}, Uncertain{1.05, 1e-3}};
  m.bias_unit = "m/s^2";
  m.scale_unit = "1";
  m.covariance.reset();
  updated(model, m);
  const auto r = reading_of(force, m);
  expect_undone(model, recording_of(r, "m/s^2"), 1e-13);
  const double per_count = standard_gravity_mps2 / 16384.0;
  expect_undone(
      model, recording_of({r[0] / per_count, r[1] / per_count, r[2] / per_count}, "counts"), 1e-12);
}

TEST(CalibrationUpdate, WritesUnitStdOriginGravityAndCovarianceInSi) {
  SensorModel model;
  MeasuredCalibration m = in_volts();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    m.bias[axis]->value *= 1e3;
    m.bias[axis]->std *= 1e3;
  }
  m.bias_unit = "mV";
  m.covariance = covariance_of({1, 1, 1, 1e-5, 1e-5, 1e-5, 1.3e-4, 4.8e-4, 1.2e-4});
  m.temperature_k = 295.0;
  m.serial = "17";
  m.date = "2026-11-21";
  updated(model, m);
  const Calibration& c = model.calibration;
  EXPECT_EQ(c.bias[0]->unit.symbol, "mV");
  EXPECT_NEAR(*c.bias[0]->std_si(), 1e-3, 1e-15);
  EXPECT_NEAR((*c.covariance)[0][0], 1e-6, 1e-18);
  EXPECT_NEAR((*c.covariance)[0][3], 0.1 * 1e-3 * 1e-5, 1e-20);
  EXPECT_EQ(c.scale[2]->origin, m.origin);
  EXPECT_EQ(c.misalignment[1]->unit.symbol, "rad");
  EXPECT_EQ(c.gravity->value, 9.81744);
  EXPECT_EQ(c.gravity->std, 1e-4);
  EXPECT_EQ(c.temperature->si(), 295.0);
  EXPECT_EQ(model.serial, "17");
  EXPECT_EQ(model.date, "2026-11-21");
}

TEST(CalibrationUpdate, OfOneAxisKeepsTheOthersAndDropsTheOldCovariance) {
  SensorModel model;
  MeasuredCalibration all = in_counts();
  all.bias_unit = "m/s^2";
  all.scale_unit = "1";
  updated(model, all);
  model.calibration.temperature = make_figure(293.0, "K", "");
  model.calibration.alignment_std = make_figure(0.1, "deg", "datasheet");
  const Calibration before = model.calibration;
  MeasuredCalibration x = x_alone();
  x.gravity_mps2 = Uncertain{9.8, 0.0};
  const auto notes = updated(model, x);
  EXPECT_EQ(model.calibration.bias[0]->value, 0.1);
  EXPECT_EQ(model.calibration.bias[1], before.bias[1]);
  EXPECT_EQ(model.calibration.misalignment, before.misalignment);
  EXPECT_EQ(model.calibration.temperature, before.temperature);
  EXPECT_EQ(model.calibration.alignment_std, before.alignment_std);
  EXPECT_FALSE(model.calibration.covariance);
  EXPECT_FALSE(model.calibration.gravity->std);
  ASSERT_EQ(notes.size(), 3U);
  EXPECT_NE(notes[0].text.find("bias y, bias z, scale y"), std::string::npos) << notes[0].text;
  EXPECT_NE(notes[1].text.find("covariance is left out"), std::string::npos);
  EXPECT_NE(notes[2].text.find("was 9.81744 m/s² and is 9.8 m/s²"), std::string::npos);
}

TEST(CalibrationUpdate, OfAllAxesForgetsUnderWhatTheOldOneHeld) {
  SensorModel model;
  model.calibration.gravity = make_figure(9.7, "m/s^2", "old");
  model.calibration.temperature = make_figure(293.0, "K", "old");
  MeasuredCalibration m = in_counts();
  m.gravity_mps2.reset();
  EXPECT_TRUE(updated(model, m).empty());
  EXPECT_FALSE(model.calibration.gravity);
  EXPECT_FALSE(model.calibration.temperature);
  EXPECT_TRUE(model.calibration.covariance);
}

TEST(CalibrationUpdate, KeepsTheFewestDegreesOfFreedomWhereFiguresStay) {
  SensorModel model;
  MeasuredCalibration m = in_counts();
  m.dof = 15.0;
  updated(model, m);
  EXPECT_EQ(model.calibration.dof->value, 15.0);
  m.bias[0].reset();
  m.covariance.reset();
  m.dof = 29.0;
  updated(model, m);
  EXPECT_EQ(model.calibration.dof->value, 15.0);
  m.dof = 7.0;
  updated(model, m);
  EXPECT_EQ(model.calibration.dof->value, 7.0);
  updated(model, in_counts());
  EXPECT_FALSE(model.calibration.dof);
}

// Six figures of a fit that assumed orthogonal axes, with its own 9 × 9 covariance.
TEST(CalibrationUpdate, KeepsACovarianceThatCoversAllThatIsThere) {
  MeasuredCalibration six = in_counts();
  six.misalignment = {};
  SensorModel model;
  updated(model, six);
  EXPECT_TRUE(model.calibration.covariance);
  SensorModel with_angles;
  with_angles.calibration.misalignment = make_axis_figures({1, 2, 3}, "mrad", "earlier");
  EXPECT_EQ(updated(with_angles, six).size(), 2U);
  EXPECT_FALSE(with_angles.calibration.covariance);
}

TEST(CalibrationUpdate, SaysWhichAxesCannotBeReadYet) {
  MeasuredCalibration x = x_alone();
  x.bias_unit = "V";
  x.scale_unit = "V/g";
  SensorModel model;
  const auto notes = updated(model, x);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].text.find("of axis y, z"), std::string::npos) << notes[0].text;
}

TEST(CalibrationUpdate, RefusesWhatCannotBeACalibrationAndLeavesTheModelAlone) {
  const auto refused = [](auto spoil) {
    MeasuredCalibration m = in_counts();
    SensorModel model;
    model.serial = "16";
    spoil(m, model);
    const SensorModel spoilt = model;
    const auto done = update_calibration(model, m);
    EXPECT_EQ(model, spoilt);
    return done ? std::string("no error") : done.error().message;
  };
  using M = MeasuredCalibration;
  static constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refused([](M& m, SensorModel&) { m = {}; }), "nothing of the calibration was measured");
  EXPECT_EQ(refused([](M& m, SensorModel&) { m.scale[1]->value = nan; }),
            "calibration.scale y: must be a finite number with a finite standard deviation");
  EXPECT_EQ(refused([](M& m, SensorModel&) { m.bias[0]->std = -1.0; }),
            "calibration.bias x: its standard deviation must not be negative");
  EXPECT_EQ(refused([](M& m, SensorModel&) { m.temperature_k = nan; }),
            "calibration.temperature: must be a finite number");
  EXPECT_EQ(refused([](M& m, SensorModel&) { m.dof = 0.0; }),
            "calibration.dof: must be positive and finite");
  EXPECT_EQ(refused([](M& m, SensorModel&) { m.gravity_mps2->value = nan; }),
            "calibration.gravity: must be a finite number with a finite standard deviation");
  EXPECT_TRUE(refused([](M& m, SensorModel&) {
                m.scale[2]->value = 0.0;
              }).starts_with("calibration.scale must not be 0"));
  EXPECT_TRUE(refused([](M& m, SensorModel&) {
                m.bias_unit = "V";
              }).starts_with("calibration.bias is in V"));
  EXPECT_TRUE(refused([](M& m, SensorModel&) {
                m.bias_unit = "furlongs";
              }).starts_with("a calibration cannot be in \"furlongs\""));
  EXPECT_EQ(refused([](M& m, SensorModel&) { (*m.covariance)[0][1] = 0.0; }),
            "calibration.covariance: must be symmetric");
  EXPECT_EQ(refused([](M& m, SensorModel&) { (*m.covariance)[4][4] = nan; }),
            "calibration.covariance: must be of finite numbers");
  EXPECT_EQ(refused([](M& m, SensorModel&) {
              (*m.covariance)[0][1] = (*m.covariance)[1][0] = 1.5 * stds[0] * stds[1];
            }),
            "calibration.covariance: has a negative variance in some direction");
  EXPECT_EQ(refused([](M& m, SensorModel&) { m.bias[0]->std = 0.5; }),
            "calibration.covariance: gives bias x a standard deviation of 0.25, which is stated "
            "as 0.5 with its value");
  EXPECT_TRUE(refused([](M& m, SensorModel&) {
                m.serial = "17";
              }).starts_with("the file is of the sensor with serial number 16"));
  EXPECT_NE(refused([](M& m, SensorModel& model) {
              m.bias[1].reset();
              m.scale[1].reset();
              m.covariance.reset();
              model.calibration.scale[1] = make_figure(300, "mV/g", "");
            }).find("calibrate all axes at once"),
            std::string::npos);
}

TEST_F(CalibrationFileUpdate, MakesAFileThatReadsBackTheSame) {
  ASSERT_TRUE(update_calibration(path("rim.toml"), in_counts()));
  const SensorFile file = read_sensor_file(path("rim.toml")).value();
  EXPECT_EQ(file.model.name, "rim");
  EXPECT_TRUE(file.notes.empty());
  EXPECT_EQ(file.model.calibration.bias[1]->value, 33275.16);
  ASSERT_TRUE(file.model.calibration.covariance);
  EXPECT_NEAR((*file.model.calibration.covariance)[3][3], stds[3] * stds[3], 1e-18);
  expect_undone(file.model, recording_of(reading_of(force, in_counts()), "counts"), 1e-11);
}

TEST_F(CalibrationFileUpdate, KeepsAllElseAndDoesTheSameWhenDoneTwice) {
  write("s.toml", R"toml([sensor]
name = "A-17"
colour = "green"
[noise]
white = { value = 106, unit = "ug/sqrt(Hz)", origin = "static.csv" }
)toml");
  SensorModel expected = read_sensor_file(path("s.toml")).value().model;
  updated(expected, in_counts());
  ASSERT_TRUE(update_calibration(path("s.toml"), in_counts()));
  EXPECT_EQ(read_sensor_file(path("s.toml")).value().model, expected);
  const std::string once = text("s.toml");
  ASSERT_TRUE(update_calibration(path("s.toml"), in_counts()));
  EXPECT_EQ(text("s.toml"), once);
}

TEST_F(CalibrationFileUpdate, LeavesAFileThatItCannotReadOrImproveAsItIs) {
  write("s.toml", "[calibration]\nbias = \"much\"\n");
  const auto unreadable = update_calibration(path("s.toml"), in_counts());
  ASSERT_FALSE(unreadable);
  EXPECT_EQ(unreadable.error().code, Errc::corrupt);
  EXPECT_EQ(text("s.toml"), "[calibration]\nbias = \"much\"\n");
  write("t.toml", "[sensor]\nserial = \"9\"\n");
  MeasuredCalibration other = in_counts();
  other.serial = "10";
  const auto refused = update_calibration(path("t.toml"), other);
  ASSERT_FALSE(refused);
  EXPECT_TRUE(refused.error().message.starts_with(path("t.toml") + ": the file is of the sensor"));
  EXPECT_EQ(text("t.toml"), "[sensor]\nserial = \"9\"\n");
}

}  // namespace
}  // namespace proofmass::sensor::calibration_update_test
