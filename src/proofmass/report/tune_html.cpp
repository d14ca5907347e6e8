#include <fmt/format.h>

#include "proofmass/report/page.hpp"
#include "proofmass/report/tune_figures.hpp"
#include "proofmass/report/tune_report.hpp"
#include "proofmass/report/tune_wording.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using estimate::TunedParameter;

constexpr std::size_t most_with_figures = 6;

std::vector<KeyFigure> key_figures(const TuneReport& report) {
  std::vector<KeyFigure> figures;
  for (const TunedParameter& parameter : report.tuning.parameters) {
    if (parameter.verdict == estimate::TuneVerdict::fixed || figures.size() == most_with_figures)
      continue;
    figures.push_back({parameter_channel(report, parameter) + ": " + parameter.name,
                       value_words(report, parameter)});
  }
  return figures;
}

Section parameters_section(const TuneReport& report) {
  Section section{
      .heading = fmt::format("Model {}", estimate::name_of(report.tuning.model)),
      .paragraphs = {"The readings are taken for " + model_words(report.tuning.model) + ".",
                     report.model_reason},
      .tables = {parameters_table(report)}};
  for (const TunedParameter& parameter : report.tuning.parameters) {
    if (parameter.value) continue;
    section.points.push_back(parameter_channel(report, parameter) + ": " + parameter.name + ": " +
                             reason_words(report, parameter) + ".");
  }
  return section;
}

Section innovations_section(const TuneReport& report, std::size_t channel) {
  Section section{.heading = report.channels[channel].name + ": what the filter did not foresee",
                  .figures = {innovations_figure(report, channel)}};
  for (Figure& figure : innovation_memory_figures(report, channel))
    section.figures.push_back(std::move(figure));
  return section;
}

Section study_section(const TuneStudy& study) {
  return {.heading = study.channel + ": gain and covariance",
          .paragraphs = {"They hang on Q, R and the step, not on the readings: Q as the density of "
                         "the white jerk, R as the variance of a reading. A gain has settled where "
                         "it stays within 2 % of its limit."},
          .tables = {settling_table(study), step_table(study)},
          .figures = {gain_figure(study), covariance_figure(study), step_figure(study)}};
}

Section method_section() {
  return {.heading = "How it was computed",
          .paragraphs = {
              "The parameters maximise the likelihood of the innovations, with an exact diffuse "
              "start. The search begins at the Allan variance, takes a few steps of "
              "expectation–maximisation, which always gain but slowly, and then follows the exact "
              "gradient, which one pass of the smoother gives.",
              "Standard deviations come from the curvature at the maximum, in logarithms; an "
              "interval wider than ±20 % from the likelihood itself, all else fitted anew. A noise "
              "without which the likelihood is hardly worse is not told from zero: it has an upper "
              "limit and no value."}};
}

}  // namespace

std::string tune_html(const TuneReport& report) {
  Page page{.verb = "tune",
            .title = report.inputs.empty() ? "" : file_name(report.inputs.front()),
            .inputs = report.inputs,
            .conclusion = tune_conclusion(report),
            .key_figures = key_figures(report),
            .notes = report.notes};
  page.sections.push_back(parameters_section(report));
  page.sections.push_back(
      consistency_section(report.consistency, noise_names(report.tuning.model)));
  for (std::size_t k = 0; k < report.channels.size() && k < most_with_figures; ++k) {
    page.sections.push_back(innovations_section(report, k));
  }
  for (const TuneStudy& study : report.studies) page.sections.push_back(study_section(study));
  page.sections.push_back(method_section());
  return html(page);
}

}  // namespace proofmass::report
