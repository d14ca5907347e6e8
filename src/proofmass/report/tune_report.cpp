#include "proofmass/report/tune_report.hpp"

#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <map>

#include "proofmass/report/tune_wording.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using estimate::TunedParameter;
using estimate::TunedSeries;

std::string heading(const TuneReport& report, std::size_t k) {
  const TunedSeries& series = report.tuning.series[k];
  std::string text =
      fmt::format("{}: {} at {} Hz, {}", report.channels[k].name, duration_words(series.duration_s),
                  compact(series.rate_hz, 6), count_words(series.readings, "reading"));
  if (series.missing > 0) text += ", " + grouped(series.missing) + " missing";
  if (report.channels[k].segments > 1)
    text += ", in " + count_words(report.channels[k].segments, "rest");
  return text + fmt::format(", log-likelihood {}\n", fixed(series.log_likelihood, 3));
}

std::string study_text(const TuneStudy& study) {
  if (study.cases.empty()) return "";
  const estimate::GainStudy& tuned = study.cases.front().study;
  std::string text =
      fmt::format("{}: the gain settles at {}", study.channel, significant(tuned.limit[2], 3));
  if (tuned.settling_s[2]) text += " within " + compact(*tuned.settling_s[2], 3) + " s";
  return text + ".\n";
}

}  // namespace

std::string tune_conclusion(const TuneReport& report) {
  constexpr std::size_t most_told = 4;
  std::string text;
  std::size_t unknown = 0, found = 0;
  for (const TunedParameter& parameter : report.tuning.parameters) {
    if (parameter.verdict == estimate::TuneVerdict::fixed) continue;
    ++unknown;
    if (parameter.value) ++found;
    text +=
        fmt::format("{}{}: {} {}.", text.empty() ? "" : " ", parameter_channel(report, parameter),
                    parameter.name, value_words(report, parameter));
  }
  if (unknown > most_told)
    text = fmt::format("{} of {} of the model {} are found, in {}.", found,
                       count_words(unknown, "parameter"), estimate::name_of(report.tuning.model),
                       count_words(report.channels.size(), "channel"));
  return text + " " + consistency_conclusion(report.consistency, noise_names(report.tuning.model));
}

std::string tune_text(const TuneReport& report) {
  std::string text = fmt::format("Model {}: {}. {}\n\n", estimate::name_of(report.tuning.model),
                                 model_words(report.tuning.model), report.model_reason);
  for (std::size_t k = 0; k < report.channels.size(); ++k) text += heading(report, k);
  const Table table = parameters_table(report);
  std::vector<std::vector<std::string>> rows{table.head};
  rows.insert(rows.end(), table.rows.begin(), table.rows.end());
  text += '\n' + aligned(rows) + '\n';
  for (const TunedParameter& parameter : report.tuning.parameters) {
    if (parameter.value) continue;
    text += fmt::format("{}: {}: {}.\n", parameter_channel(report, parameter), parameter.name,
                        reason_words(report, parameter));
  }
  for (const TuneStudy& study : report.studies) text += study_text(study);
  return text + nis_words(report.consistency) + ". " +
         consistency_conclusion(report.consistency, noise_names(report.tuning.model)) + '\n';
}

Recording tune_series(const TuneReport& report) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  std::map<double, std::size_t> places;
  for (const TunedSeries& series : report.tuning.series) {
    for (const double t_s : series.time_s) places.emplace(t_s, 0);
  }
  Recording table;
  table.source = "proofmass tune";
  table.format = "series";
  table.time.source = TimeSource::stamps;
  for (auto& [t_s, place] : places) {
    place = table.time.stamps_s.size();
    table.time.stamps_s.push_back(t_s);
  }
  for (std::size_t c = 0; c < report.channels.size(); ++c) {
    const TunedSeries& series = report.tuning.series[c];
    std::vector<double> innovation(places.size(), none), std(places.size(), none);
    for (std::size_t k = 0; k < series.time_s.size(); ++k) {
      const std::size_t place = places.at(series.time_s[k]);
      innovation[place] = series.innovation[k];
      std[place] = std::sqrt(series.variance[k]);
    }
    const TuneChannel& channel = report.channels[c];
    table.channels.push_back({channel.name + "_innovation", channel.unit, std::move(innovation)});
    table.channels.push_back({channel.name + "_innovation_std", channel.unit, std::move(std)});
  }
  return table;
}

}  // namespace proofmass::report
