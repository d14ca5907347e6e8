#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/report/drift_figures.hpp"
#include "proofmass/report/drift_report.hpp"
#include "proofmass/report/drift_tables.hpp"
#include "proofmass/report/drift_wording.hpp"
#include "proofmass/report/noise_wording.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using characterise::DriftAnalysis;
using characterise::DriftFit;
using characterise::Interval95;
using characterise::RunSet;
using characterise::TemperatureModel;
using signal::WhitenessTest;

std::optional<Uncertain> uncertain(const std::optional<Interval95>& figure) {
  if (!figure) return std::nullopt;
  return Uncertain{figure->value, figure->std};
}

// `about` has the reason why there is no figure; one without a finite standard deviation is null,
// too.
Field estimate(const char* key,
               const std::optional<Interval95>& figure,
               const std::string& unit,
               About about) {
  if (figure) about.why_null = "its standard deviation is not determined";
  return field::measured(key, uncertain(figure), unit, std::move(about));
}

// [lower, upper]; null with a reason where there may be no figure.
Field interval(const char* key,
               const std::optional<Interval95>& figure,
               const std::string& why,
               std::string meaning = {}) {
  const About open{.why_null = "the recording does not bound it"};
  const Interval95 ends = figure.value_or(Interval95{});
  Field both = field::fixed_list(
      key, {field::number({}, ends.lower_95, open), field::number({}, ends.upper_95, open)},
      {.meaning = std::move(meaning)});
  both.shape.nullable = !why.empty();
  return figure ? both : field::without_value(std::move(both), why);
}

Field shape(characterise::DriftShape shape, std::string meaning = {}) {
  return field::choice(
      "model", characterise::name_of(shape),
      {"constant", "line", "steps", "exponential", "exponential_and_line", "two_exponentials",
       "square_root", "logarithm", "hyperbola", "stretched_exponential", "sine"},
      {.meaning = std::move(meaning)});
}

Field verdict(bool identified) {
  return field::choice("verdict", identified ? "identified" : "not_identified",
                       {"identified", "not_identified"});
}

Field reason_field(std::string_view code) {
  return field::choice("reason_code", code,
                       {"identified", "no_warm_up", "hidden_by_noise", "steps", "line",
                        "longer_than_record", "shorter_than_resolved", "begun_later",
                        "shape_undetermined", "swing", "unexplained", "not_analysed"});
}

Fields whiteness_fields(const WhitenessTest& test) {
  return {
      field::magnitude("scale_s", test.scale_s, {.meaning = "length of the blocks"}),
      field::probability("ljung_box_p", test.ljung_box_p, {.meaning = "correlation at short lags"}),
      field::probability("inside_bounds", test.inside_bounds,
                         {.meaning = "share of the lags within the bound; 0.95 if white"}),
      field::count("values", test.values, {.meaning = "block means"}),
      field::count("lags", test.lags),
      field::magnitude("bound", test.bound, {.meaning = "1.96/sqrt(values)"}),
      field::number("ljung_box", test.ljung_box, {.meaning = "Q"}),
      field::probability("periodogram_p", test.periodogram_p,
                         {.meaning = "cumulative periodogram: power concentrated in a band"}),
      field::number("periodogram_excess", test.periodogram_excess),
      field::probability("runs_p", test.runs_p, {.meaning = "runs of sign"}),
      field::number("runs_z", test.runs_z),
      field::flag("white", test.white,
                  {.meaning = "none of the three is rejected at a joint level of 5 %"})};
}

Field strength(const char* key, double value, const Unit& unit, NoiseScale scale) {
  return field::object(
      key, {field::magnitude("value", value), field::text("unit", noise_unit(unit, scale))});
}

Field noise(const characterise::DriftNoise& found, const Unit& unit) {
  Field markov = strength("markov", found.markov, unit, NoiseScale::walk);
  markov.fields->push_back(field::magnitude("time_constant_s", found.markov_time_constant_s));
  markov.fields->push_back(
      field::magnitude("std_of_process", found.markov > 0.0 ? found.markov_std() : 0.0));
  return field::object(
      "noise",
      {strength("white", found.white, unit, NoiseScale::density),
       strength("flicker", found.flicker, unit, NoiseScale::level),
       strength("random_walk", found.random_walk, unit, NoiseScale::walk), std::move(markov)},
      {.meaning = "of the measurements about the curve, fitted with it; 0 where not needed"});
}

Field possible_models(const DriftFit& fit) {
  return field::records(
      "possible_models", fit.possibilities,
      [](const characterise::DriftPossibility& one) -> Fields {
        return {shape(one.curve.shape), field::magnitude("weight", one.weight)};
      },
      {.meaning = "where the shape is not determined (reason_code shape_undetermined or swing) the "
                  "shapes that fit as well, by decreasing Akaike weight; a forecast covers all"});
}

Field intervals(const DriftFit& fit, const std::string& why) {
  Fields fields{interval("a1", fit.a1, why), interval("a2", fit.a2, {}),
                interval("time_constant_s", fit.time_constant_s, why)};
  if (fit.slope_per_s) fields.push_back(interval("slope_per_s", fit.slope_per_s, {}));
  if (fit.second_a1) {
    fields.push_back(interval("second_a1", fit.second_a1, {}));
    fields.push_back(interval("second_time_constant_s", fit.second_time_constant_s, why));
  }
  return field::object(
      "interval_95", std::move(fields),
      {.meaning = "central 95 %, by profile likelihood for a time constant and its amplitude; an "
                  "open end is null"});
}

Field tests(const DriftFit& fit) {
  return field::object(
      "tests",
      {field::number("constant_deviance", fit.constant_deviance,
                     {.meaning = "gain of an exponential over the best fit without drift"}),
       field::probability("constant_p", fit.constant_p),
       field::number("line_deviance", fit.line_deviance,
                     {.meaning = "gain of an exponential over a straight line"}),
       field::probability("line_p", fit.line_p)});
}

// What only some shapes have, and only some fits can bound.
void add_optional(const DriftFit& fit, const Unit& unit, Fields& fields) {
  if (fit.slope_per_s)
    fields.push_back(estimate("slope_per_s", fit.slope_per_s, noise_unit(unit, NoiseScale::slope),
                              {.meaning = "a3, where the shape has one"}));
  if (fit.second_a1)
    fields.push_back(
        field::object("second_exponential",
                      {estimate("a1", fit.second_a1, level_unit(unit), {}),
                       estimate("time_constant_s", fit.second_time_constant_s, "s", {})},
                      {.meaning = "where the shape has one; T is that of the larger amplitude"}));
  if (fit.time_constant_above_s)
    fields.push_back(field::magnitude("time_constant_above_s", fit.time_constant_above_s,
                                      {.meaning = "lower limit where it is not identified"}));
  if (fit.time_constant_below_s)
    fields.push_back(field::magnitude("time_constant_below_s", fit.time_constant_below_s,
                                      {.meaning = "upper limit where it is not identified"}));
}

Fields fit_fields(const DriftAnalysis& analysis, const Unit& unit, const std::string& why) {
  const DriftFit& fit = analysis.fit;
  const std::string level = level_unit(unit);
  std::optional<Fields> whitened;
  if (analysis.whitened) whitened = whiteness_fields(*analysis.whitened);
  Fields fields{
      shape(fit.curve.shape,
            "y(t) = a2 + a1 (1 - exp(-t/T)), a second such term, a3 t, steps; where the shape is "
            "not determined the most probable of possible_models; t since power-on"),
      estimate("a1", fit.a1, level, {.meaning = "change by warm-up", .why_null = why}),
      estimate("a2", fit.a2, level,
               {.meaning = "bias at power-on; of an axis that bears gravity (bears_gravity) the "
                           "level; where the shape is not determined over all possible_models"}),
      estimate("time_constant_s", fit.time_constant_s, "s", {.why_null = why}),
      field::flag("bears_gravity", costs_position(unit) && holds_gravity(fit.a2),
                  {.meaning = "a2 is so large that it contains gravity: a level, not a bias"}),
      possible_models(fit),
      intervals(fit, why),
      field::magnitude("residual_rms", analysis.residual_rms,
                       {.meaning = "of the samples about the curve"}),
      tests(fit),
      noise(fit.noise, unit),
      field::object_or_null("whitened", std::move(whitened),
                            {.meaning = "of the block means less curve and noise model",
                             .why_null = "too few blocks to test the noise model"}),
      field::magnitude("rate_hz", analysis.rate_hz),
      field::count("samples", analysis.samples),
      field::count("missing", analysis.missing),
      field::number("start_s", analysis.start_s, {.meaning = "of the recording, since power-on"}),
      field::magnitude("duration_s", analysis.duration_s),
      field::magnitude("block_s", analysis.block_s,
                       {.meaning = "length of the means to which the curve is fitted"}),
      field::magnitude("undetected_below", fit.undetected_below,
                       {.meaning = "95 % upper limit of the amplitude of a warm-up with a time "
                                   "constant of a fifth of the recording",
                        .why_null = "the recording does not bound a warm-up"}),
      field::number("best_time_constant_s", fit.best_time_constant_s,
                    {.meaning = "of the best exponential, identified or not; not for use"})};
  add_optional(fit, unit, fields);
  return fields;
}

Field steps(const DriftFit& fit, const std::string& unit) {
  return field::records("steps", fit.curve.steps,
                        [&](const characterise::DriftStep& step) -> Fields {
                          return {field::number("t_s", step.t_s, {.meaning = "since power-on"}),
                                  field::measured("size", step.size, unit)};
                        });
}

Field candidates(const DriftFit& fit) {
  return field::records(
      "candidates", fit.candidates,
      [](const characterise::DriftCandidate& tried) {
        Fields fields{
            shape(tried.shape),
            field::integer("parameters", tried.parameters, {.meaning = "of shape and noise"}),
            field::number("log_likelihood", tried.log_likelihood),
            field::number("information_criterion", tried.information_criterion,
                          {.meaning = "Schwarz: the least is preferred"}),
            field::count("steps", tried.steps)};
        if (tried.time_constant_s)
          fields.push_back(field::magnitude("time_constant_s", tried.time_constant_s,
                                            {.meaning = "of shapes with an exponential"}));
        return fields;
      },
      {.meaning = "shapes tried, best first"});
}

Field profile(const DriftFit& fit) {
  Fields items;
  for (const characterise::ProfilePoint& point : fit.profile) {
    if (!std::isfinite(point.deviance)) continue;
    items.push_back(field::object(
        {}, {field::magnitude("time_constant_s", point.time_constant_s),
             field::number("deviance", point.deviance,
                           {.meaning = "twice the loss in log-likelihood from the best, all else "
                                       "refitted; 3.84 bounds the 95 % interval"})}));
  }
  return field::list("profile", std::move(items));
}

Field knocks(const DriftAnalysis& analysis, const std::string& unit) {
  const auto at_s = [&](std::size_t sample) {
    return analysis.start_s + static_cast<double>(sample) / analysis.rate_hz;
  };
  return field::records(
      "knocks", analysis.knocks,
      [&](const signal::Event& event) -> Fields {
        return {field::number("start_s", at_s(event.first), {.meaning = "since power-on"}),
                field::number("end_s", at_s(event.last)), field::number("size", event.size),
                field::text("unit", unit), field::magnitude("significance", event.significance)};
      },
      {.meaning = "excluded from the fit"});
}

Field coefficients(const TemperatureModel& model, const std::string& unit) {
  Fields items;
  for (std::size_t j = 0; j < model.coefficients.size(); ++j)
    items.push_back(field::measured({}, model.coefficients[j], per_kelvin(unit, j)));
  return field::list("coefficients", std::move(items), {.meaning = "c_j of sum c_j (T - T0)^j"});
}

Field covariance(const Eigen::MatrixXd& values) {
  Fields rows;
  for (Eigen::Index i = 0; i < values.rows(); ++i) {
    const Eigen::VectorXd row = values.row(i);
    rows.push_back(field::numbers({}, row));
  }
  return field::list("covariance", std::move(rows), {.meaning = "of the coefficients"});
}

Field cross_validation(const TemperatureModel& model) {
  return field::records(
      "cross_validation", model.cross_validation,
      [](const characterise::DegreeScore& score) -> Fields {
        return {field::integer("degree", score.degree),
                field::number("score", score.score, {.meaning = "mean square prediction error"}),
                field::number("excess", score.excess, {.meaning = "over the best degree's"}),
                field::magnitude("std", score.std, {.meaning = "of the excess"})};
      });
}

std::string_view name_of(characterise::Sweep sweep) {
  switch (sweep) {
    case characterise::Sweep::heating:
      return "heating";
    case characterise::Sweep::cooling:
      return "cooling";
    case characterise::Sweep::dwell:
      break;
  }
  return "dwell";
}

Field points(const TemperatureModel& model) {
  return field::records(
      "points", model.points, [](const characterise::TemperaturePoint& point) -> Fields {
        return {field::choice("sweep", name_of(point.sweep), {"heating", "cooling", "dwell"}),
                field::number("temperature_k", point.temperature_k),
                field::number("mean", point.mean), field::magnitude("std", point.std),
                field::count("blocks", point.blocks)};
      });
}

Field temperature(const DriftTemperature& found, const Unit& unit) {
  const std::string level = level_unit(unit);
  std::optional<Fields> fields;
  if (found.model) {
    const TemperatureModel& model = *found.model;
    fields =
        Fields{field::text("channel", found.channel),
               verdict(model.verdict == characterise::Verdict::identified),
               field::text("reason", model.reason, {.meaning = "why it is not identified"}),
               field::integer("degree", model.degree),
               field::number("reference_k", model.reference_k, {.meaning = "T0"}),
               field::number("lowest_k", model.lowest_k,
                             {.meaning = "lower end of the range of validity"}),
               field::number("highest_k", model.highest_k, {.meaning = "upper end"}),
               coefficients(model, level),
               covariance(model.covariance),
               field::magnitude("bias_span", model.bias_span,
                                {.meaning = "largest less smallest of the curve"}),
               field::measured("hysteresis", model.hysteresis, level,
                               {.meaning = "heating less cooling at the same temperature",
                                .why_null = "heating and cooling share too little of the range"}),
               field::flag("hysteresis_significant", model.hysteresis_significant),
               field::magnitude("slope_upper_95", model.slope_upper_95,
                                {.meaning = "upper limit of the size of the mean slope, per K",
                                 .why_null = "the range of temperatures is too small"}),
               cross_validation(model),
               field::magnitude("residual_std", model.residual_std),
               field::magnitude("white_std", model.white_std),
               field::magnitude("drift_std", model.drift_std),
               field::magnitude("block_s", model.block_s),
               points(model)};
  }
  return field::object_or_null(
      "temperature", std::move(fields),
      {.meaning = "where the recording has a temperature channel",
       .why_null = fmt::format("no curve against {}: {}", found.channel, found.refused)});
}

Field position_errors(const char* key, const Interval95& bias_mps2, std::string meaning) {
  return field::records(key, integration_times_s,
                        [&](double t_s) -> Fields {
                          const Interval95 error = characterise::position_error(bias_mps2, t_s);
                          const About open{.meaning = "end of the 95 % band",
                                           .why_null = "the band is open"};
                          return {field::number("t_s", t_s, {.meaning = "of integration"}),
                                  field::number("value", error.value, {.meaning = "m"}),
                                  field::number("lower", error.lower_95, open),
                                  field::number("upper", error.upper_95, open)};
                        },
                        {.meaning = std::move(meaning)});
}

Field forecast(const DriftOutlook& outlook, const Unit& unit) {
  const std::string level = level_unit(unit);
  const characterise::DriftForecast later =
      outlook.forecast.value_or(characterise::DriftForecast{});
  Field zeroed =
      position_errors("position_error_m", later.change,
                      "1/2 b t^2 of the change: of a sensor zeroed at the end of the recording");
  Field uncorrected =
      position_errors("position_error_uncorrected_m", later.bias, "1/2 b t^2 of the bias itself");
  if (!costs_position(unit)) {
    const char* why = "the series is not an acceleration in m/s^2";
    zeroed = field::without_value(std::move(zeroed), why);
    uncorrected = field::without_value(std::move(uncorrected), why);
  } else if (holds_gravity(later.bias)) {
    uncorrected = field::without_value(std::move(uncorrected),
                                       "the level contains gravity, which is not a bias");
  }
  Field all = field::object(
      "forecast",
      {field::number("t_s", later.t_s, {.meaning = "since power-on"}),
       estimate("bias", later.bias, level, {}),
       interval("interval_95", later.bias, {}, "of the bias"),
       estimate("change", later.change, level, {.meaning = "since the end of the recording"}),
       interval("change_interval_95", later.change, {}), std::move(zeroed), std::move(uncorrected)},
      {.meaning = "where one was requested"});
  return outlook.forecast ? all : field::without_value(std::move(all), outlook.refused);
}

Fields drift_fields(const ChannelDrift& channel) {
  const DriftAnalysis none;
  const DriftAnalysis& analysis = channel.analysis ? *channel.analysis : none;
  const DriftFit& fit = analysis.fit;
  const std::string unit = level_unit(channel.unit), why = drift_verdict(channel);
  Fields fields{field::text("name", channel.name),
                field::text("file", channel.file, {.meaning = "empty for a mean over runs"}),
                field::text("unit", unit,
                            {.meaning = "of the series analysed: SI, counts, or 1 where unknown"}),
                verdict(fit.identified),
                field::text("reason", fit.reason.empty() && !fit.identified ? why : fit.reason,
                            {.meaning = "why it is not identified, or the grounds on which it is"}),
                reason_field(channel.analysis ? reason_code(fit.why) : "not_analysed")};
  for (Field& one : fit_fields(analysis, channel.unit, why))
    fields.push_back(channel.analysis ? std::move(one) : field::without_value(std::move(one), why));
  append(fields, {steps(fit, unit),
                  field::records("whiteness", analysis.whiteness, whiteness_fields,
                                 {.meaning = "of the samples less the curve, by scale: what a "
                                             "least-squares fit assumes"}),
                  candidates(fit), profile(fit), knocks(analysis, unit)});
  if (channel.temperature) fields.push_back(temperature(*channel.temperature, channel.unit));
  if (channel.outlook) fields.push_back(forecast(*channel.outlook, channel.unit));
  return fields;
}

Fields channel_fields(const ChannelDrift& channel) {
  Fields fields = drift_fields(channel);
  fields.push_back(rest_field(channel.rest));
  return fields;
}

Field scatter(const char* key,
              const characterise::RunScatter& found,
              const std::string& unit,
              std::string meaning) {
  return field::object(
      key,
      {field::measured("mean", Uncertain{found.mean, found.mean_std}, unit),
       field::magnitude("observed_std", found.observed_std),
       field::magnitude("within_std", found.within_std,
                        {.meaning = "uncertainty of the runs themselves"}),
       estimate("between_std", found.between_std, unit,
                {.meaning = "not explained by noise within the runs"}),
       interval("interval_95", found.between_std, {}, "of between_std"),
       field::probability(
           "p", found.p, {.meaning = "probability of so much scatter if the runs did not differ"})},
      {.meaning = std::move(meaning)});
}

Field level_curve(const RunSet& set, const std::string& unit) {
  std::optional<Fields> fields;
  if (set.level_curve) {
    const DriftFit& fit = *set.level_curve;
    const std::string why = "no warm-up over the runs is identified: " + fit.reason;
    fields = Fields{
        verdict(fit.identified),
        field::text("reason", fit.reason),
        reason_field(reason_code(fit.why)),
        shape(fit.curve.shape),
        estimate("a1", fit.a1, unit, {.why_null = why}),
        estimate("a2", fit.a2, unit, {}),
        estimate("time_constant_runs", fit.time_constant_s, "1", {.why_null = why}),
        field::object("interval_95", {interval("a1", fit.a1, why), interval("a2", fit.a2, {}),
                                      interval("time_constant_runs", fit.time_constant_s, why)})};
  }
  return field::object_or_null(
      "level_curve", std::move(fields),
      {.meaning =
           "warm-up of the means over the runs, a2 + a1 (1 - exp(-n/T)), n = 0 for the first "
           "run, in the order of levels; of 12 runs or more",
       .why_null = "too few runs, or they do not differ"});
}

Fields level_fields(const characterise::RunLevel& run, const std::string& unit) {
  return {field::text("name", run.name), field::measured("turn_on", run.turn_on, unit),
          field::measured("mean", run.mean, unit), field::measured("change", run.change, unit)};
}

// The warm-up that all runs share, as that of a channel.
ChannelDrift common_warm_up(const ChannelRuns& runs) {
  ChannelDrift common;
  common.name = runs.name;
  common.unit = runs.unit;
  common.analysis = runs.set->warm_up;
  return common;
}

Fields set_fields(const RunSet& set, const std::string& unit) {
  return {field::magnitude("window_s", set.window_s, {.meaning = "of the turn-on value"}),
          field::magnitude("duration_s", set.duration_s, {.meaning = "common to all runs"}),
          scatter("turn_on", set.turn_on, unit, "turn-on repeatability"),
          scatter("level", set.level, unit, "of the means of the runs"),
          field::measured("trend_per_run", set.trend_per_run, unit,
                          {.meaning = "of the means against the number of the run",
                           .why_null = "too few runs for a trend"}),
          field::probability("trend_p", set.trend_p),
          level_curve(set, unit)};
}

Fields runs_fields(const ChannelRuns& runs) {
  const std::string unit = level_unit(runs.unit);
  Fields fields{field::text("name", runs.name), field::text("unit", unit),
                field::count("count", runs.set ? runs.set->runs.size() : 0)};
  const RunSet none;
  const RunSet& set = runs.set ? *runs.set : none;
  const std::string why = "not compared: " + runs.refused;
  if (!runs.set)
    fields.push_back(
        field::text("reason", runs.refused, {.meaning = "why they were not compared"}));
  for (Field& one : set_fields(set, unit))
    fields.push_back(runs.set ? std::move(one) : field::without_value(std::move(one), why));
  Field levels =
      field::records("levels", set.runs,
                     [&](const characterise::RunLevel& run) { return level_fields(run, unit); },
                     {.meaning = "by run"});
  std::optional<Fields> warm_up;
  if (runs.set) {
    fields.push_back(std::move(levels));
    warm_up = drift_fields(common_warm_up(runs));
  }
  fields.push_back(field::object_or_null(
      "warm_up", std::move(warm_up),
      {.meaning = "of the mean over all runs, each less its own level", .why_null = why}));
  if (!runs.set) fields.push_back(std::move(levels));
  return fields;
}

void add_notes(const ChannelDrift& channel, const std::string& label, std::vector<Note>& notes) {
  if (!channel.analysis) return notes.push_back({Severity::bad, label + why_not_analysed(channel)});
  if (const std::string moving = motion_sentence(channel.rest, "drift"); !moving.empty())
    notes.push_back({Severity::bad, label + moving});
  for (const Note& note : channel.analysis->notes)
    notes.push_back({note.severity, label + note.text});
  if (!channel.temperature || !channel.temperature->model) return;
  for (const std::string& text : channel.temperature->model->notes)
    notes.push_back({Severity::warning, label + "temperature: " + text});
}

void add_notes(const ChannelRuns& runs, std::vector<Note>& notes) {
  const std::string label = runs.name + ": runs: ";
  if (!runs.set) return notes.push_back({Severity::bad, label + "not compared: " + runs.refused});
  for (const std::string& text : runs.set->notes)
    notes.push_back({Severity::warning, label + text});
  for (const Note& note : runs.set->warm_up.notes)
    notes.push_back({note.severity, label + "mean of all: " + note.text});
}

// The report's own, then each channel's with its name; a refusal is bad.
std::vector<Note> all_notes(const DriftReport& report) {
  std::vector<Note> notes = report.notes;
  for (const ChannelDrift& channel : report.channels)
    add_notes(channel, channel_label(report, channel) + ": ", notes);
  for (const ChannelRuns& runs : report.runs) add_notes(runs, notes);
  return notes;
}

Fields report_fields(const DriftReport& report, const std::vector<Note>& notes) {
  Fields fields{field::records("channels", report.channels, channel_fields),
                field::records("runs", report.runs, runs_fields,
                               {.meaning = "of three recordings or more: each channel over them"}),
                field::number("since_switch_on_s", report.since_switch_on_s,
                              {.meaning = "time since power-on at the first sample"})};
  if (report.forecast_s)
    fields.push_back(
        field::number("forecast_s", report.forecast_s, {.meaning = "time of the forecast"}));
  std::vector<std::string> infos;
  for (const Note& note : notes)
    if (note.severity == Severity::info) infos.push_back(note.text);
  fields.push_back(field::texts("notes", infos, {.meaning = "how the input was read"}));
  return fields;
}

// "x: warm-up of 5.0 ± 0.1 mg with time constant 900 ± 20 s."; of many channels, how many warm up.
std::string channels_conclusion(const DriftReport& report) {
  constexpr std::size_t most_named = 3;
  std::string text;
  if (report.channels.size() <= most_named) {
    for (const ChannelDrift& channel : report.channels)
      text += fmt::format("{}{}: {}.", text.empty() ? "" : " ", channel_label(report, channel),
                          drift_verdict(channel));
    return text;
  }
  const auto warm = std::ranges::count_if(report.channels, [](const ChannelDrift& channel) {
    return channel.analysis && channel.analysis->fit.identified;
  });
  const auto refused = std::ranges::count_if(
      report.channels, [](const ChannelDrift& channel) { return !channel.analysis; });
  text = fmt::format("A warm-up is identified in {} of {}", warm,
                     count_words(report.channels.size(), "channel"));
  if (refused > 0) text += fmt::format(", {} not analysed", refused);
  return text + ".";
}

std::string conclusion(const DriftReport& report) {
  std::string moving, text;
  for (const ChannelDrift& channel : report.channels)
    if (!motion_sentence(channel.rest, "drift").empty())
      moving += (moving.empty() ? "" : ", ") + channel_label(report, channel);
  if (!moving.empty()) text = motion_sentence_of_channels(moving) + " ";
  for (const ChannelRuns& runs : report.runs)
    if (runs.set)
      text += fmt::format("{} over {}: turn-on repeatability {}. ", runs.name,
                          count_words(runs.set->runs.size(), "run"),
                          scatter_words(runs.set->turn_on, runs.unit));
  return text + channels_conclusion(report);
}

std::vector<KeyFigure> figures_of(const DriftReport& report) {
  constexpr std::size_t most_channels = 6;
  std::vector<KeyFigure> figures;
  for (const ChannelRuns& runs : report.runs)
    if (runs.set)
      figures.push_back(
          {runs.name + ": turn-on repeatability", scatter_words(runs.set->turn_on, runs.unit)});
  if (report.channels.size() > most_channels) return figures;
  for (const ChannelDrift& channel : report.channels) {
    const std::string label = channel_label(report, channel);
    if (!channel.analysis) {
      figures.push_back({label, "not analysed"});
      continue;
    }
    const DriftFit& fit = channel.analysis->fit;
    figures.push_back(
        {label + ": warm-up a1", fit.a1 ? bias_words(*fit.a1, channel.unit) : "not identified"});
    if (fit.time_constant_s)
      figures.push_back(
          {label + ": time constant T", with_std(uncertain(fit.time_constant_s), "s", absent)});
  }
  return figures;
}

// The more channels, the less of each.
enum class Detail { all, curve, table };

Detail detail_of(const DriftReport& report) {
  constexpr std::size_t most_with_all = 6, most_with_curve = 24;
  const std::size_t channels = report.channels.size();
  if (channels <= most_with_all) return Detail::all;
  return channels <= most_with_curve || report.every_run ? Detail::curve : Detail::table;
}

void add_all(const ChannelDrift& channel, const std::string& label, Section& section) {
  const DriftAnalysis& analysis = *channel.analysis;
  const bool has_temperature = channel.temperature && channel.temperature->model;
  if (!analysis.whiteness.empty()) section.tables.push_back(whiteness_table(analysis));
  section.tables.push_back(candidates_table(analysis.fit));
  if (channel.outlook && channel.outlook->forecast && costs_position(channel.unit))
    section.tables.push_back(position_table(*channel.outlook->forecast));
  if (has_temperature) section.tables.push_back(temperature_table(channel));
  section.figures.push_back([&, label] { return samples_figure(channel, label); });
  // The profile of a time constant that is not identified shows little.
  if (analysis.fit.identified && !analysis.fit.profile.empty())
    section.figures.push_back([&, label] { return profile_figure(channel, label); });
  for (std::size_t k = 0; k < analysis.residuals.size(); ++k)
    section.figures.push_back([&, label, k] { return residual_figure(channel, k, label); });
  for (const WhitenessTest& test : analysis.whiteness)
    section.figures.push_back([&, label] { return autocorrelation_figure(test, label); });
  if (has_temperature)
    section.figures.push_back([&, label] { return temperature_figure(channel, label); });
}

std::string data_words(const DriftAnalysis& analysis) {
  std::string text = fmt::format("{} at {} Hz, {}", count_words(analysis.samples, "sample"),
                                 compact(analysis.rate_hz, 6), duration_words(analysis.duration_s));
  if (analysis.missing > 0) text += ", " + grouped(analysis.missing) + " of them missing";
  if (analysis.start_s > 0.0)
    text += ", from " + duration_words(analysis.start_s) + " after power-on";
  return text + ".";
}

Section channel_section(const DriftReport& report, const ChannelDrift& channel, Detail detail) {
  const std::string label = channel_label(report, channel);
  Section section{.heading = label,
                  .points = drift_findings(channel),
                  .on_terminal = report.runs.empty() || report.every_run};
  if (!channel.analysis) return section;
  section.paragraphs = {data_words(*channel.analysis)};
  section.tables = {parameters_table(channel)};
  if (!channel.analysis->fit.curve.steps.empty()) section.tables.push_back(steps_table(channel));
  section.figures = {[&, label] { return drift_figure(channel, label); }};
  if (detail == Detail::all) add_all(channel, label, section);
  return section;
}

// The table is for a terminal where the channels have no sections.
Section overview_section(const DriftReport& report, Detail detail) {
  Table table{"Verdicts", {"Channel", "Verdict", "Bias or level at power-on"}, {}};
  table.page_only = !report.runs.empty() || detail != Detail::table;
  for (const ChannelDrift& channel : report.channels)
    table.rows.push_back(
        {channel_label(report, channel), drift_verdict(channel),
         channel.analysis ? bias_words(channel.analysis->fit.a2, channel.unit) : ""});
  Section section{.heading = "All channels", .tables = {std::move(table)}, .on_terminal = true};
  if (!report.runs.empty() && !report.every_run)
    section.paragraphs = {"On a terminal, -v prints each run in full."};
  return section;
}

Section runs_section(const ChannelRuns& runs) {
  Section section{
      .heading = runs.name + ": runs", .points = run_findings(runs), .on_terminal = true};
  if (!runs.set) return section;
  section.heading =
      fmt::format("{}: {} of {}", runs.name, count_words(runs.set->runs.size(), "run"),
                  duration_words(runs.set->duration_s));
  section.tables = {runs_table(runs)};
  section.figures = {[&] { return levels_figure(runs); },
                     [&] {
                       return drift_figure(common_warm_up(runs),
                                           runs.name + ", mean of all runs less their levels");
                     }};
  return section;
}

Section method_section() {
  return {
      .heading = "How it was computed",
      .paragraphs = {
          "The model y(t) = a2 + a1 (1 − e^(−t/T)) is compared with a constant, a straight line, "
          "steps, an exponential with a line, two exponentials and other shapes. White noise, "
          "flicker, a random walk and first-order Markov noise are fitted jointly; the shape with "
          "the least Schwarz criterion is chosen.",
          "The interval of T contains the values for which twice the loss in log-likelihood stays "
          "below 3.84, all else refitted: it may be asymmetric or open. The standard deviation of "
          "an ordinary least-squares fit assumes white residuals; with a random walk in them it is "
          "several times too small.",
          "Whiteness is tested on means over increasing times, because slow drift is hidden by the "
          "noise of single samples: Ljung–Box over √n lags, the cumulative periodogram, and runs "
          "of sign, at a joint level of 5 %."}};
}

}  // namespace

Document describe(const DriftReport& report) {
  const std::vector<Note> notes = all_notes(report);
  Document document{.page = {.verb = "drift",
                             .title = file_names(report.inputs),
                             .inputs = report.inputs,
                             .conclusion = conclusion(report),
                             .key_figures = figures_of(report),
                             .notes = notes},
                    .fields = report_fields(report, notes),
                    .failure = why_no_channel(report.channels)};
  std::vector<Section>& sections = document.page.sections;
  const Detail detail = detail_of(report);
  for (const ChannelRuns& runs : report.runs) sections.push_back(runs_section(runs));
  if (detail != Detail::all || !report.runs.empty())
    sections.push_back(overview_section(report, detail));
  if (detail != Detail::table)
    for (const ChannelDrift& channel : report.channels)
      sections.push_back(channel_section(report, channel, detail));
  sections.push_back(method_section());
  return document;
}

}  // namespace proofmass::report
