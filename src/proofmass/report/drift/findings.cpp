#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/report/drift/wording.hpp"
#include "proofmass/report/noise/wording.hpp"
#include "proofmass/report/wording.hpp"

// Findings for a channel and for a set of runs.
namespace proofmass::report {
namespace {

using characterise::DriftAnalysis;
using characterise::DriftFit;
using characterise::DriftNoise;
using characterise::RunSet;
using signal::WhitenessTest;

using Sentences = std::vector<std::string>;

// "1 s", "1 s and 10 s", "1 s, 10 s and 100 s"
std::string scales_words(const std::vector<const WhitenessTest*>& tests) {
  std::string text;
  for (const WhitenessTest* test : tests) {
    text += (text.empty()           ? ""
             : test == tests.back() ? " and "
                                    : ", ") +
            duration_words(test->scale_s);
  }
  return text;
}

std::string inside_words(const WhitenessTest& test) {
  return fmt::format("{} % of lags inside the bounds", fixed(100.0 * test.inside_bounds, 0));
}

std::string sentence(std::string words) {
  if (!words.empty() && words[0] >= 'a' && words[0] <= 'z') {
    words[0] = static_cast<char>(words[0] - 'a' + 'A');
  }
  return words + (words.ends_with('.') ? "" : ".");
}

void add_tests(const ChannelDrift& channel, Sentences& sentences) {
  const DriftAnalysis& analysis = *channel.analysis;
  const DriftFit& fit = analysis.fit;
  sentences.push_back(fmt::format(
      "Probability of as large a gain of the exponential by chance: {} over a constant, "
      "{} over a straight line.",
      p_words(fit.constant_p), p_words(fit.line_p)));
  if (fit.identified || !(fit.undetected_below > 0.0) || !std::isfinite(fit.undetected_below))
    return;
  sentences.push_back(fmt::format(
      "With 95 % confidence there is no warm-up of more than {} with a time constant "
      "of {}, a fifth of the recording.",
      bias_words(fit.undetected_below, channel.unit), duration_words(analysis.duration_s / 5.0)));
}

void add_noise(const ChannelDrift& channel, Sentences& sentences) {
  const DriftNoise& noise = channel.analysis->fit.noise;
  std::string parts;
  const auto add = [&](const std::string& part) { parts += (parts.empty() ? "" : ", ") + part; };
  const Unit& unit = channel.unit;
  if (noise.white > 0.0) add("white " + noise_words(noise.white, unit, NoiseScale::density));
  if (noise.flicker > 0.0) add("flicker " + noise_words(noise.flicker, unit, NoiseScale::level));
  if (noise.random_walk > 0.0) {
    add("random walk " + noise_words(noise.random_walk, unit, NoiseScale::walk));
  }
  if (noise.markov > 0.0) {
    add(fmt::format("first-order Markov {} rms over {}",
                    noise_words(noise.markov_std(), unit, NoiseScale::level),
                    duration_words(noise.markov_time_constant_s)));
  }
  if (parts.empty()) return;
  sentences.push_back("Noise model of the intervals: " + parts + ".");
}

void add_temperature(const ChannelDrift& channel, Sentences& sentences) {
  if (!channel.temperature) return;
  const DriftTemperature& found = *channel.temperature;
  if (!found.model) {
    sentences.push_back(fmt::format("No curve against {}: {}.", found.channel, found.refused));
    return;
  }
  const characterise::TemperatureModel& model = *found.model;
  if (model.verdict != characterise::Verdict::identified) {
    sentences.push_back(sentence(
        fmt::format("No dependence on {} is identified: {}", found.channel, model.reason)));
    return;
  }
  sentences.push_back(
      fmt::format("Depends on {} as a polynomial of degree {}: {} between {} and {} °C.",
                  found.channel, model.degree, bias_words(model.bias_span, channel.unit),
                  fixed(model.lowest_k - 273.15, 1), fixed(model.highest_k - 273.15, 1)));
  if (model.hysteresis && model.hysteresis_significant) {
    sentences.push_back(
        fmt::format("Hysteresis: {} more on heating than on cooling at the same temperature.",
                    bias_words(*model.hysteresis, channel.unit)));
  }
}

void add_outlook(const ChannelDrift& channel, Sentences& sentences) {
  if (!channel.outlook) return;
  if (!channel.outlook->forecast) {
    sentences.push_back("No forecast: " + channel.outlook->refused + ".");
    return;
  }
  const characterise::DriftForecast& later = *channel.outlook->forecast;
  sentences.push_back(fmt::format(
      "{} after power-on: {} {} (95 %: {}), a change of {} since the end of the recording.",
      duration_words(later.t_s), holds_gravity(later.bias) ? "level" : "bias",
      bias_words(later.bias, channel.unit), bias_interval_words(later.bias, channel.unit),
      bias_words(later.change, channel.unit)));
}

// Warm-up over the runs, with times in runs.
void add_level_curve(const ChannelRuns& runs, Sentences& sentences) {
  const RunSet& set = *runs.set;
  if (!set.level_curve) return;
  const DriftFit& fit = *set.level_curve;
  if (fit.identified) {
    sentences.push_back(fmt::format(
        "The level warms up over the runs: {} with a time constant of {} (95 %: {}), from {} in "
        "the first run.",
        bias_words(*fit.a1, runs.unit),
        with_std(Uncertain{fit.time_constant_s->value, fit.time_constant_s->std}, "runs"),
        runs_interval_words(*fit.time_constant_s), bias_words(fit.a2, runs.unit)));
    return;
  }
  if (fit.why == characterise::DriftReason::shape_undetermined)
    sentences.push_back(
        fmt::format("The level warms up over the runs, by {} from the first to the last; the shape "
                    "of that curve cannot be determined from these runs.",
                    bias_words(fit.curve.value(fit.end.t_s) - fit.curve.value(0.0), runs.unit)));
}

void add_trend(const ChannelRuns& runs, Sentences& sentences) {
  const RunSet& set = *runs.set;
  if (!set.trend_per_run) return;
  constexpr double significant_p = 0.05;
  sentences.push_back(
      set.trend_p < significant_p
          ? fmt::format("The level changes by {} per run, in the order of the files (p = {}).",
                        bias_words(*set.trend_per_run, runs.unit), p_words(set.trend_p))
          : fmt::format("No trend from run to run, in the order of the files: {} per run (p = {}).",
                        bias_words(*set.trend_per_run, runs.unit), p_words(set.trend_p)));
}

}  // namespace

std::string whiteness_sentence(const DriftAnalysis& analysis) {
  std::vector<const WhitenessTest*> white, coloured;
  for (const WhitenessTest& test : analysis.whiteness) {
    (test.white ? white : coloured).push_back(&test);
  }
  if (white.empty() && coloured.empty()) return "Too short to test the residuals for whiteness.";
  if (coloured.empty()) return "Residuals at " + scales_words(white) + " white.";
  const WhitenessTest& worst =
      **std::ranges::min_element(coloured, {}, &WhitenessTest::inside_bounds);
  std::string text = white.empty()
                         ? fmt::format("Residuals at {} not white", scales_words(coloured))
                         : fmt::format("Residuals at {} white, at {} not", scales_words(white),
                                       scales_words(coloured));
  text += fmt::format(": {}{} (95 % if white)", inside_words(worst),
                      coloured.size() > 1 ? " at " + duration_words(worst.scale_s) : "");
  if (!analysis.whitened)
    return text + "; whether the noise model accounts for it cannot be tested.";
  if (analysis.noise_explained) return text + "; the noise model accounts for it.";
  return text + fmt::format(
                    "; the noise model does not account for all of it ({} after it): the intervals "
                    "may be too narrow.",
                    inside_words(*analysis.whitened));
}

std::vector<std::string> drift_findings(const ChannelDrift& channel) {
  if (!channel.analysis) return {sentence(why_not_analysed(channel))};
  Sentences sentences;
  if (std::string moving = motion_sentence(channel.rest, "drift"); !moving.empty())
    sentences.push_back(std::move(moving));
  sentences.push_back(sentence(drift_verdict(channel)));
  add_tests(channel, sentences);
  sentences.push_back(whiteness_sentence(*channel.analysis));
  add_noise(channel, sentences);
  add_temperature(channel, sentences);
  add_outlook(channel, sentences);
  const std::size_t outliers = channel.analysis->outliers.size();
  if (outliers > 0) sentences.push_back(count_words(outliers, "outlier") + " excluded.");
  return sentences;
}

std::vector<std::string> run_findings(const ChannelRuns& runs) {
  if (!runs.set) return {"Not compared: " + runs.refused + "."};
  const RunSet& set = *runs.set;
  Sentences sentences;
  sentences.push_back(fmt::format("Turn-on repeatability, from the first {}: {}.",
                                  duration_words(set.window_s),
                                  scatter_words(set.turn_on, runs.unit)));
  sentences.push_back(
      fmt::format("Scatter of the levels: {}.", scatter_words(set.level, runs.unit)));
  add_trend(runs, sentences);
  add_level_curve(runs, sentences);
  ChannelDrift common;
  common.unit = runs.unit;
  common.analysis = set.warm_up;
  sentences.push_back("Common to all runs: " + drift_verdict(common) + ".");
  return sentences;
}

}  // namespace proofmass::report
