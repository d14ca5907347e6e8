#include <fmt/format.h>

#include "proofmass/report/document.hpp"
#include "proofmass/report/tune_report.hpp"
#include "proofmass/report/tune_wording.hpp"

namespace proofmass::report {
namespace {

using estimate::TunedParameter;
using estimate::TunedSeries;
using estimate::TuneVerdict;

const char* verdict_of(const TunedParameter& parameter) {
  switch (parameter.verdict) {
    case TuneVerdict::identified:
      return "identified";
    case TuneVerdict::not_observable:
      return "not_observable";
    case TuneVerdict::fixed:
      return "fixed";
  }
  return "";
}

Object parameter_object(const TuneReport& report, const TunedParameter& parameter) {
  const bool identified = parameter.verdict == TuneVerdict::identified;
  Object object{{"name", parameter.name},
                {"channel", parameter_channel(report, parameter)},
                {"value", parameter.value ? Value(parameter.value->value) : Value()},
                {"std", parameter.value ? Value(parameter.value->std) : Value()},
                {"unit", parameter_unit(report, parameter)},
                {"verdict", verdict_of(parameter)}};
  if (identified)
    object.push_back(
        {"interval_95", Array{or_null(parameter.lower_95), or_null(parameter.upper_95)}});
  if (!identified && parameter.upper_95) object.push_back({"upper_95", *parameter.upper_95});
  if (!identified && parameter.lower_95) object.push_back({"lower_95", *parameter.lower_95});
  if (parameter.record_needed_s) object.push_back({"record_needed_s", *parameter.record_needed_s});
  if (!parameter.reason.empty()) object.push_back({"reason", reason_words(report, parameter)});
  object.push_back({"start", parameter.start});
  object.push_back({"after_em", parameter.after_em});
  return object;
}

Array matrix(const estimate::TuneMatrix& A, int states) {
  Array rows;
  for (int i = 0; i < states; ++i) {
    Array row;
    for (int j = 0; j < states; ++j) row.push_back(A(i, j));
    rows.push_back(std::move(row));
  }
  return rows;
}

// What a filter is made of: one step of x[k+1] = F x[k] + w, y = H x + v.
Object filter_object(const TunedSeries& series) {
  Array H;
  for (int i = 0; i < series.system.states; ++i)
    H.push_back(i < series.system.observed ? 1.0 : 0.0);
  return {{"step_s", 1.0 / series.rate_hz},
          {"F", matrix(series.system.F, series.system.states)},
          {"Q", matrix(series.system.Q, series.system.states)},
          {"H", std::move(H)},
          {"R", series.system.R}};
}

Object channel_object(const TuneReport& report, std::size_t k) {
  const TunedSeries& series = report.tuning.series[k];
  const std::string& symbol = report.channels[k].unit.symbol;
  return {{"name", report.channels[k].name},
          {"unit", symbol.empty() ? "1" : symbol},
          {"rate_hz", series.rate_hz},
          {"duration_s", series.duration_s},
          {"segments", report.channels[k].segments},
          {"readings", series.readings},
          {"missing", series.missing},
          {"log_likelihood", series.log_likelihood},
          {"filter", filter_object(series)}};
}

Object case_object(const GainCase& one) {
  const estimate::GainStudy& study = one.study;
  Array gain, settling;
  for (std::size_t i = 0; i < 3; ++i) {
    gain.push_back(study.limit[i]);
    settling.push_back(or_null(study.settling_s[i]));
  }
  constexpr std::size_t most = 200;
  const std::size_t every = study.instants.size() / most + 1;
  Array t_s, gains, variances;
  for (std::size_t k = 0; k < study.instants.size(); k += every) {
    const estimate::GainInstant& instant = study.instants[k];
    t_s.push_back(instant.t_s);
    gains.push_back(array_of(instant.gain));
    variances.push_back(array_of(instant.variance));
  }
  return {{"label", one.label},
          {"process_psd", study.options.jerk_psd_m2ps5},
          {"reading_variance", study.options.accel_variance_m2ps4},
          {"step_s", study.options.step_s},
          {"prior_variance", study.options.prior_variance},
          {"gain_limit", std::move(gain)},
          {"settling_s", std::move(settling)},
          {"variance_limit", study.limit_variance_m2ps4},
          {"t_s", std::move(t_s)},
          {"gain", std::move(gains)},
          {"variance", std::move(variances)}};
}

Object study_object(const TuneStudy& study) {
  Array cases, steps;
  for (const GainCase& one : study.cases) cases.push_back(case_object(one));
  for (const estimate::StepSizeEffect& step : study.steps) {
    steps.push_back(Object{{"step_s", step.step_s},
                           {"gain", step.gain},
                           {"std", step.accel_std_mps2},
                           {"predicted_std", step.predicted_std_mps2},
                           {"settling_s", or_null(step.settling_s)}});
  }
  return {{"channel", study.channel},
          {"definition",
           "position, velocity and acceleration with the acceleration measured; a gain has "
           "settled where it stays within 2 % of its limit"},
          {"cases", std::move(cases)},
          {"steps", std::move(steps)}};
}

std::vector<std::string> warnings(const TuneReport& report) {
  std::vector<std::string> all = texts(report.notes, Severity::warning);
  for (const TunedParameter& parameter : report.tuning.parameters) {
    const std::string label = parameter_channel(report, parameter) + ": " + parameter.name + ": ";
    if (!parameter.value) {
      all.push_back(label + "value and std null: " + reason_words(report, parameter));
    } else if (parameter.verdict == TuneVerdict::identified &&
               !(parameter.lower_95 && parameter.upper_95)) {
      all.push_back(label + "an end of interval_95 is null: the record does not bound it");
    }
  }
  bool unsettled = false;
  for (const TuneStudy& study : report.studies) {
    for (const GainCase& one : study.cases) {
      for (const auto& time_s : one.study.settling_s) unsettled = unsettled || !time_s;
    }
    for (const auto& step : study.steps) unsettled = unsettled || !step.settling_s;
  }
  if (unsettled)
    all.push_back("study: settling_s: null where a gain does not settle within the study");
  for (std::string& text : consistency_nulls(report.consistency)) all.push_back(std::move(text));
  return all;
}

}  // namespace

std::string tune_json(const TuneReport& report) {
  const estimate::Tuning& tuning = report.tuning;
  Array parameters, channels, studies;
  for (const TunedParameter& parameter : tuning.parameters) {
    parameters.push_back(parameter_object(report, parameter));
  }
  for (std::size_t k = 0; k < report.channels.size(); ++k) {
    channels.push_back(channel_object(report, k));
  }
  for (const TuneStudy& study : report.studies) studies.push_back(study_object(study));
  return to_json({"tune", report.inputs, warnings(report)},
                 {{"model", estimate::name_of(tuning.model)},
                  {"model_reason", report.model_reason},
                  {"parameters", std::move(parameters)},
                  {"log_likelihood", tuning.log_likelihood},
                  {"converged", tuning.converged},
                  {"iterations", tuning.iterations},
                  {"gradient", tuning.gradient},
                  {"em_log_likelihood", array_of(tuning.em_log_likelihood)},
                  {"channels", std::move(channels)},
                  {"consistency", consistency_json(report.consistency, noise_names(tuning.model))},
                  {"study", std::move(studies)},
                  {"notes", array_of(texts(report.notes, Severity::info))}});
}

}  // namespace proofmass::report
