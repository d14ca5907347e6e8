#include "proofmass/report/drift/fields.hpp"

#include <cmath>
#include <fmt/format.h>

#include "proofmass/report/drift/tables.hpp"
#include "proofmass/report/drift/wording.hpp"
#include "proofmass/report/noise/wording.hpp"

namespace proofmass::report {
namespace {

using characterise::DriftAnalysis;
using characterise::DriftFit;
using characterise::Interval95;
using signal::WhitenessTest;

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
        return {shape_field(one.curve.shape), field::magnitude("weight", one.weight)};
      },
      {.meaning = "where the shape is not determined (reason_code shape_undetermined or swing) the "
                  "shapes that fit as well, by decreasing Akaike weight; a forecast covers all"});
}

Field intervals(const DriftFit& fit, const std::string& why) {
  Fields fields{interval_ends("a1", fit.a1, why), interval_ends("a2", fit.a2, {}),
                interval_ends("time_constant_s", fit.time_constant_s, why)};
  if (fit.slope_per_s) fields.push_back(interval_ends("slope_per_s", fit.slope_per_s, {}));
  if (fit.second_a1) {
    fields.push_back(interval_ends("second_a1", fit.second_a1, {}));
    fields.push_back(interval_ends("second_time_constant_s", fit.second_time_constant_s, why));
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

// Entries that only some shapes have, and that only some fits bound.
void add_optional(const DriftFit& fit, const Unit& unit, Fields& fields) {
  if (fit.slope_per_s)
    fields.push_back(interval_estimate("slope_per_s", fit.slope_per_s,
                                       noise_unit(unit, NoiseScale::slope),
                                       {.meaning = "a3, where the shape has one"}));
  if (fit.second_a1)
    fields.push_back(
        field::object("second_exponential",
                      {interval_estimate("a1", fit.second_a1, level_unit(unit), {}),
                       interval_estimate("time_constant_s", fit.second_time_constant_s, "s", {})},
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
      shape_field(
          fit.curve.shape,
          "y(t) = a2 + a1 (1 - exp(-t/T)), a second such term, a3 t, steps; where the shape is "
          "not determined the most probable of possible_models; t since power-on"),
      interval_estimate("a1", fit.a1, level, {.meaning = "change by warm-up", .why_null = why}),
      interval_estimate(
          "a2", fit.a2, level,
          {.meaning = "bias at power-on; of an axis that bears gravity (bears_gravity) the "
                      "level; where the shape is not determined over all possible_models"}),
      interval_estimate("time_constant_s", fit.time_constant_s, "s", {.why_null = why}),
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
            shape_field(tried.shape),
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

Field outliers(const DriftAnalysis& analysis, const std::string& unit) {
  const auto at_s = [&](std::size_t sample) {
    return analysis.start_s + static_cast<double>(sample) / analysis.rate_hz;
  };
  return field::records(
      "knocks", analysis.outliers,
      [&](const signal::Event& event) -> Fields {
        return {field::number("start_s", at_s(event.first), {.meaning = "since power-on"}),
                field::number("end_s", at_s(event.last)), field::number("size", event.size),
                field::text("unit", unit), field::magnitude("significance", event.significance)};
      },
      {.meaning = "excluded from the fit"});
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
  Field all = field::object("forecast",
                            {field::number("t_s", later.t_s, {.meaning = "since power-on"}),
                             interval_estimate("bias", later.bias, level, {}),
                             interval_ends("interval_95", later.bias, {}, "of the bias"),
                             interval_estimate("change", later.change, level,
                                               {.meaning = "since the end of the recording"}),
                             interval_ends("change_interval_95", later.change, {}),
                             std::move(zeroed), std::move(uncorrected)},
                            {.meaning = "where one was requested"});
  return outlook.forecast ? all : field::without_value(std::move(all), outlook.refused);
}

}  // namespace

std::optional<Uncertain> uncertain(const std::optional<characterise::Interval95>& figure) {
  if (!figure) return std::nullopt;
  return Uncertain{figure->value, figure->std};
}

Field interval_estimate(const char* key,
                        const std::optional<characterise::Interval95>& figure,
                        const std::string& unit,
                        About about) {
  if (figure) about.why_null = "its standard deviation is not determined";
  return field::measured(key, uncertain(figure), unit, std::move(about));
}

Field interval_ends(const char* key,
                    const std::optional<characterise::Interval95>& figure,
                    const std::string& why,
                    std::string meaning) {
  const About open{.why_null = "the recording does not bound it"};
  const characterise::Interval95 ends = figure.value_or(characterise::Interval95{});
  Field both = field::fixed_list(
      key, {field::number({}, ends.lower_95, open), field::number({}, ends.upper_95, open)},
      {.meaning = std::move(meaning)});
  both.shape.nullable = !why.empty();
  return figure ? both : field::without_value(std::move(both), why);
}

Field shape_field(characterise::DriftShape shape, std::string meaning) {
  return field::choice(
      "model", characterise::name_of(shape),
      {"constant", "line", "steps", "exponential", "exponential_and_line", "two_exponentials",
       "square_root", "logarithm", "hyperbola", "stretched_exponential", "sine"},
      {.meaning = std::move(meaning)});
}

Field verdict_field(bool identified) {
  return field::choice("verdict", identified ? "identified" : "not_identified",
                       {"identified", "not_identified"});
}

Field reason_field(std::string_view code) {
  return field::choice("reason_code", code,
                       {"identified", "no_warm_up", "hidden_by_noise", "steps", "line",
                        "longer_than_record", "shorter_than_resolved", "begun_later",
                        "shape_undetermined", "swing", "unexplained", "not_analysed"});
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
                verdict_field(fit.identified),
                field::text("reason", fit.reason.empty() && !fit.identified ? why : fit.reason,
                            {.meaning = "why it is not identified, or the grounds on which it is"}),
                reason_field(channel.analysis ? reason_code(fit.why) : "not_analysed")};
  for (Field& one : fit_fields(analysis, channel.unit, why))
    fields.push_back(channel.analysis ? std::move(one) : field::without_value(std::move(one), why));
  append(fields, {steps(fit, unit),
                  field::records("whiteness", analysis.whiteness, whiteness_fields,
                                 {.meaning = "of the samples less the curve, by scale: what a "
                                             "least-squares fit assumes"}),
                  candidates(fit), profile(fit), outliers(analysis, unit)});
  if (channel.temperature) fields.push_back(temperature_field(*channel.temperature, channel.unit));
  if (channel.outlook) fields.push_back(forecast(*channel.outlook, channel.unit));
  return fields;
}

}  // namespace proofmass::report
