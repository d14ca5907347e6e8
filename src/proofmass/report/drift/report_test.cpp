#include "proofmass/report/drift/report.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "proofmass/report/drift/fake.hpp"
#include "proofmass/report/drift/figures.hpp"
#include "proofmass/report/drift/wording.hpp"

namespace proofmass::report::drift_report_test {
namespace {

using Json = nlohmann::ordered_json;
using characterise::DriftReason;
using characterise::DriftShape;

constexpr double mg = fake_mg;
const Unit accel = *parse_unit("m/s^2");

Json parsed(const DriftReport& report) {
  return Json::parse(to_json(describe(report)));
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

bool says(const std::vector<std::string>& sentences, const std::string& part) {
  return std::ranges::any_of(sentences, [&](const auto& s) { return contains(s, part); });
}

bool warns(const Json& document, const std::string& part) {
  return says(document["warnings"].get<std::vector<std::string>>(), part);
}

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++count;
  }
  return count;
}

DriftReport report_of(ChannelDrift channel) {
  DriftReport report;
  report.inputs = {"rest.csv"};
  report.channels = {std::move(channel)};
  return report;
}

void collect_nulls(const Json& json, const std::string& path, std::vector<std::string>& found) {
  if (json.is_null()) found.push_back(path);
  if (!json.is_structured()) return;
  for (const auto& [key, value] : json.items()) collect_nulls(value, path + "/" + key, found);
}

TEST(DriftVerdict, OfAnExponentialGivesItsSizeAndTimeConstant) {
  EXPECT_EQ(drift_verdict(fake_warm_up("x")),
            "warm-up of 5.00 ± 0.10 mg with time constant 900 ± 20 s");
}

TEST(DriftVerdict, OfStepsStatesThatTheyAreNotAnExponential) {
  EXPECT_EQ(drift_verdict(fake_steps("x")),
            "no warm-up identified: steps rather than an exponential: 3 steps of up to 4.10 mg");
}

TEST(DriftVerdict, HasItsOwnWordsForEachReason) {
  ChannelDrift channel = fake_steps("x");
  characterise::DriftFit& fit = channel.analysis->fit;
  const auto verdict = [&](DriftReason why) {
    fit.why = why;
    return drift_verdict(channel);
  };
  EXPECT_TRUE(contains(verdict(DriftReason::no_warm_up), "noise alone explains"));
  EXPECT_TRUE(contains(verdict(DriftReason::hidden_by_noise), "low-frequency noise explains"));
  EXPECT_TRUE(contains(verdict(DriftReason::longer_than_record),
                       "too short for the time constant, which is longer than 400 s (95 %)"));
  EXPECT_TRUE(contains(verdict(DriftReason::unexplained), "neither noise nor an exponential"));
  fit.time_constant_above_s.reset();
  fit.time_constant_below_s = 3.0;
  EXPECT_TRUE(contains(verdict(DriftReason::shorter_than_resolved), "shorter than 3 s (95 %)"));
  fit.time_constant_below_s.reset();
  fit.slope_per_s = fake_interval(2.0 * mg / 3600.0, 0.1 * mg / 3600.0);
  EXPECT_TRUE(contains(verdict(DriftReason::line),
                       "a straight line fits as well, 2.00 ± 0.10 mg/h; the time constant is not "
                       "bounded on either side"));
}

TEST(DriftIntervals, KeepTheDecimalsThatTheirWidthMeansAndTheirOpenEnds) {
  using characterise::Interval95;
  EXPECT_EQ(bias_interval_words(fake_interval(5.0 * mg, 0.1 * mg), accel), "4.80 … 5.20 mg");
  EXPECT_EQ(bias_interval_words(fake_interval(1000.0 * mg, 0.01 * mg), accel),
            "999.980 … 1000.020 mg");
  EXPECT_EQ(time_interval_words({900.0, 20.0, 862.0, {}}), "above 862 s");
  EXPECT_EQ(time_interval_words({900.0, 20.0, {}, 941.0}), "below 941 s");
  EXPECT_EQ(time_interval_words(Interval95{900.0, 20.0, {}, {}}), "not bounded");
}

TEST(WhitenessSentence, DistinguishesTheScalesAndChecksTheNoiseModel) {
  characterise::DriftAnalysis analysis = *fake_warm_up("x").analysis;
  analysis.whiteness.back().inside_bounds = 0.41;
  EXPECT_EQ(whiteness_sentence(analysis),
            "Residuals at 1 s and 10 s white, at 100 s not: 41 % of lags inside the bounds (95 % "
            "if white); the noise model accounts for it.");
  analysis.whitened->white = false;
  analysis.noise_explained = false;
  EXPECT_TRUE(contains(whiteness_sentence(analysis), "the intervals may be too narrow"));
  analysis.whiteness.pop_back();
  EXPECT_EQ(whiteness_sentence(analysis), "Residuals at 1 s and 10 s white.");
  analysis.whiteness.clear();
  EXPECT_EQ(whiteness_sentence(analysis), "Too short to test the residuals for whiteness.");
}

TEST(DriftFindings, GiveALimitForAWarmUpThatIsNotIdentified) {
  const auto sentences = drift_findings(fake_steps("x"));
  EXPECT_TRUE(says(sentences, "no warm-up of more than 2.00 mg with a time constant of 24 min"))
      << ::testing::PrintToString(sentences);
  EXPECT_FALSE(says(drift_findings(fake_warm_up("x")), "no warm-up of more than"));
}

TEST(DriftFindings, HaveTemperatureAndForecastOrWhyThereIsNone) {
  const DriftReport report = fake_drift_report();
  const auto of_x = drift_findings(report.channels[0]);
  EXPECT_TRUE(says(of_x, "Depends on temp as a polynomial of degree 1: 40.0 mg"));
  EXPECT_TRUE(says(of_x, "between 16.9 and 36.9 °C"));
  EXPECT_TRUE(says(of_x, "Hysteresis: 300 ± 50 µg more on heating"));
  EXPECT_TRUE(says(of_x, "3 h after power-on: bias 6.50 ± 0.10 mg"));
  EXPECT_TRUE(says(drift_findings(report.channels[1]), "No forecast: the warm-up is not"));
  EXPECT_EQ(drift_findings(report.channels[2]),
            (std::vector<std::string>{"Not analysed: the values do not vary."}));
}

TEST(RunFindings, GiveTheScatterBeyondTheNoiseWithinTheRuns) {
  const auto sentences = run_findings(fake_runs("x"));
  EXPECT_EQ(sentences[0],
            "Turn-on repeatability, from the first 6 s: 2.1 ± 0.5 mg (95 %: 1.4 … 4.3 mg).");
  EXPECT_TRUE(says(sentences, "levels: none beyond the noise within the runs, below 300 µg"));
  EXPECT_TRUE(says(sentences, "No trend from run to run"));
  EXPECT_TRUE(says(sentences, "Common to all runs: no warm-up identified"));
}

TEST(DriftJson, HasTheFieldsOfTheContractForAWarmUp) {
  const Json channel = parsed(fake_drift_report())["channels"][0];
  EXPECT_EQ(channel["name"], "acc_x");
  EXPECT_EQ(channel["unit"], "m/s^2");
  EXPECT_EQ(channel["model"], "exponential");
  EXPECT_EQ(channel["verdict"], "identified");
  EXPECT_DOUBLE_EQ(channel["a1"]["value"].get<double>(), 5.0 * mg);
  EXPECT_DOUBLE_EQ(channel["a2"]["std"].get<double>(), 0.05 * mg);
  EXPECT_EQ(channel["time_constant_s"], (Json{{"value", 900.0}, {"std", 20.0}, {"unit", "s"}}));
  EXPECT_EQ(channel["interval_95"]["time_constant_s"], (Json{862.0, 941.0}));
  EXPECT_EQ(channel["residual_rms"], fake_mg);
  ASSERT_EQ(channel["whiteness"].size(), 3U);
  EXPECT_EQ(channel["whiteness"][2]["scale_s"], 100.0);
  EXPECT_EQ(channel["whiteness"][2]["ljung_box_p"], 1e-9);
  EXPECT_LT(channel["whiteness"][2]["inside_bounds"], 0.95);
  EXPECT_FALSE(channel["whiteness"][2].contains("autocorrelation"));
  EXPECT_EQ(channel["knocks"][0]["start_s"], 1200.0);
}

TEST(DriftJson, LeavesAmplitudeAndTimeConstantNullWhereNoneIsIdentified) {
  const Json document = parsed(fake_drift_report());
  const Json& channel = document["channels"][1];
  EXPECT_EQ(channel["verdict"], "not_identified");
  EXPECT_EQ(channel["model"], "steps");
  EXPECT_EQ(channel["reason"], "three steps explain the drift better than an exponential");
  EXPECT_EQ(channel["reason_code"], "steps");
  for (const char* key : {"a1", "time_constant_s"}) {
    EXPECT_TRUE(channel[key].is_null()) << key;
    EXPECT_TRUE(channel["interval_95"][key].is_null()) << key;
  }
  EXPECT_FALSE(channel["a2"].is_null());
  EXPECT_EQ(channel["time_constant_above_s"], 400.0);
  EXPECT_EQ(channel["steps"].size(), 3U);
  EXPECT_TRUE(warns(
      document, "channels[1] (acc_y): a1, time_constant_s: null: no warm-up identified: steps"));
  EXPECT_TRUE(warns(document, "interval_95: a1, time_constant_s: null: no warm-up identified"));
}

TEST(DriftJson, SaysWhyForEveryNull) {
  DriftReport report = fake_drift_report();
  report.runs = {fake_runs("acc_x"), {"acc_y", accel, {}, "2 runs left, a set needs 3"}};
  const Json document = parsed(report);
  EXPECT_TRUE(warns(document, "(acc_y): forecast: null: the warm-up is not identified"));
  EXPECT_TRUE(warns(document, "acc_z: not analysed: the values do not vary"));
  EXPECT_TRUE(warns(document, "(acc_z): model, a1, a2"));
  EXPECT_TRUE(warns(document, "level.interval_95[0]: null: the recording does not bound it"));
  EXPECT_TRUE(warns(document, "warm_up (acc_x): a1, time_constant_s: null"));
  EXPECT_TRUE(warns(document, "runs[1] (acc_y): window_s, duration_s"));
  std::vector<std::string> nulls;
  collect_nulls(document["channels"][0], "", nulls);
  EXPECT_TRUE(nulls.empty()) << nulls.front();
}

TEST(DriftReports, SayFirstThatTheSensorMoved) {
  ChannelDrift channel = fake_warm_up("x");
  channel.rest = RestShare{.share = 0.12, .longest_start_s = 3.0, .longest_end_s = 8.5};
  const DriftReport report = report_of(std::move(channel));
  const Document document = describe(report);
  const std::string text = to_text(document);
  EXPECT_EQ(text.find("Not at rest (x)"), 0U);
  EXPECT_LT(text.find("Not at rest: only 12 %"), text.find("Warm-up of"));
  EXPECT_LT(text.find("Warm-up of"), text.find("Warm-up a1"));
  EXPECT_TRUE(contains(text, "--from 3.00 --to 8.50"));
  EXPECT_FALSE(texts(document.page.notes, Severity::bad).empty());
  EXPECT_EQ(parsed(report)["channels"][0]["rest"]["at_rest"], false);
}

TEST(DriftJson, SaysWhyItDoesNotKnowWhetherTheSensorMoved) {
  ChannelDrift channel = fake_warm_up("x");
  channel.rest.reset();
  const Json document = parsed(report_of(std::move(channel)));
  EXPECT_TRUE(document["channels"][0]["rest"].is_null());
  EXPECT_TRUE(warns(document, "(x): rest: null"));
}

TEST(DriftJson, LeavesOpenEndsOfIntervalsOpenAndSaysSo) {
  ChannelDrift channel = fake_warm_up("x");
  channel.analysis->fit.time_constant_s->upper_95.reset();
  channel.analysis->whitened.reset();
  const Json document = parsed(report_of(std::move(channel)));
  EXPECT_TRUE(document["channels"][0]["interval_95"]["time_constant_s"][1].is_null());
  EXPECT_TRUE(warns(document, "interval_95.time_constant_s[1]: null"));
  EXPECT_TRUE(warns(document, "(x): whitened: null"));
}

TEST(DriftJson, GivesPositionCostsAsHalfBiasTimesTimeSquared) {
  const Json forecast = parsed(fake_drift_report())["channels"][0]["forecast"];
  const Json& row = forecast["position_error_uncorrected_m"][2];
  EXPECT_EQ(row["t_s"], 60.0);
  EXPECT_NEAR(row["value"].get<double>(), 1800.0 * 6.5 * mg, 1e-9);
  EXPECT_NEAR(row["upper"].get<double>(), 1800.0 * (6.5 + 0.196) * mg, 1e-9);
  EXPECT_NEAR(forecast["position_error_m"][1]["lower"].get<double>(), 50.0 * (0.002 - 0.098) * mg,
              1e-9);
}

TEST(DriftJson, HasPositionErrorsOnlyForBiasesInAcceleration) {
  ChannelDrift channel = fake_warm_up("z");
  channel.outlook = fake_outlook();
  channel.outlook->forecast->bias = fake_interval(9.81, 0.001);
  Json document = parsed(report_of(channel));
  EXPECT_TRUE(document["channels"][0]["forecast"]["position_error_uncorrected_m"].is_null());
  EXPECT_FALSE(document["channels"][0]["forecast"]["position_error_m"].is_null());
  EXPECT_TRUE(warns(document, "the level contains gravity"));
  channel.unit = *parse_unit("V");
  document = parsed(report_of(channel));
  EXPECT_TRUE(document["channels"][0]["forecast"]["position_error_m"].is_null());
  EXPECT_TRUE(warns(document, "not an acceleration in m/s^2"));
}

TEST(DriftJson, HasTemperatureCoefficientsWithTheirUnits) {
  const Json found = parsed(fake_drift_report())["channels"][0]["temperature"];
  EXPECT_EQ(found["verdict"], "identified");
  EXPECT_EQ(found["coefficients"][0]["unit"], "m/s^2");
  EXPECT_EQ(found["coefficients"][1]["unit"], "m/s^2/K");
  EXPECT_DOUBLE_EQ(found["coefficients"][1]["value"].get<double>(), -2.0 * mg);
  EXPECT_EQ(found["covariance"].size(), 2U);
  EXPECT_EQ(found["points"][1]["sweep"], "cooling");
}

TEST(DriftJson, HasOfRunsTheirLevelsScatterAndCommonWarmUp) {
  DriftReport report = fake_drift_report();
  report.runs = {fake_runs("acc_x")};
  const Json runs = parsed(report)["runs"][0];
  EXPECT_EQ(runs["count"], 8);
  EXPECT_EQ(runs["levels"][2]["name"], "run 3");
  EXPECT_DOUBLE_EQ(runs["turn_on"]["between_std"]["value"].get<double>(), 2.1 * mg);
  EXPECT_EQ(runs["turn_on"]["p"], 1e-12);
  EXPECT_EQ(runs["trend_p"], 0.96);
  EXPECT_EQ(runs["warm_up"]["model"], "steps");
}

TEST(DriftNotes, MakeRefusalsBadDataAndNameTheFileWhereThereAreSeveral) {
  DriftReport report = fake_drift_report();
  const auto last = [&] { return describe(report).page.notes.back(); };
  EXPECT_EQ(last().severity, Severity::bad);
  EXPECT_EQ(last().text, "acc_z: not analysed: the values do not vary");
  report.channels[2].file = "runs/b.csv";
  EXPECT_EQ(last().text, "b.csv: acc_z: not analysed: the values do not vary");
}

TEST(DriftText, HasTheResultOfEachChannel) {
  const DriftReport report = fake_drift_report();
  const std::string text = to_text(describe(report));
  EXPECT_TRUE(contains(text,
                       "acc_x:\n  7\u202f200 samples at 1 Hz, 2 h, 12 of them missing.\n"
                       "  - Warm-up of 5.00 ± 0.10 mg with time constant 900 ± 20 s.\n"))
      << text;
  EXPECT_TRUE(contains(text, "862 … 941 s"));
  EXPECT_TRUE(contains(text, "acc_z: not analysed: the values do not vary"));
  EXPECT_EQ(text.back(), '\n');
}

TEST(DriftText, OfRunsHasEachOnRequest) {
  DriftReport report = fake_drift_report();
  report.runs = {fake_runs("acc_x")};
  const std::string sample = "862 … 941 s";
  EXPECT_FALSE(contains(to_text(describe(report)), sample));
  report.every_run = true;
  EXPECT_TRUE(contains(to_text(describe(report)), sample));
}

TEST(DriftConclusion, OfManyChannelsCountsThem) {
  DriftReport report = fake_drift_report();
  EXPECT_TRUE(contains(describe(report).page.conclusion, "acc_y: no warm-up identified"));
  report.channels.push_back(fake_steps("acc_w"));
  report.runs = {fake_runs("acc_x")};
  EXPECT_EQ(describe(report).page.conclusion,
            "acc_x over 8 runs: turn-on repeatability 2.1 ± 0.5 mg (95 %: 1.4 … 4.3 mg). A warm-up "
            "is identified in 1 of 4 channels, 1 not analysed.");
}

TEST(DriftSeries, HasBlockMeansCurveAndItsStdAtTheMiddleOfEachBlock) {
  DriftReport report = fake_drift_report();
  report.channels[1].analysis->block_mean.pop_back();
  const Recording table = drift_series(report);
  ASSERT_EQ(table.channels.size(), 8U);
  EXPECT_EQ(table.channels[1].name, "acc_x_fit");
  ASSERT_EQ(table.time.stamps_s.size(), 1800U);
  EXPECT_EQ(table.time.stamps_s[1], 5.5);
  EXPECT_DOUBLE_EQ(table.channels[1].values[1], (1.5 + 5.0 * (1.0 - std::exp(-5.5 / 900.0))) * mg);
  EXPECT_TRUE(std::isnan(table.channels[4].values.back()));
}

TEST(DriftFigure, DrawsACurveOnlyOfWhatIsIdentifiedAndTheRestDashed) {
  const Figure warm = drift_figure(fake_warm_up("x"), "x");
  EXPECT_EQ(warm.curves[2].label, "fit, exponential");
  EXPECT_EQ(warm.curves[2].mark, Mark::line);
  EXPECT_NEAR(warm.curves[2].y.back(), 1.5 + 5.0 * (1.0 - std::exp(-8.0)), 1e-6);
  const Figure steps = drift_figure(fake_steps("x"), "x");
  EXPECT_EQ(steps.curves[2].label, "steps; no exponential is identified");
  EXPECT_EQ(steps.curves[2].mark, Mark::dashes);
}

TEST(DriftFigure, GoesOnToTheForecast) {
  const Figure figure = drift_figure(fake_drift_report().channels[0], "x");
  ASSERT_EQ(figure.curves.size(), 4U);
  EXPECT_DOUBLE_EQ(figure.curves[3].x.back(), 10'800.0);
  EXPECT_NEAR(figure.curves[3].y.back(), 6.5, 0.01);
}

TEST(ProfileFigure, MarksTheIntervalOfTheTimeConstant) {
  const Figure figure = profile_figure(fake_warm_up("x"), "x");
  ASSERT_EQ(figure.bands.size(), 1U);
  EXPECT_EQ(figure.bands[0].x, (std::vector<double>{862.0, 941.0}));
  EXPECT_EQ(figure.levels[0].y, 3.84);
  EXPECT_TRUE(profile_figure(fake_steps("x"), "x").bands.empty());
}

TEST(DriftHtml, ShowsLessOfEachTheMoreChannelsThereAre) {
  DriftReport report = fake_drift_report();
  report.runs = {fake_runs("acc_x")};
  // Two of the runs. x: drift, samples, profile, residuals and autocorrelation at 3 scales,
  // temperature. y: the same without one scale and the profile.
  EXPECT_EQ(count_of(to_html(describe(report)), "</svg>"), 2U + 10U + 8U);
  report.channels.assign(10, fake_steps("y"));
  EXPECT_EQ(count_of(to_html(describe(report)), "</svg>"), 2U + 10U);
  report.channels.assign(30, fake_steps("y"));
  EXPECT_EQ(count_of(to_html(describe(report)), "</svg>"), 2U);
}

TEST(DriftHtml, EscapesWhatTheUserNamed) {
  const DriftReport report = fake_drift_report();
  const std::string page = to_html(describe(report));
  EXPECT_TRUE(contains(page, "rest &lt;1&gt;.csv"));
  EXPECT_FALSE(contains(page, "rest <1>.csv"));
}

}  // namespace
}  // namespace proofmass::report::drift_report_test
