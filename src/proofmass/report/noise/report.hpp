#pragma once

#include <optional>
#include <string>
#include <vector>

#include "proofmass/characterise/noise_analysis.hpp"
#include "proofmass/core/quantity.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/report/document.hpp"
#include "proofmass/report/rest_share.hpp"

namespace proofmass::report {

/// What was taken out of a channel because it follows the temperature.
struct TemperatureEffect {
  std::string channel;    ///< that holds the temperature
  Uncertain coefficient;  ///< unit of the series per `per`
  std::string per = "K";  ///< unit of the temperature channel; "1" if unknown
};

/// One channel at rest: its analysis, or why there is none.
struct ChannelNoise {
  std::string name;
  Unit unit;  ///< of the series analysed: SI where known, else counts or none
  std::optional<characterise::NoiseAnalysis> analysis;
  std::string refused;  ///< the reason, where there is no analysis
  std::optional<TemperatureEffect> temperature;
  std::optional<RestShare> rest;  ///< absent where it was not looked for
};

/// Noise of a recording and what it was computed from.
struct NoiseReport {
  std::vector<std::string> inputs;  ///< files, as the user named them
  std::vector<ChannelNoise> channels;
  std::vector<Note> notes;  ///< of reading and preparing; those of the analyses are added
  bool events_excluded = false;
};

/// For each channel the deviation, its decomposition into coefficients, the spectrum, lines and
/// events. It refers to the report, which must outlive it.
[[nodiscard]] Document describe(const NoiseReport& report);

/// The deviation curves as a table without a time base: tau_s, then for each channel value, lower
/// and upper limit; NaN where a channel has no such τ. What `--output` writes.
[[nodiscard]] Recording noise_series(const NoiseReport& report);

}  // namespace proofmass::report
