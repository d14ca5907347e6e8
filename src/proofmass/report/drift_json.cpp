#include "proofmass/report/drift_json.hpp"

#include <cmath>

#include "proofmass/report/drift_nulls.hpp"
#include "proofmass/report/drift_wording.hpp"
#include "proofmass/report/noise_wording.hpp"

namespace proofmass::report {
namespace {

using characterise::DriftAnalysis;
using characterise::DriftFit;
using characterise::DriftNoise;
using characterise::Interval95;
using signal::WhitenessTest;

Object whiteness(const WhitenessTest& test) {
  return {{"scale_s", test.scale_s},
          {"ljung_box_p", test.ljung_box_p},
          {"inside_bounds", test.inside_bounds},
          {"values", test.values},
          {"lags", test.lags},
          {"bound", test.bound},
          {"ljung_box", test.ljung_box},
          {"periodogram_p", test.periodogram_p},
          {"periodogram_excess", test.periodogram_excess},
          {"runs_p", test.runs_p},
          {"runs_z", test.runs_z},
          {"white", test.white}};
}

Object strength(double value, const Unit& unit, NoiseScale scale) {
  return {{"value", value}, {"unit", noise_unit(unit, scale)}};
}

Object noise(const DriftNoise& found, const Unit& unit) {
  Object markov = strength(found.markov, unit, NoiseScale::walk);
  markov.push_back({"time_constant_s", found.markov_time_constant_s});
  markov.push_back({"std_of_process", found.markov > 0.0 ? found.markov_std() : 0.0});
  return {{"white", strength(found.white, unit, NoiseScale::density)},
          {"flicker", strength(found.flicker, unit, NoiseScale::level)},
          {"random_walk", strength(found.random_walk, unit, NoiseScale::walk)},
          {"markov", std::move(markov)}};
}

Array candidates(const DriftFit& fit) {
  Array items;
  for (const characterise::DriftCandidate& tried : fit.candidates) {
    Object item{{"model", characterise::name_of(tried.shape)},
                {"parameters", tried.parameters},
                {"log_likelihood", tried.log_likelihood},
                {"information_criterion", tried.information_criterion},
                {"steps", tried.steps}};
    if (tried.time_constant_s) item.push_back({"time_constant_s", *tried.time_constant_s});
    items.emplace_back(std::move(item));
  }
  return items;
}

// What fits as well where the shape is not determined.
Array possible_models(const DriftFit& fit) {
  Array items;
  for (const characterise::DriftPossibility& one : fit.possibilities) {
    items.emplace_back(
        Object{{"model", characterise::name_of(one.curve.shape)}, {"weight", one.weight}});
  }
  return items;
}

Array profile(const DriftFit& fit) {
  Array items;
  for (const characterise::ProfilePoint& point : fit.profile) {
    if (!std::isfinite(point.deviance)) continue;
    items.emplace_back(
        Object{{"time_constant_s", point.time_constant_s}, {"deviance", point.deviance}});
  }
  return items;
}

Array steps(const DriftFit& fit, const std::string& unit) {
  Array items;
  for (const characterise::DriftStep& step : fit.curve.steps) {
    items.emplace_back(Object{{"t_s", step.t_s}, {"size", quantity(step.size, unit)}});
  }
  return items;
}

Array knocks(const DriftAnalysis& analysis, const std::string& unit) {
  Array items;
  for (const signal::Event& event : analysis.knocks) {
    const auto at_s = [&](std::size_t sample) {
      return analysis.start_s + static_cast<double>(sample) / analysis.rate_hz;
    };
    items.emplace_back(Object{{"start_s", at_s(event.first)},
                              {"end_s", at_s(event.last)},
                              {"size", event.size},
                              {"unit", unit},
                              {"significance", event.significance}});
  }
  return items;
}

// What only some shapes have, and only some fits can bound.
void add_rarer(const DriftFit& fit, const Unit& unit, Object& item) {
  const std::string level = noise_unit(unit, NoiseScale::level);
  if (fit.slope_per_s) {
    item.push_back(
        {"slope_per_s", interval_quantity(fit.slope_per_s, noise_unit(unit, NoiseScale::slope))});
  }
  if (fit.second_a1) {
    item.push_back(
        {"second_exponential",
         Object{{"a1", interval_quantity(fit.second_a1, level)},
                {"time_constant_s", interval_quantity(fit.second_time_constant_s, "s")}}});
  }
  if (fit.time_constant_above_s) {
    item.push_back({"time_constant_above_s", *fit.time_constant_above_s});
  }
  if (fit.time_constant_below_s) {
    item.push_back({"time_constant_below_s", *fit.time_constant_below_s});
  }
}

Object intervals(const DriftFit& fit) {
  Object item{{"a1", interval_value(fit.a1)},
              {"a2", interval_value(fit.a2)},
              {"time_constant_s", interval_value(fit.time_constant_s)}};
  if (fit.slope_per_s) item.push_back({"slope_per_s", interval_value(fit.slope_per_s)});
  if (fit.second_a1) {
    item.push_back({"second_a1", interval_value(fit.second_a1)});
    item.push_back({"second_time_constant_s", interval_value(fit.second_time_constant_s)});
  }
  return item;
}

void add_fit_keys(const DriftAnalysis& analysis, const Unit& unit, Object& item) {
  const DriftFit& fit = analysis.fit;
  const std::string level = noise_unit(unit, NoiseScale::level);
  const auto add = [&](const char* key, Value value) { item.push_back({key, std::move(value)}); };
  add("model", characterise::name_of(fit.curve.shape));
  add("a1", interval_quantity(fit.a1, level));
  add("a2", interval_quantity(fit.a2, level));
  add("time_constant_s", interval_quantity(fit.time_constant_s, "s"));
  add("bears_gravity", costs_position(unit) && holds_gravity(fit.a2));
  add("possible_models", possible_models(fit));
  add("interval_95", intervals(fit));
  add("residual_rms", analysis.residual_rms);
  add("tests", Object{{"constant_deviance", fit.constant_deviance},
                      {"constant_p", fit.constant_p},
                      {"line_deviance", fit.line_deviance},
                      {"line_p", fit.line_p}});
  add("noise", noise(fit.noise, unit));
  add("whitened", analysis.whitened ? Value(whiteness(*analysis.whitened)) : Value());
  add("rate_hz", analysis.rate_hz);
  add("samples", analysis.samples);
  add("missing", analysis.missing);
  add("start_s", analysis.start_s);
  add("duration_s", analysis.duration_s);
  add("block_s", analysis.block_s);
  add("undetected_below", fit.undetected_below);
  add("best_time_constant_s", fit.best_time_constant_s);
  add_rarer(fit, unit, item);
}

Array whiteness_items(const DriftAnalysis& analysis) {
  Array items;
  for (const WhitenessTest& test : analysis.whiteness) items.emplace_back(whiteness(test));
  return items;
}

}  // namespace

Value interval_value(const std::optional<Interval95>& figure) {
  if (!figure) return nullptr;
  const auto end = [](const std::optional<double>& x) { return x ? Value(*x) : Value(); };
  return Array{end(figure->lower_95), end(figure->upper_95)};
}

Value interval_quantity(const std::optional<Interval95>& figure, std::string_view unit) {
  if (!figure) return nullptr;
  return quantity(Uncertain{figure->value, figure->std}, unit);
}

Object drift_object(const ChannelDrift& channel) {
  const std::string unit = noise_unit(channel.unit, NoiseScale::level);
  Object item{{"name", channel.name}, {"file", channel.file}, {"unit", unit}};
  const auto add = [&](const char* key, Value value) { item.push_back({key, std::move(value)}); };
  const bool identified = channel.analysis && channel.analysis->fit.identified;
  add("verdict", identified ? "identified" : "not_identified");
  if (channel.analysis) {
    const DriftFit& fit = channel.analysis->fit;
    add("reason", !fit.reason.empty() || identified ? fit.reason : drift_verdict(channel));
    add("reason_code", reason_code(fit.why));
    add_fit_keys(*channel.analysis, channel.unit, item);
    add("steps", steps(fit, unit));
    add("whiteness", whiteness_items(*channel.analysis));
    add("candidates", candidates(fit));
    add("profile", profile(fit));
    add("knocks", knocks(*channel.analysis, unit));
  } else {
    add("reason", "not analysed: " + channel.refused);
    add("reason_code", "not_analysed");
    for (const char* key : drift_keys) add(key, nullptr);
    for (const char* key : {"steps", "whiteness", "candidates", "profile", "knocks"}) {
      add(key, Array{});
    }
  }
  if (channel.temperature)
    add("temperature", temperature_value(*channel.temperature, channel.unit));
  if (channel.outlook) add("forecast", forecast_value(*channel.outlook, channel.unit));
  return item;
}

std::string drift_json(const DriftReport& report) {
  const std::vector<Note> notes = drift_notes(report);
  std::vector<std::string> warnings = texts(notes, Severity::warning);
  const auto warn = [&](const std::vector<std::string>& reasons) {
    warnings.insert(warnings.end(), reasons.begin(), reasons.end());
  };
  Array channels, runs;
  for (const ChannelDrift& channel : report.channels) {
    Object item = drift_object(channel);
    item.push_back(json_of({rest_field(channel.rest)}).front());
    channels.emplace_back(std::move(item));
    warn(null_reasons(report, channel));
  }
  for (const ChannelRuns& found : report.runs) {
    runs.emplace_back(runs_object(found));
    warn(null_reasons(found));
  }
  std::vector<std::string> infos;
  for (const Note& note : notes) {
    if (note.severity == Severity::info) infos.push_back(note.text);
  }
  Object body{{"channels", std::move(channels)},
              {"runs", std::move(runs)},
              {"since_switch_on_s", report.since_switch_on_s}};
  if (report.forecast_s) body.push_back({"forecast_s", *report.forecast_s});
  body.push_back({"notes", array_of(infos)});
  return to_json({"drift", report.inputs, warnings}, body);
}

}  // namespace proofmass::report
