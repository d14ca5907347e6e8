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

/// Temperature-dependent part that was removed from a channel.
struct TemperatureEffect {
  std::string channel;    ///< channel with the temperature
  Uncertain coefficient;  ///< unit of the series per `per`
  std::string per = "K";  ///< unit of the temperature channel; "1" if unknown
};

/// One channel at rest: its analysis, or the reason for its absence.
struct ChannelNoise {
  std::string name;
  Unit unit;  ///< unit of the analysed series: SI if known, else counts or none
  std::optional<characterise::NoiseAnalysis> analysis;
  std::string refused;  ///< reason if there is no analysis
  std::optional<TemperatureEffect> temperature;
  std::optional<RestShare> rest;  ///< absent if rest was not determined
};

/// Noise of a recording and its input.
struct NoiseReport {
  std::vector<std::string> inputs;  ///< files, as the user named them
  std::vector<ChannelNoise> channels;
  std::vector<Note> notes;  ///< notes of reading and preparation; those of the analyses are added
  bool events_excluded = false;
};

/// For each channel the deviation, its decomposition into coefficients, the spectrum, lines and
/// events. Holds a reference to the report, which must outlive it.
[[nodiscard]] Document describe(const NoiseReport& report);

/// The deviation curves as a table without a time base: tau_s, then for each channel value, lower
/// and upper limit; NaN if a channel does not have that τ. The content of `--output`.
[[nodiscard]] Recording noise_series(const NoiseReport& report);

}  // namespace proofmass::report
