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

/// One channel beside what was tuned by it.
struct TuneChannel {
  std::string name;
  Unit unit;  ///< of the series analysed: SI where known, else counts or none
  std::size_t segments = 1;
};

struct TuneReport {
  std::vector<std::string> inputs;
  std::vector<Note> notes;
  estimate::TuneChoice choice;
  estimate::Tuning tuning;
  std::vector<TuneChannel> channels;  ///< as tuning.series
  estimate::Consistency consistency;
  std::vector<estimate::TuneStudy> studies;  ///< of channels with two white noises
};

/// Model, parameters, innovations, study of gain and covariance. It refers to the report, which
/// must outlive it.
[[nodiscard]] Document describe(const TuneReport& report);

/// Innovations and the standard deviations that the filter states, against time: what `--output`
/// writes.
[[nodiscard]] Recording tune_series(const TuneReport& report);

}  // namespace proofmass::report
