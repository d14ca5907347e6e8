#include "proofmass/report/drift_nulls.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "proofmass/report/drift_wording.hpp"

namespace proofmass::report {
namespace {

using characterise::DriftFit;
using characterise::Interval95;

using Say = std::function<void(const std::string&)>;

template <class Keys>
std::string names(const Keys& keys) {
  std::string text;
  for (const char* key : keys) text += (text.empty() ? "" : ", ") + std::string(key);
  return text;
}

void explain(const char* key, const std::optional<Interval95>& figure, const Say& say) {
  if (!figure) return;
  const std::string name(key);
  if (!std::isfinite(figure->value) || !std::isfinite(figure->std)) {
    say(name + ": null: the recording leaves it without a standard deviation");
  }
  if (!figure->lower_95 && !figure->upper_95) {
    say("interval_95: " + name + ": both ends null: the recording does not bound it");
  } else if (!figure->lower_95 || !figure->upper_95) {
    say("interval_95: " + name + (figure->lower_95 ? ": upper" : ": lower") +
        " end null: the recording does not bound it");
  }
}

void explain_fit(const ChannelDrift& channel, const Say& say) {
  const DriftFit& fit = channel.analysis->fit;
  if (!fit.identified) {
    say("null for a1, time_constant_s and their interval_95: " + drift_verdict(channel));
  }
  explain("a1", fit.a1, say);
  explain("a2", fit.a2, say);
  explain("time_constant_s", fit.time_constant_s, say);
  explain("slope_per_s", fit.slope_per_s, say);
  explain("second_exponential: a1", fit.second_a1, say);
  explain("second_exponential: time_constant_s", fit.second_time_constant_s, say);
  if (!std::isfinite(fit.undetected_below)) {
    say("undetected_below: null: the recording bounds no warm-up");
  }
  if (!channel.analysis->whitened) {
    say("whitened: null: there are too few blocks to test the noise model with");
  }
}

void explain_temperature(const DriftTemperature& found, const Say& say) {
  if (!found.model)
    return say("temperature: null: no curve against " + found.channel + ": " + found.refused);
  if (!found.model->hysteresis) {
    say("temperature: hysteresis: null: heating and cooling do not share enough of the range");
  }
  if (!found.model->slope_upper_95) {
    say("temperature: slope_upper_95: null: the temperature spans too little");
  }
}

void explain_outlook(const ChannelDrift& channel, const Say& say) {
  const DriftOutlook& outlook = *channel.outlook;
  if (!outlook.forecast) return say("forecast: null: " + outlook.refused);
  explain("forecast: bias", outlook.forecast->bias, say);
  explain("forecast: change", outlook.forecast->change, say);
  if (!costs_position(channel.unit)) {
    return say(
        "forecast: null for position_error_m and position_error_uncorrected_m: the series "
        "is no acceleration in m/s^2");
  }
  if (holds_gravity(outlook.forecast->bias)) {
    say("forecast: position_error_uncorrected_m: null: the level holds gravity, which is no bias");
  }
}

void explain_scatter(const char* key, const characterise::RunScatter& scatter, const Say& say) {
  const Interval95& between = scatter.between_std;
  if (between.lower_95 && between.upper_95) return;
  say(std::string(key) + ": between_std: an end of interval_95 is null: the runs do not bound it");
}

}  // namespace

std::vector<std::string> null_reasons(const DriftReport& report, const ChannelDrift& channel) {
  std::vector<std::string> reasons;
  const std::string label = channel_label(report, channel);
  const Say say = [&](const std::string& sentence) { reasons.push_back(label + ": " + sentence); };
  if (channel.analysis) {
    explain_fit(channel, say);
  } else {
    say("null for " + names(drift_keys) + ", because it was not analysed: " + channel.refused);
  }
  for (const std::string& reason : reasons_for_nulls({rest_field(channel.rest)})) say(reason);
  if (channel.temperature) explain_temperature(*channel.temperature, say);
  if (channel.outlook) explain_outlook(channel, say);
  return reasons;
}

std::vector<std::string> null_reasons(const ChannelRuns& runs) {
  std::vector<std::string> reasons;
  const Say say = [&](const std::string& sentence) {
    reasons.push_back(runs.name + ": runs: " + sentence);
  };
  if (!runs.set) {
    say("null for " + names(run_set_keys) + ", because they were not compared: " + runs.refused);
    return reasons;
  }
  explain_scatter("turn_on", runs.set->turn_on, say);
  explain_scatter("level", runs.set->level, say);
  if (!runs.set->trend_per_run) say("trend_per_run: null: too few runs for a trend");
  if (!runs.set->level_curve) {
    say("level_curve: null: too few runs for a curve over them, or they do not differ");
  } else if (!runs.set->level_curve->identified) {
    say("level_curve: null for a1, time_constant_runs and their interval_95: " +
        runs.set->level_curve->reason);
  }
  ChannelDrift common;
  common.unit = runs.unit;
  common.analysis = runs.set->warm_up;
  explain_fit(common, [&](const std::string& sentence) { say("warm_up: " + sentence); });
  return reasons;
}

}  // namespace proofmass::report
