#include "proofmass/report/schema.hpp"

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "proofmass/calibrate/gyroscope_budget.hpp"
#include "proofmass/report/budget_report.hpp"
#include "proofmass/report/calibrate/encoder_report.hpp"
#include "proofmass/report/calibrate/fake.hpp"
#include "proofmass/report/convert_report.hpp"
#include "proofmass/report/drift/fake.hpp"
#include "proofmass/report/inspect_report.hpp"
#include "proofmass/report/model_equation_report.hpp"
#include "proofmass/report/motor/report.hpp"
#include "proofmass/report/noise/fake.hpp"
#include "proofmass/report/recover_report.hpp"
#include "proofmass/report/rotation_report.hpp"
#include "proofmass/report/schema_test_support.hpp"
#include "proofmass/report/tilt/fake.hpp"
#include "proofmass/report/track/fake.hpp"
#include "proofmass/report/tumble/fake.hpp"
#include "proofmass/report/tune/fake.hpp"
#include "proofmass/report/wheel/fake.hpp"

namespace proofmass::report::schema_test {
namespace {

using nlohmann::json;

Document document_of(Fields fields) {
  return {.page = {.verb = "v", .title = {}, .inputs = {}, .conclusion = {}},
          .fields = std::move(fields)};
}

TEST(JsonSchema, RequiresWhatEverySampleHasAndAllowsWhatOneHas) {
  const json schema = json::parse(
      json_schema("d", {document_of({field::count("always", 1), field::text("sometimes", "x")}),
                        document_of({field::count("always", 2)})}));
  const json& required = schema["required"];
  EXPECT_EQ(std::count(required.begin(), required.end(), "always"), 1);
  EXPECT_EQ(std::count(required.begin(), required.end(), "sometimes"), 0);
  EXPECT_EQ(schema["properties"]["sometimes"]["type"], "string");
  EXPECT_EQ(schema["additionalProperties"], false);
}

TEST(JsonSchema, IsNullableWhereAnEntryMayBeAbsent) {
  const json schema = json::parse(json_schema(
      "d", {document_of({field::number("plain", 1.0), field::number("open", std::nullopt),
                         field::object_or_null("inner", Fields{field::flag("f", true)})})}));
  EXPECT_EQ(schema["properties"]["plain"]["type"], "number");
  EXPECT_EQ(schema["properties"]["open"]["type"], (json{"number", "null"}));
  EXPECT_EQ(schema["properties"]["inner"]["type"], (json{"object", "null"}));
}

TEST(JsonSchema, FixesAUnitOnlyIfAllSamplesHaveIt) {
  const auto schema_of = [](const char* one, const char* other) {
    return json::parse(json_schema("d", {document_of({field::measured("a", Uncertain{}, one)}),
                                         document_of({field::measured("a", Uncertain{}, other)})}));
  };
  EXPECT_EQ(schema_of("m", "m")["properties"]["a"]["properties"]["unit"]["const"], "m");
  EXPECT_FALSE(schema_of("m", "V")["properties"]["a"].contains("properties"));
}

// Schema of the only entry of a document.
json schema_of(const Field& field) {
  return json::parse(json_schema("d", {document_of({field})}))["properties"][field.key];
}

TEST(JsonSchema, BoundsProbabilitiesCountsAndListsOfFixedLength) {
  EXPECT_EQ(schema_of(field::probability("p", 0.5)),
            (json{{"type", "number"}, {"minimum", 0}, {"maximum", 1.0}}));
  const json three = schema_of(field::numbers("a", std::array{1.0, 2.0, 3.0}));
  EXPECT_EQ(three["minItems"], 3);
  EXPECT_EQ(three["maxItems"], 3);
  EXPECT_EQ(schema_of(field::numbers("a", Eigen::Vector2d::Zero().eval()))["maxItems"], 2);
  EXPECT_FALSE(schema_of(field::numbers("a", std::vector{1.0})).contains("maxItems"));
  EXPECT_EQ(schema_of(field::interval("a", std::array{0.0, 1.0}))["minItems"], 2);
}

TEST(JsonSchema, HasThePatternsOfTextsAndOfTheKeysOfMaps) {
  Field text = field::text("a", "x"), map = field::map("m", {field::count("k", 1)});
  text.shape.pattern = map.shape.pattern = "^[a-z]$";
  EXPECT_EQ(schema_of(text)["pattern"], "^[a-z]$");
  EXPECT_EQ(schema_of(map)["propertyNames"]["pattern"], "^[a-z]$");
}

// A document with a second entry that depends on its mode.
Document in_mode(const char* word, const char* key) {
  Field mode = field::choice("mode", word, {"still", "moving"});
  mode.shape.decides = true;
  return document_of({mode, field::count("n", 1), field::count(key, 2)});
}

TEST(JsonSchema, RequiresWithEachWordOfADecidingChoiceWhatItsSamplesHave) {
  const json schema =
      json::parse(json_schema("d", {in_mode("still", "rests"), in_mode("moving", "speed")}));
  ASSERT_EQ(schema["allOf"].size(), 2U);
  EXPECT_EQ(schema["allOf"][0]["if"]["properties"]["mode"]["const"], "still");
  EXPECT_EQ(schema["allOf"][0]["then"]["required"], (json{"rests"}));
  EXPECT_EQ(schema["allOf"][1]["then"]["required"], (json{"speed"}));
}

TEST(JsonSchema, AllowsNullBesideTheWordsOfAnAbsentChoice) {
  const Field one = field::choice("a", "x", {"x", "y"});
  const json schema = json::parse(
      json_schema("d", {document_of({one}), document_of({field::without_value(one, "why")})}));
  EXPECT_EQ(schema["properties"]["a"]["enum"], (json{"x", "y", nullptr}));
}

// Every entry that a consistency can have.
estimate::Consistency full_consistency() {
  estimate::ConsistencyCheck check({.channels = {"x"}, .rate_hz = 100.0});
  for (int k = 0; k < 3000; ++k) check.add(0, std::sin(k * k), 0.5);
  estimate::Consistency all = check.judge();
  all.remedy = all.channels.front().remedy = estimate::Remedy::both_noises;
  all.worst_channel = 0;
  all.whiteness = {{signal::WhitenessTest{}}};
  all.smoothed_readings = all.smoothed_motion = Uncertain{1.0, 0.1};
  return all;
}

TEST(Schemas, Wheel) {
  WheelReport plain = fake_report(), all = fake_report();
  estimate::WheelSolution& solution = all.solution;
  solution.turns_candidates = {{{-79.61, 0.002}, 0.6}, {{-78.61, 0.002}, 0.4}};
  solution.sensors.front().has_gyro = true;
  solution.consistency = full_consistency();
  expect_schema("Angle, turns and speed of a wheel. SI, but for peak_speed_rpm.",
                {describe(plain), describe(all)});
}

TEST(Schemas, Tilt) {
  const TiltReport still = fake_tilt(false), axis = fake_axis_tilt();
  TiltReport untimed = fake_tilt(false), moving = fake_tilt(true), free = fake_tilt(true);
  untimed.solution->series.time_s.clear();
  untimed.solution->axes = 2;
  moving.solution->rests.front().norm_mps2 = Uncertain{9.8, 0.01};
  moving.solution->rate_bias_radps = std::array<Uncertain, 3>{};
  moving.solution->final.inclination = estimate::Inclination{};
  free.solution->motion->gyroscope = false;
  free.solution->consistency = full_consistency();
  expect_schema(
      "Inclination from gravity, at rest and on a moving base, or the angle about one axis. SI.",
      {describe(still), describe(axis), describe(untimed), describe(moving), describe(free)});
}

TEST(Schemas, Track) {
  const TrackReport plain = fake_track(), fused = fake_fused();
  TrackReport jerk = fake_jerk();
  jerk.solution.consistency = full_consistency();
  jerk.solution.alternatives.push_back({.probability = 0.5, .no_rests = {{1.0, 2.0}}});
  jerk.options.fixes = {{1.0, 0.2, 0.01}};
  jerk.solution.fix_review = {
      .false_rests = 1, .wrong = {{1.0, 0.2, 0.01}}, .delay_s = Uncertain{0.05, 0.01}};
  expect_schema("Displacement along the axis of motion. SI.",
                {describe(plain), describe(fused), describe(jerk)});
}

TEST(Schemas, Tune) {
  const TuneReport limited = fake_tuned(0.0);
  TuneReport found = fake_tuned(0.01);
  found.consistency = full_consistency();
  expect_schema(
      "Noise figures of a filter by maximum likelihood, its consistency, and the study of "
      "its gain.",
      {describe(found), describe(limited)});
}

TEST(Schemas, Motor) {
  MotorReport known;
  known.solution.has_current = true;
  known.solution.parameters = {{.name = "inertia",
                                .unit = "kg*m^2",
                                .meaning = "",
                                .value = Uncertain{0.6, 0.01},
                                .interval_95 = {{0.58, 0.62}}}};
  known.solution.friction = {{.speed_radps = 1.0, .torque = 3.0, .std = 0.1}};
  MotorReport open = known;
  open.solution.has_current = false;
  open.solution.parameters = {
      {.name = "backlash", .unit = "rad", .meaning = "", .reason = "no reversal"}};
  expect_schema("Friction, inertia and backlash of a drive, at the load's shaft.",
                {describe(known), describe(open)});
}

TEST(Schemas, Budget) {
  BudgetReport report{{}, {}, {{"Tactical", {3e-3, 0.0}, {{1.0, {1.5e-3, 0.0}}}}}};
  std::vector<const sensor::AccelerometerPart*> parts;
  for (const sensor::AccelerometerPart& part : sensor::accelerometer_parts())
    parts.push_back(&part);
  report.parts = part_rows(parts, {10.0}, 5.0);
  expect_schema("Position error by double integration from rest.", {describe(report)});
}

TEST(Schemas, Convert) {
  Recording recording;
  recording.channels = {{"x", {}, {}}};
  const std::vector<Note> notes;
  const ConvertReport report{"a.csv", "b.npy", recording, 0, notes};
  expect_schema("Recording written in another format.", {describe(report)});
}

TEST(Schemas, Inspect) {
  Recording recording;
  recording.labels = {{"up", 0, 1}};
  signal::RecordingAudit audit;
  audit.channels.resize(1);
  audit.timing.gaps.resize(1);
  audit.timing.lost = 0;
  signal::RecordingAudit uncounted = audit;
  uncounted.timing.lost.reset();
  const InspectedFile file{"a.csv", recording, audit}, other{"b.csv", recording, uncounted};
  expect_schema(
      "Contents and data quality of recordings. The entries at the top are those of the first "
      "file.",
      {describe({file}), describe({other, file})});
}

TEST(Schemas, Recover) {
  expect_schema("What was recovered of a recording that was not closed.",
                {describe(RecoverReport{})});
}

// Every entry that a calibration can have.
CalibrateReport full_calibration() {
  CalibrateReport report = fake_supply_report();
  report.check =
      calibrate::MonteCarloCheck{.draws = 100, .parameters = {{}}, .agrees = true, .verdict = "v"};
  report.validation = calibrate::Validation{{0.01}, 0.01, 0.01, 0.5};
  report.stability = calibrate::BiasStability{{1.0, 1.0, 1.0}, "flicker noise"};
  report.fit.doubtful = {1};
  report.fit.mounting_rad = report.fit.mounting_std_rad = Eigen::Vector3d::Zero();
  report.fit.placement_std_rad = 0.01;
  report.fit.axes_in_fixture = Eigen::Matrix3d::Identity();
  report.poses.front().label = "z up";
  report.fit.shares.push_back({.source = "gravity", .type_a = false});
  report.budgets = calibrate::budget_of(report.fit, {}, "V").value();
  report.budgets.front().effective_dof = 0.0;
  return report;
}

// One motion and one rate of each kind, and figures that the motions do not determine.
GyroscopeReport full_gyroscope() {
  GyroscopeReport report{.unit = *parse_unit("rad/s"), .fit = {}, .budgets = {}};
  calibrate::GyroscopeCalibration& fit = report.fit;
  fit.estimate.setOnes();
  fit.covariance.setIdentity();
  fit.why_absent[4] = "not turned";
  fit.shares = {{.source = "motions", .covariance = fit.covariance, .dof = 10.0}};
  fit.motions.resize(2);
  fit.motions[0].leave_one_out_rad = 0.1;
  fit.motions[0].studentised = 1.0;
  fit.motions[1].used = false;
  fit.motions[1].why_unused = "samples are missing";
  fit.rates = {{1.0, 1e-4, 1e-4}};
  fit.lack_of_fit = fit.rests_lack_of_fit = calibrate::LackOfFit{1.0, 0.5, 10.0};
  fit.leave_one_out_rms_rad = 0.1;
  report.budgets = calibrate::budget_of(fit, "rad/s");
  return report;
}

TEST(Schemas, Calibrate) {
  CalibrateReport full = full_calibration();
  full.gyroscope = full_gyroscope();
  CalibrateReport counts = full, untimed = fake_calibrate_report();
  counts.check->stable = true;
  counts.unit = {Quantity::counts, 1.0, 0.0, "counts"};
  counts.gyroscope->unit = counts.unit;
  CalibrateReport volts = full;
  volts.gyroscope->unit = *parse_unit("V");
  counts.gyroscope->fit.lack_of_fit = counts.gyroscope->fit.rests_lack_of_fit = {};
  counts.gyroscope->fit.leave_one_out_rms_rad = {};
  untimed.files.front().times_known = false;
  expect_schema(
      "Multi-position calibration of a three-axis accelerometer. SI unless a key or a unit beside "
      "the figure names another.",
      {describe(full), describe(counts), describe(volts), describe(untimed),
       describe(fake_bare_report())});
}

TEST(Schemas, EncoderCalibration) {
  EncoderReport seen{.inputs = {"a.csv"},
                     .notes = {},
                     .channel = "encoder",
                     .options = {},
                     .fit = {},
                     .index_slips = {{}}};
  seen.fit.shares = {{}};
  seen.fit.missed = {{}};
  seen.fit.step_rad = 1e-3;
  seen.fit.detectable_counts = 1;
  seen.fit.axis_names = {"x"};
  seen.fit.residual_rms_mps2 = {0.02};
  const EncoderReport unseen = seen;
  for (calibrate::EncoderHarmonic& one : seen.fit.harmonics) {
    one.amplitude_rad = Uncertain{5e-3, 1e-4};
    one.phase_rad = Uncertain{1.0, 0.02};
    one.phase_95_rad = {0.96, 1.04};
  }
  expect_schema("Errors of an encoder by the accelerometers on its wheel. SI.",
                {describe(seen), describe(unseen)}, "calibrate_encoder");
}

// One output with all coefficients, in this unit.
ModelOutput fake_output(const std::string& unit) {
  ModelOutput output{.name = "E", .unit = unit, .rows = {}, .fit = {}, .cross_axis = {}};
  calibrate::ModelFit& fit = output.fit;
  for (const sensor::CoefficientInfo& about : sensor::coefficients())
    fit.coefficients.push_back({.coefficient = about.coefficient, .value = Uncertain{1.0, 0.1}});
  fit.covariance = Eigen::MatrixXd::Identity(16, 16);
  fit.residuals = {0.0};
  const sensor::Coefficient K1 = sensor::Coefficient::K1;
  fit.confounded = {{.coefficients = {K1},
                     .determined = 1,
                     .relations = {"a"},
                     .combinations = {{.name = "K1", .parts = {{K1, 1.0}}, .value = {1.0, 0.1}}},
                     .words = "w"}};
  fit.test = calibrate::ResidualTest{};
  output.cross_axis = calibrate::CrossAxis{};
  return output;
}

TEST(Schemas, ModelEquation) {
  ModelEquationReport volts, plain, several;
  volts.gravity_mps2 = 9.81;
  volts.outputs = {fake_output("V")};
  plain.outputs = {fake_output("m/s^2")};
  several.outputs = {fake_output("V"), fake_output("")};
  several.outputs.front().fit.coefficients.front().value.reset();
  expect_schema(
      "Coefficients of the IEEE 1293 model equation from outputs under known motion. SI. With a "
      "single output its coefficients are entries of the document, too.",
      {describe(volts), describe(plain), describe(several)}, "tumble_coefficients");
}

RotationReport fake_rotation(const std::string& unit) {
  RotationReport report{
      .inputs = {"a.csv"}, .notes = {}, .axis_names = {"x"}, .unit = unit, .fit = {}};
  calibrate::RotationAxis& axis = report.fit.axes.emplace_back();
  for (std::size_t q = 0; q < calibrate::rotation_quantities; ++q)
    axis.coefficients[q] = {.quantity = static_cast<calibrate::RotationQuantity>(q),
                            .value = Uncertain{1.0, 0.1}};
  axis.fold = {{0.0}, {0.0}, {0.0}, {0.1}};
  report.fit.sections = {{}};
  report.fit.ripples = {{}};
  return report;
}

TEST(Schemas, RotatingTable) {
  const RotationReport volts = fake_rotation("V"), plain = fake_rotation("m/s^2");
  expect_schema(
      "Coefficients of the IEEE 1293 model equation from a sensor that rotates evenly about a "
      "horizontal axis. SI.",
      {describe(volts), describe(plain)}, "tumble_rotating");
}

TEST(Schemas, Tumble) {
  const TumbleReport full = fake_full_tumble();
  TumbleReport volts = fake_tumble(fake_channel(24, 1e-5));
  volts.channels.front().fit->lack_of_fit = calibrate::TumbleLackOfFit{};
  TumbleReport refused = fake_tumble(fake_channel(4, 0.0));
  refused.channels.front().fit.reset();
  refused.channels.front().refused = "level";
  expect_schema(
      "Coefficients of the IEEE 1293 model equation from positions on a turntable. SI unless a key "
      "or a unit beside the figure names another. Those at the top are of `channel`.",
      {describe(full), describe(volts), describe(refused)});
}

// Adds every term to a curve.
void complete(characterise::DriftFit& fit) {
  fit.possibilities.resize(1);
  fit.curve.steps.resize(1);
  fit.a1 = fit.slope_per_s = fit.second_a1 = fake_interval(1.0, 0.1);
  fit.time_constant_s = fit.second_time_constant_s = fake_interval(1.0, 0.1);
  fit.time_constant_above_s.reset();
  fit.time_constant_below_s = fit.candidates.front().time_constant_s = 1.0;
}

TEST(Schemas, Drift) {
  const DriftReport plain = fake_drift_report();
  DriftReport all = plain;
  complete(all.channels.front().analysis->fit);
  all.channels[1].rest.reset();
  all.channels[1].temperature = DriftTemperature{.channel = "t", .model = {}, .refused = "r"};
  all.runs = {fake_runs("acc_x"), fake_runs("acc_y"), {"acc_z", {}, {}, "2 runs left"}};
  all.runs.front().set->level_curve = all.channels.front().analysis->fit;
  complete(all.runs.front().set->warm_up.fit);
  all.runs[1].set->trend_per_run.reset();
  DriftReport volts = all;  // without a fixed unit
  volts.channels.front().unit = volts.runs.front().unit = *parse_unit("V");
  volts.forecast_s.reset();
  expect_schema(
      "Bias of a sensor at rest after power-on. SI unless a key names another unit; times are "
      "since power-on.",
      {describe(plain), describe(all), describe(volts)});
}

TEST(Schemas, Noise) {
  NoiseReport plain = fake_noise_report(), all = fake_noise_report();
  all.channels.push_back(refused_channel("acc_z"));
  ChannelNoise& channel = all.channels.front();
  channel.temperature = TemperatureEffect{.channel = "temp", .coefficient = {1e-3, 1e-4}};
  channel.rest = RestShare{.share = 0.5, .longest_start_s = 1.0, .longest_end_s = 2.0};
  characterise::NoiseAnalysis& analysis = *channel.analysis;
  analysis.deviation.points.front().alpha_lag1 = -1;
  analysis.deviation.points[5].tau_s = 1.0;
  analysis.deviation.points[5].value = 0.0;  // the minimum
  analysis.model.random_walk = identified(1e-5, 1e-6);
  analysis.model.markov = {identified(1e-5, 1e-6), {60.0, 3.0}};
  analysis.model.slow_change = characterise::SlowChange{};
  analysis.stationarity = {.tested = true, .line_hz = {}, .relative_level = {0.7, 1.4}};
  analysis.parts = {{0.0, 5000.0, analysis.model}, {5000.0, 10'000.0, {}}};
  NoiseReport volts = all;  // without a fixed unit
  volts.channels.front().unit = *parse_unit("V");
  expect_schema("Allan deviation, spectrum and noise coefficients of a sensor at rest. SI.",
                {describe(plain), describe(all), describe(volts)});
}

}  // namespace
}  // namespace proofmass::report::schema_test
