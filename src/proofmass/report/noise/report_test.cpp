#include "proofmass/report/noise/report.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>

#include "proofmass/report/noise/fake.hpp"
#include "proofmass/report/noise/figures.hpp"
#include "proofmass/report/noise/wording.hpp"

namespace proofmass::report::noise_report_test {
namespace {

using Json = nlohmann::ordered_json;

constexpr double ug = 1e-6 * standard_gravity_mps2;

bool says(const std::vector<std::string>& sentences, const std::string& part) {
  return std::ranges::any_of(
      sentences, [&](const std::string& s) { return s.find(part) != std::string::npos; });
}

Json parsed(const NoiseReport& report) {
  return Json::parse(to_json(describe(report)));
}

bool warns(const Json& document, const std::string& part) {
  return says(document["warnings"].get<std::vector<std::string>>(), part);
}

TEST(NoiseUnits, AreTheIntegralAndTheSlopeOfTheSeriesOwn) {
  const Unit accel = *parse_unit("m/s^2");
  EXPECT_EQ(noise_unit(accel, NoiseScale::integral), "m/s");
  EXPECT_EQ(noise_unit(accel, NoiseScale::slope), "m/s^3");
  EXPECT_EQ(noise_unit(accel, NoiseScale::density), "m/s^2/sqrt(Hz)");
  EXPECT_EQ(noise_unit(*parse_unit("V"), NoiseScale::walk), "V/sqrt(s)");
  EXPECT_EQ(noise_unit({}, NoiseScale::integral), "s");
  EXPECT_EQ(squared_unit(accel, NoiseScale::density), "m^2/s^3");
  EXPECT_EQ(squared_unit(accel, NoiseScale::walk), "m^2/s^5");
  EXPECT_EQ(squared_unit(*parse_unit("counts"), NoiseScale::level), "(counts)^2");
}

TEST(NoiseWords, GiveAccelerationsInMillionthsOfGUnlessThatIsHardToRead) {
  const Unit accel = *parse_unit("m/s^2");
  EXPECT_EQ(noise_words(Uncertain{75.2 * ug, 0.3 * ug}, accel, NoiseScale::density),
            "75.20 ± 0.30 µg/√Hz");
  EXPECT_EQ(noise_words(524.0 * ug, accel, NoiseScale::density), "524 µg/√Hz");
  EXPECT_EQ(noise_words(0.02 * ug, accel, NoiseScale::slope), "20.0 ng/s");
  EXPECT_EQ(noise_words(-0.3 * 1e6 * ug, accel, NoiseScale::level), "−300 mg");
  EXPECT_EQ(noise_words(2.0 * 1e7 * ug, accel, NoiseScale::level), "20.0 g");
}

TEST(NoiseWords, LeaveUnknownUnitsAlone) {
  EXPECT_EQ(noise_words(0.2922, {}, NoiseScale::density), "0.292 1/√Hz");
  EXPECT_EQ(noise_words(0.2922, {}, NoiseScale::level), "0.292");
  EXPECT_EQ(noise_words(3.0, *parse_unit("counts"), NoiseScale::walk), "3.00 counts/√s");
}

TEST(NoiseFindings, GiveLimitsAndTheRecordNeededForWhatIsNotIdentified) {
  const auto sentences = noise_findings(fake_channel("acc_x"));
  EXPECT_EQ(sentences[0], "White noise 75.20 ± 0.30 µg/√Hz.");
  EXPECT_TRUE(says(sentences, "Flicker noise (bias instability) 21.0 ± 2.0 µg"));
  EXPECT_TRUE(says(sentences,
                   "No random walk detected: below 1.20 µg/√s with 95 % confidence; identifying as "
                   "much needs 3 h of recording."));
  EXPECT_TRUE(says(sentences, "1 outlier and 1 step of level"));
}

TEST(NoiseFindings, WarnOfALineThatReadsAsWhiteNoise) {
  const auto sentences = noise_findings(fake_channel("acc_x"));
  EXPECT_TRUE(says(sentences, "A line at 0.562 Hz raises the deviation near 0.66 s by"));
  EXPECT_TRUE(says(sentences, "do not read the white noise off the curve there"));
}

TEST(NoiseFindings, OfARefusedChannelAreTheReason) {
  EXPECT_EQ(noise_findings(refused_channel("z")),
            (std::vector<std::string>{"Not analysed: the values do not vary."}));
}

TEST(EventTime, HasTheResolutionOfASample) {
  EXPECT_EQ(event_time_words({signal::EventKind::outlier, 1240, 1263, 1.0, 9.0}, 100.0),
            "12.40 … 12.63 s");
  EXPECT_EQ(event_time_words({signal::EventKind::step, 5, 5, 1.0, 9.0}, 1.0), "5 s");
}

TEST(NoiseFindings, GiveADriftAndItsSizeOverTheRecording) {
  ChannelNoise channel = fake_channel("acc_x");
  channel.analysis->model.ramp = identified(0.02 * ug, 0.001 * ug);
  channel.analysis->model.slope_per_s = -0.02 * ug;
  EXPECT_TRUE(says(noise_findings(channel),
                   "A steady drift of 20.0 ± 1.0 ng/s, −200 µg over the recording"));
}

TEST(LineEffect, IsWhereASineRaisesTheAllanVarianceMost) {
  const ChannelNoise channel = fake_channel("acc_x");
  const signal::SpectralLine& line = channel.analysis->lines.lines.front();
  const LineEffect effect = line_effect(*channel.analysis, line);
  const auto added = [&](double tau_s) {
    return characterise::sine_allan_variance(line.amplitude, line.frequency_hz, tau_s);
  };
  EXPECT_NEAR(effect.tau_s, 0.3710 / 0.562, 1e-4);
  EXPECT_GT(added(effect.tau_s), added(effect.tau_s * 1.02));
  EXPECT_GT(added(effect.tau_s), added(effect.tau_s / 1.02));
  const double noise = channel.analysis->model.allan_variance(effect.tau_s);
  EXPECT_NEAR(effect.raise, std::sqrt((noise + added(effect.tau_s)) / noise) - 1.0, 1e-12);
}

TEST(FlickerTau, IsTheMinimumOrBetweenTheWhiteNoiseAndTheEnd) {
  ChannelNoise channel = fake_channel("acc_x");
  characterise::NoiseAnalysis& analysis = *channel.analysis;
  const double meeting_s = std::pow(75.2 / 21.0, 2) / (2.0 * std::numbers::ln2 / std::numbers::pi);
  EXPECT_NEAR(*flicker_tau_s(analysis),
              std::sqrt(meeting_s * analysis.deviation.points.back().tau_s), 1e-6);
  analysis.model.random_walk = identified(5.0 * ug, 0.1 * ug);
  const double minimum_s = std::numbers::sqrt3 * 75.2 / 5.0;
  EXPECT_NEAR(std::log(*flicker_tau_s(analysis) / minimum_s), 0.0, 0.15);
  analysis.model.flicker = bounded(1.0, {});
  EXPECT_FALSE(flicker_tau_s(analysis));
}

TEST(NoiseJson, HasTheCurveTheCoefficientsAndBothDensities) {
  const Json json = parsed(fake_noise_report());
  const Json& channel = json["channels"][0];
  EXPECT_EQ(channel["deviation"]["statistic"], "oadev");
  EXPECT_EQ(channel["deviation"]["points"][0]["tau_s"], 0.01);
  EXPECT_DOUBLE_EQ(channel["parameters"]["white"]["value"].get<double>(), 75.2 * ug);
  EXPECT_DOUBLE_EQ(channel["parameters"]["white"]["one_sided_density"].get<double>(),
                   75.2 * ug * std::numbers::sqrt2);
  EXPECT_EQ(channel["parameters"]["random_walk"]["verdict"], "not_observable");
  EXPECT_EQ(channel["parameters"]["random_walk"]["value"], 0.0);
  EXPECT_EQ(channel["parameters"]["random_walk"]["record_needed_s"], 10'800.0);
  EXPECT_DOUBLE_EQ(channel["spectrum_floor_two_sided"]["value"].get<double>() * std::numbers::sqrt2,
                   channel["spectrum_floor"]["value"].get<double>());
  EXPECT_EQ(channel["lines"][0]["frequency_hz"], 0.562);
  EXPECT_EQ(channel["events"][0]["start_s"], 1200.0);
}

TEST(NoiseJson, GivesEstimatorsSquaresOfTheCoefficients) {
  const Json filter = parsed(fake_noise_report())["channels"][0]["filter"];
  const double N = 75.2 * ug, B = 21.0 * ug;
  EXPECT_DOUBLE_EQ(filter["sample_variance"]["value"].get<double>(), N * N * 100.0);
  EXPECT_DOUBLE_EQ(filter["white_psd"]["std"].get<double>(), 2.0 * N * 0.3 * ug);
  EXPECT_TRUE(filter["bias_psd"].is_null());
  const Json& markov = filter["flicker_as_markov"];
  EXPECT_NEAR(markov["psd"].get<double>() * markov["time_constant_s"].get<double>(),
              2.0 * B * B * std::numbers::ln2 / (std::numbers::pi * 0.4365 * 0.4365), 1e-15);
}

TEST(NoiseJson, ThinsTheSpectrumAndKeepsItsPower) {
  const NoiseReport report = fake_noise_report();
  const Json spectrum = parsed(report)["channels"][0]["spectrum"];
  const auto f = spectrum["frequency_hz"].get<std::vector<double>>();
  const auto psd = spectrum["one_sided_psd"].get<std::vector<double>>();
  ASSERT_EQ(f.size(), psd.size());
  EXPECT_LE(f.size(), 600U);
  EXPECT_TRUE(std::ranges::is_sorted(f));
  const auto& all = report.channels[0].analysis->spectrum;
  const double peak = *std::ranges::max_element(all.one_sided_psd);
  EXPECT_GT(*std::ranges::max_element(psd), 0.5 * peak);
}

TEST(NoiseJson, SaysWhyForEveryNull) {
  NoiseReport report = fake_noise_report();
  report.channels.push_back(refused_channel("acc_z"));
  const Json json = parsed(report);
  EXPECT_TRUE(json["channels"][1]["deviation"].is_null());
  EXPECT_TRUE(json["channels"][1]["parameters"].is_null());
  EXPECT_TRUE(warns(json, "acc_z: not analysed: the values do not vary"));
  EXPECT_TRUE(warns(json, "channels[1] (acc_z): stationarity, deviation, parameters"));
  EXPECT_TRUE(warns(json, "parameters.quantisation.record_needed_s: null"));
  EXPECT_TRUE(warns(json, "(acc_x): bandwidth_hz: null"));
  EXPECT_TRUE(warns(json, "filter.bias_psd: null"));
}

TEST(NoiseJson, HasTheLag1TypeOnlyWhereItWasAskedFor) {
  NoiseReport report = fake_noise_report();
  const auto point = [&] { return parsed(report)["channels"][0]["deviation"]["points"][0]; };
  EXPECT_FALSE(point().contains("alpha_lag1"));
  report.channels[0].analysis->deviation.points[0].alpha_lag1 = -1;
  EXPECT_EQ(point()["alpha_lag1"], -1);
  const std::size_t others = report.channels[0].analysis->deviation.points.size() - 1;
  EXPECT_TRUE(warns(parsed(report), "channels[].deviation.points[]: alpha_lag1: null (" +
                                        std::to_string(others) + " times): needs 30 averages"));
}

TEST(NoiseReports, OfARecordTooShortForCoefficientsGiveTheDeviationAlone) {
  NoiseReport report = fake_noise_report();
  characterise::NoiseAnalysis& analysis = *report.channels[0].analysis;
  analysis.model = {};
  analysis.spectrum = {};
  analysis.lines = {};
  analysis.deviation.points.resize(3);
  const Json json = parsed(report);
  EXPECT_TRUE(json["channels"][0]["parameters"].is_null());
  EXPECT_TRUE(json["channels"][0]["spectrum"].is_null());
  EXPECT_EQ(json["channels"][0]["deviation"]["points"].size(), 3U);
  EXPECT_TRUE(warns(json, "parameters, slow_change, bandwidth_hz, misfit, filter: null"));
  const std::string text = to_text(describe(report));
  EXPECT_NE(text.find("Too short for coefficients"), std::string::npos);
  EXPECT_NE(text.find("68.3 % limits"), std::string::npos);
  EXPECT_EQ(text.find("White noise"), std::string::npos);
  EXPECT_NE(to_html(describe(report)).find("</html>"), std::string::npos);
}

TEST(NoiseSeries, HasOneRowForEachTauAndThreeColumnsForEachChannel) {
  NoiseReport report = fake_noise_report();
  report.channels.push_back(refused_channel("acc_y"));
  report.channels.push_back(fake_channel("acc_z"));
  report.channels.back().analysis->deviation.points.pop_back();
  const Recording table = noise_series(report);
  ASSERT_EQ(table.channels.size(), 7U);
  EXPECT_EQ(table.channels[0].name, "tau_s");
  EXPECT_EQ(table.channels[4].name, "acc_z");
  EXPECT_EQ(table.channels[0].values.size(), report.channels[0].analysis->deviation.points.size());
  EXPECT_TRUE(std::isnan(table.channels[4].values.back()));
  EXPECT_TRUE(std::isfinite(table.channels[1].values.back()));
}

TEST(NoiseText, HasTheResultOfEachChannelOrWhyThereIsNone) {
  NoiseReport report = fake_noise_report();
  report.channels.push_back(refused_channel("acc_z"));
  const std::string text = to_text(describe(report));
  EXPECT_NE(
      text.find(
          "acc_x:\n  1\u202f000\u202f000 samples at 100 Hz, 2 h 47 min, 120 of them missing."),
      std::string::npos)
      << text;
  EXPECT_NE(text.find("0, below 1.20 µg/√s (95 %)"), std::string::npos);
  EXPECT_NE(text.find("acc_z:\n  - Not analysed: the values do not vary"), std::string::npos);
}

TEST(NoiseConclusion, OfSeveralChannelsPutsTheirWhiteNoiseSideBySide) {
  NoiseReport report = fake_noise_report();
  report.channels.push_back(refused_channel("acc_z"));
  EXPECT_EQ(describe(report).page.conclusion,
            "White noise: acc_x 75.20 ± 0.30 µg/√Hz; acc_z not analysed.");
}

TEST(NoiseNotes, MakeARefusalBadData) {
  NoiseReport report = fake_noise_report();
  report.channels.push_back(refused_channel("acc_z"));
  EXPECT_EQ(describe(report).page.notes.back().severity, Severity::bad);
}

TEST(NoiseReports, FailOnlyIfNoChannelCouldBeAnalysed) {
  NoiseReport report = fake_noise_report();
  report.channels.push_back(refused_channel("acc_z"));
  EXPECT_EQ(describe(report).failure, "");
  report.channels.erase(report.channels.begin());
  EXPECT_EQ(describe(report).failure, "no channel can be analysed: acc_z: the values do not vary");
}

TEST(NoiseText, OfASingleChannelDoesNotRepeatTheConclusion) {
  const NoiseReport report = fake_noise_report();
  const std::string text = to_text(describe(report));
  EXPECT_EQ(text.find("No random walk detected"), text.rfind("No random walk detected"));
  EXPECT_NE(text.find("- A line at 0.562 Hz"), std::string::npos);
}

TEST(NoiseFigures, MarkEachTermWhereItIsRead) {
  const Figure figure = deviation_figure(fake_channel("acc_x"));
  ASSERT_EQ(figure.callouts.size(), 2U);
  EXPECT_DOUBLE_EQ(figure.callouts[0].x, 1.0);
  EXPECT_NEAR(figure.callouts[0].y, 75.2, 1e-9);
  EXPECT_EQ(figure.callouts[0].text, "N = 75.2 µg/√Hz, read at 1 s");
  EXPECT_NEAR(figure.callouts[1].y, 0.6643 * 21.0, 0.01);
}

TEST(NoiseFigures, DrawNoAllanTermsUnderAnotherStatistic) {
  ChannelNoise channel = fake_channel("acc_x");
  channel.analysis->deviation.statistic = characterise::Statistic::mdev;
  const Figure figure = deviation_figure(channel);
  EXPECT_TRUE(figure.callouts.empty());
  EXPECT_EQ(figure.curves.size(), 1U);
}

TEST(NoiseHtml, HasTwoFiguresForEachChannelAndNoneForARefusedOne) {
  NoiseReport report = fake_noise_report();
  report.channels.push_back(refused_channel("acc_z"));
  const std::string page = to_html(describe(report));
  std::size_t figures = 0;
  for (std::size_t at = page.find("</svg>"); at != std::string::npos;
       at = page.find("</svg>", at + 1)) {
    ++figures;
  }
  EXPECT_EQ(figures, 2U);
  EXPECT_NE(page.find("rest &lt;1&gt;.csv"), std::string::npos);
}

TEST(NoiseReports, SayFirstThatTheSensorMoved) {
  NoiseReport report = fake_noise_report();
  report.channels.front().rest =
      RestShare{.share = 0.12, .longest_start_s = 3.0, .longest_end_s = 8.5};
  const Document document = describe(report);
  EXPECT_EQ(document.page.conclusion.find("Not at rest: only 12 %"), 0U);
  EXPECT_NE(document.page.conclusion.find("--from 3.00 --to 8.50"), std::string::npos);
  EXPECT_EQ(to_text(document).find(document.page.conclusion), 0U);
  EXPECT_FALSE(texts(document.page.notes, Severity::bad).empty());
}

TEST(NoiseReports, SayFirstThatTheNoiseChanges) {
  NoiseReport report = fake_noise_report();
  characterise::NoiseAnalysis& analysis = *report.channels.front().analysis;
  analysis.stationarity = {.tested = true,
                           .stationary = false,
                           .p = 1e-9,
                           .averaging_s = 0.01,
                           .line_hz = std::nullopt,
                           .relative_level = {0.7, 1.4}};
  analysis.parts = {{0.0, 5000.0, analysis.model}, {5000.0, 10'000.0, analysis.model}};
  EXPECT_EQ(describe(report).page.conclusion.find("Not stationary"), 0U);
  EXPECT_NE(to_html(describe(report)).find("white noise over time"), std::string::npos);
  EXPECT_EQ(parsed(report)["channels"][0]["stationarity"]["verdict"], "not_stationary");
}

TEST(NoiseReports, GiveAGyroscopesNoiseInTheUnitsOfItsMakers) {
  const Unit rate = *parse_unit("rad/s");
  const double deg = rad_per_deg;
  EXPECT_EQ(noise_words(0.005 * deg, rate, NoiseScale::density), "0.300 °/√h");
  EXPECT_EQ(noise_words(deg / 3600.0 * 7.0, rate, NoiseScale::level), "7.00 °/h");
}

}  // namespace
}  // namespace proofmass::report::noise_report_test
