#include "proofmass/report/simulate_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <numbers>

#include "proofmass/report/schema_test_support.hpp"
#include "proofmass/report/servo_report.hpp"

namespace proofmass::report::simulate_report_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

simulate::RigResult two_turns() {
  const double pi = std::numbers::pi;
  simulate::RigResult result;
  result.recording.channels = {{"acc1_x", *parse_unit("m/s^2"), {0.0, 0.0, 0.0}}};
  result.truth.channels = {{"angle", *parse_unit("rad"), {1.0, 1.0 + pi, 1.0 + 4.0 * pi}},
                           {"speed", *parse_unit("rad/s"), {pi, -2.0 * pi, pi}}};
  return result;
}

simulate::ProcedureResult result_of(const simulate::ProcedureOptions& options) {
  return simulate::simulate_procedure(options).value();
}

TEST(SimulateReport, HasTurnsAndTopSpeedOfTheTruth) {
  const simulate::RigOptions options{};
  const simulate::RigResult result = two_turns();
  const Document document = describe(SimulateReport{{}, "a.csv", "a.truth.csv", options, result});
  EXPECT_THAT(document.page.conclusion, HasSubstr("2.0000 turns, top speed 60.00 rpm"));
  const auto json = nlohmann::json::parse(to_json(document));
  EXPECT_DOUBLE_EQ(json["truth"]["turns"].get<double>(), 2.0);
  EXPECT_DOUBLE_EQ(json["truth"]["peak_speed_rpm"].get<double>(), 60.0);
}

TEST(SimulateReport, NamesNoTruthFileWhereNoneWasWritten) {
  const simulate::RigOptions options{};
  const simulate::RigResult result = two_turns();
  EXPECT_THAT(to_text(describe(SimulateReport{{}, "a.csv", "a.truth.csv", options, result})),
              HasSubstr("a.truth.csv"));
  EXPECT_THAT(to_text(describe(SimulateReport{{}, "-", "", options, result})),
              Not(HasSubstr("truth")));
}

TEST(SimulateReport, ShowsTheTrueSensorOfAProcedure) {
  simulate::ProcedureOptions options =
      simulate::default_options(simulate::Procedure::four_position);
  options.sensor.bias_mps2 = {0.125, -0.25, 0.5};
  options.sensor.bias_spread_mps2 = 0.0;
  const simulate::ProcedureResult result = result_of(options);
  const std::string text = to_text(describe(ProcedureReport{
      .output = "a.csv", .sensor = "a.sensor.toml", .options = options, .result = result}));
  EXPECT_THAT(text, HasSubstr("4 positions"));
  EXPECT_THAT(text, HasSubstr("0.12500, −0.25000, 0.50000 m/s²"));
}

TEST(Schemas, Simulate) {
  const simulate::RigOptions rig{};
  const simulate::RigResult turns = two_turns();
  const auto tumble = simulate::default_options(simulate::Procedure::tumble);
  const auto hand = simulate::default_options(simulate::Procedure::six_position);
  const auto slide = simulate::default_options(simulate::Procedure::slide);
  const simulate::ProcedureResult on_table = result_of(tumble), by_hand = result_of(hand),
                                  along = result_of(slide);
  simulate::MotorOptions driven;
  driven.duration_s = 0.1;
  const simulate::MotorResult drive = simulate::simulate_motor(driven).value();
  servo::ServoStudy loops{};
  loops.worst = {{.feedback = servo::Feedback::live_estimate, .compensated = true},
                 {.feedback = servo::Feedback::double_integration, .compensated = true},
                 {.feedback = servo::Feedback::atan2, .compensated = true}};
  loops.worst.front().speed_settling_s = loops.worst.front().position_settling_s = 0.6;
  expect_schema_of_kinds(
      "Simulated recording and its truth: of the rig, or of a procedure with --procedure.",
      {{describe(SimulateReport{{}, "a.csv", "", rig, turns})},
       {describe(ProcedureReport{.output = "a.csv", .options = tumble, .result = on_table}),
        describe(ProcedureReport{.output = "a.csv", .options = hand, .result = by_hand}),
        describe(ProcedureReport{.output = "a.csv", .options = slide, .result = along})},
       {describe(MotorRigReport{.output = "a.csv", .options = driven, .result = drive})},
       {describe(ServoReport{.output = "a.csv", .study = loops})}});
}

}  // namespace
}  // namespace proofmass::report::simulate_report_test
