#include <algorithm>
#include <fmt/format.h>

#include "proofmass/report/tune/figures.hpp"
#include "proofmass/report/tune/report.hpp"
#include "proofmass/report/tune/wording.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using estimate::TunedParameter;
using estimate::TunedSeries;
using estimate::TuneVerdict;

constexpr std::size_t most_with_figures = 6;

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

Fields parameter_fields(const TuneReport& report, const TunedParameter& parameter) {
  const bool identified = parameter.verdict == TuneVerdict::identified;
  const std::string why = reason_words(report, parameter);
  const auto figure = [&](double value) {
    return parameter.value ? std::optional(value) : std::nullopt;
  };
  const Uncertain found = parameter.value.value_or(Uncertain{});
  Fields fields{
      field::text("name", parameter.name, {.meaning = "as --fix and --share accept it"}),
      field::text("channel", parameter_channel(report, parameter),
                  {.meaning = "all: the channels share it, or it is fixed"}),
      field::number(
          "value", figure(found.value),
          {.meaning = "in the unit beside it; null where not identifiable", .why_null = why}),
      field::magnitude("std", figure(found.std),
                       {.meaning = "0 of a fixed parameter", .why_null = why}),
      field::text("unit", parameter_unit(report, parameter)),
      field::choice("verdict", verdict_of(parameter), {"identified", "not_observable", "fixed"})};
  if (identified) {
    const About end{.why_null = "the record does not bound it"};
    fields.push_back(field::fixed_list(
        "interval_95",
        {field::number({}, parameter.lower_95, end), field::number({}, parameter.upper_95, end)}));
  }
  if (!identified && parameter.upper_95)
    fields.push_back(field::number(
        "upper_95", *parameter.upper_95,
        {.meaning = "one-sided limit of a noise that is not distinguishable from zero"}));
  if (!identified && parameter.lower_95)
    fields.push_back(
        field::number("lower_95", *parameter.lower_95,
                      {.meaning = "one-sided limit of a time constant that has no upper bound"}));
  if (parameter.record_needed_s)
    fields.push_back(field::magnitude("record_needed_s", *parameter.record_needed_s,
                                      {.meaning = "approximate length of record that would "
                                                  "identify it"}));
  if (!parameter.reason.empty()) fields.push_back(field::text("reason", why));
  fields.push_back(
      field::number("start", parameter.start, {.meaning = "initial value of the search"}));
  fields.push_back(field::number("after_em", parameter.after_em,
                                 {.meaning = "after the steps of expectation-maximisation"}));
  return fields;
}

Field matrix(const char* key, const estimate::TuneMatrix& A, int states) {
  Fields rows;
  for (int i = 0; i < states; ++i) {
    Fields row;
    for (int j = 0; j < states; ++j) row.push_back(field::number({}, A(i, j)));
    rows.push_back(field::list({}, std::move(row)));
  }
  return field::list(key, std::move(rows));
}

Field filter(const TunedSeries& series) {
  std::vector<double> H;
  for (int i = 0; i < series.system.states; ++i)
    H.push_back(i < series.system.observed ? 1.0 : 0.0);
  return field::object("filter",
                       {field::magnitude("step_s", 1.0 / series.rate_hz),
                        matrix("F", series.system.F, series.system.states),
                        matrix("Q", series.system.Q, series.system.states), field::numbers("H", H),
                        field::number("R", series.system.R)},
                       {.meaning = "one step x[k+1] = F x[k] + w, w ~ N(0, Q), y = H x + v, v ~ "
                                   "N(0, R), with a noise that is not identified as 0"});
}

Fields channel_fields(const TuneReport& report, std::size_t k) {
  const TunedSeries& series = report.tuning.series[k];
  const std::string& symbol = report.channels[k].unit.symbol;
  return {field::text("name", report.channels[k].name),
          field::text("unit", symbol.empty() ? "1" : symbol,
                      {.meaning = "of the series: SI where known"}),
          field::magnitude("rate_hz", series.rate_hz),
          field::magnitude("duration_s", series.duration_s),
          field::count("segments", report.channels[k].segments,
                       {.meaning = "intervals used, each with a level of its own"}),
          field::count("readings", series.readings),
          field::count("missing", series.missing),
          field::count("outliers", series.outliers.count,
                       {.meaning = "not used: isolated measurements that the noise of the model "
                                   "does not explain"}),
          field::number("log_likelihood", series.log_likelihood),
          filter(series)};
}

const std::string unsettled = "the gain does not settle within the study";

Fields case_fields(const estimate::GainCase& one) {
  const estimate::GainStudy& study = one.study;
  Fields settling;
  for (const auto& time_s : study.settling_s)
    settling.push_back(field::number({}, time_s, {.why_null = unsettled}));
  constexpr std::size_t most = 200;
  const std::size_t every = study.epochs.size() / most + 1;
  std::vector<double> t_s;
  Fields gains, variances;
  for (std::size_t k = 0; k < study.epochs.size(); k += every) {
    const estimate::GainEpoch& epoch = study.epochs[k];
    t_s.push_back(epoch.t_s);
    gains.push_back(field::numbers("", epoch.gain));
    variances.push_back(field::numbers("", epoch.variance));
  }
  return {field::text("label", case_words(one)),
          field::number("process_psd", study.options.jerk_psd_m2ps5),
          field::number("reading_variance", study.options.accel_variance_m2ps4),
          field::number("step_s", study.options.step_s),
          field::number("prior_variance", study.options.prior_variance),
          field::numbers("gain_limit", study.limit),
          field::list("settling_s", std::move(settling)),
          field::number("variance_limit", study.limit_variance_m2ps4),
          field::numbers("t_s", t_s),
          field::list("gain", std::move(gains)),
          field::list("variance", std::move(variances))};
}

Fields step_fields(const estimate::StepSizeEffect& step) {
  return {field::number("step_s", step.step_s), field::number("gain", step.gain),
          field::number("std", step.accel_std_mps2),
          field::number("predicted_std", step.predicted_std_mps2),
          field::number("settling_s", step.settling_s, {.why_null = unsettled})};
}

Fields study_fields(const estimate::TuneStudy& study) {
  return {field::text("channel", study.channel),
          field::text("definition",
                      "position, velocity and acceleration with the acceleration measured; a gain "
                      "has settled where it stays within 2 % of its limit"),
          field::records("cases", study.cases, case_fields,
                         {.meaning = "the first as tuned; of position, velocity and acceleration "
                                     "in this order"}),
          field::records("steps", study.steps, step_fields,
                         {.meaning = "of the acceleration, once the gain has settled"})};
}

Fields tune_fields(const TuneReport& report) {
  const estimate::Tuning& tuning = report.tuning;
  Fields channels;
  for (std::size_t k = 0; k < report.channels.size(); ++k)
    channels.push_back(field::object({}, channel_fields(report, k)));
  return {
      field::text("model", estimate::name_of(tuning.model)),
      field::text("model_reason", choice_words(report.choice)),
      field::records("parameters", tuning.parameters,
                     [&](const TunedParameter& one) { return parameter_fields(report, one); }),
      field::number("log_likelihood", tuning.log_likelihood,
                    {.meaning = "of all channels, with an exact diffuse start"}),
      field::flag("converged", tuning.converged),
      field::count("iterations", static_cast<std::size_t>(tuning.iterations)),
      field::number("gradient", tuning.gradient,
                    {.meaning = "largest derivative of the log-likelihood by the logarithm of a "
                                "parameter, at the end"}),
      field::numbers("em_log_likelihood", tuning.em_log_likelihood,
                     {.meaning = "before each step and after the last"}),
      field::list("channels", std::move(channels)),
      consistency_field(report.consistency, noise_names(tuning.model)),
      field::records("study", report.studies, study_fields),
      field::notes(report.notes)};
}

std::vector<KeyFigure> figures_of(const TuneReport& report) {
  std::vector<KeyFigure> figures;
  for (const TunedParameter& parameter : report.tuning.parameters) {
    if (parameter.verdict == TuneVerdict::fixed || figures.size() == most_with_figures) continue;
    figures.push_back({parameter_channel(report, parameter) + ": " + parameter.name,
                       value_words(report, parameter)});
  }
  return figures;
}

Table channels_table(const TuneReport& report) {
  Table table{"Channels",
              {"Channel", "Duration", "Rate", "Measurements", "Missing", "Outliers", "Intervals",
               "Log-likelihood"},
              {}};
  for (std::size_t k = 0; k < report.channels.size(); ++k) {
    const TunedSeries& series = report.tuning.series[k];
    table.rows.push_back({report.channels[k].name, duration_words(series.duration_s),
                          compact(series.rate_hz, 6) + " Hz", grouped(series.readings),
                          grouped(series.missing), grouped(series.outliers.count),
                          grouped(report.channels[k].segments), fixed(series.log_likelihood, 3)});
  }
  return table;
}

Section parameters_section(const TuneReport& report) {
  Section section{
      .heading = fmt::format("Model {}", estimate::name_of(report.tuning.model)),
      .paragraphs = {"The data are modelled as " + model_words(report.tuning.model) + ".",
                     choice_words(report.choice)},
      .tables = {channels_table(report), parameters_table(report)},
      .on_terminal = true};
  for (const TunedParameter& parameter : report.tuning.parameters)
    if (!parameter.value)
      section.points.push_back(parameter_channel(report, parameter) + ": " + parameter.name + ": " +
                               reason_words(report, parameter) + ".");
  return section;
}

Section innovations_section(const TuneReport& report, std::size_t channel) {
  Section section{.heading = report.channels[channel].name + ": innovations",
                  .figures = {[&report, channel] { return innovations_figure(report, channel); }}};
  if (has_whiteness(report, channel))
    section.figures.push_back(
        [&report, channel] { return autocorrelation_figure(report, channel); });
  return section;
}

Section study_section(const estimate::TuneStudy& study) {
  return {
      .heading = study.channel + ": gain and covariance",
      .paragraphs = {"They depend on Q, R and the step, not on the data: Q as the density of the "
                     "white jerk, R as the variance of a measurement. A gain has settled where "
                     "it stays within 2 % of its limit."},
      .tables = {settling_table(study), step_table(study)},
      .figures = {[&] { return gain_figure(study); }, [&] { return covariance_figure(study); },
                  [&] { return step_figure(study); }}};
}

Section method_section() {
  return {.heading = "How it was computed",
          .paragraphs = {
              "The parameters maximise the likelihood of the innovations, with an exact diffuse "
              "start. The search begins at the Allan variance, takes a few steps of "
              "expectation–maximisation, which always gain but slowly, and then follows the exact "
              "gradient, which one pass of the smoother gives.",
              "Standard deviations come from the curvature at the maximum, in logarithms; an "
              "interval wider than ±20 % from the profile likelihood. A noise without which the "
              "likelihood is hardly lower is not distinguishable from zero: it has an upper limit "
              "and no value."}};
}

std::string conclusion(const TuneReport& report) {
  constexpr std::size_t most_listed = 4;
  std::string words;
  std::size_t unknown = 0, found = 0;
  for (const TunedParameter& parameter : report.tuning.parameters) {
    if (parameter.verdict == TuneVerdict::fixed) continue;
    ++unknown;
    if (parameter.value) ++found;
    words +=
        fmt::format("{}{}: {} {}.", words.empty() ? "" : " ", parameter_channel(report, parameter),
                    parameter.name, value_words(report, parameter));
  }
  if (unknown > most_listed)
    words = fmt::format("{} of {} of the model {} are identified, in {}.", found,
                        count_words(unknown, "parameter"), estimate::name_of(report.tuning.model),
                        count_words(report.channels.size(), "channel"));
  return words + " " + consistency_conclusion(report.consistency, noise_names(report.tuning.model));
}

}  // namespace

Document describe(const TuneReport& report) {
  Document document{.page = {.verb = "tune",
                             .title = report.inputs.empty() ? "" : file_name(report.inputs.front()),
                             .inputs = report.inputs,
                             .conclusion = conclusion(report),
                             .key_figures = figures_of(report),
                             .notes = report.notes},
                    .fields = tune_fields(report)};
  std::vector<Section>& sections = document.page.sections;
  sections.push_back(parameters_section(report));
  sections.push_back(consistency_section(report.consistency, noise_names(report.tuning.model)));
  for (std::size_t k = 0; k < report.channels.size() && k < most_with_figures; ++k)
    sections.push_back(innovations_section(report, k));
  for (const estimate::TuneStudy& study : report.studies) sections.push_back(study_section(study));
  sections.push_back(method_section());
  return document;
}

}  // namespace proofmass::report
