#pragma once

#include <string>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/estimate/tune.hpp"
#include "proofmass/estimate/tune_choice.hpp"
#include "proofmass/estimate/tune_study.hpp"
#include "proofmass/report/document.hpp"

namespace proofmass::report {

/// Name and unit of a channel, beside its tuning.
struct TuneChannel {
  std::string name;
  Unit unit;  ///< unit of the analysed series: SI if known, else counts or none
  std::size_t segments = 1;
};

struct TuneReport {
  std::vector<std::string> inputs;
  std::vector<Note> notes;
  estimate::TuneChoice choice;
  estimate::Tuning tuning;
  std::vector<TuneChannel> channels;  ///< in the order of tuning.series
  estimate::Consistency consistency;
  std::vector<estimate::TuneStudy> studies;  ///< for channels with two white noises
};

/// A warning for each channel with outliers, which were not used.
[[nodiscard]] std::vector<Note> outlier_notes(const TuneReport& report);

/// Model, parameters, innovations, study of gain and covariance. Holds a reference to the report,
/// which must outlive it.
[[nodiscard]] Document describe(const TuneReport& report);

/// Innovations and their predicted standard deviations against time; the content of `--output`.
[[nodiscard]] Recording tune_series(const TuneReport& report);

}  // namespace proofmass::report
