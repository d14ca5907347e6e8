#pragma once

#include <optional>
#include <string>
#include <vector>

#include "proofmass/characterise/drift_analysis.hpp"
#include "proofmass/characterise/run_set.hpp"
#include "proofmass/characterise/temperature_model.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/report/document.hpp"
#include "proofmass/report/rest_share.hpp"

namespace proofmass::report {

/// Forecast of the bias at a later time.
struct DriftOutlook {
  std::optional<characterise::DriftForecast> forecast;
  std::string refused;  ///< reason if there is none
};

/// Bias against temperature, or the reason why there is no such curve.
struct DriftTemperature {
  std::string channel;  ///< channel with the temperature
  std::optional<characterise::TemperatureModel> model;
  std::string refused;
};

/// One channel of one recording at rest: its analysis, or the reason for its absence.
struct ChannelDrift {
  std::string name;
  std::string file;
  Unit unit;  ///< unit of the analysed series: SI if known, else counts or none
  std::optional<characterise::DriftAnalysis> analysis;
  std::string refused;
  std::optional<DriftOutlook> outlook;          ///< present if a forecast was requested
  std::optional<DriftTemperature> temperature;  ///< present if there is a temperature channel
  std::optional<RestShare> rest;                ///< absent if rest was not determined
};

/// One channel over several power-ups.
struct ChannelRuns {
  std::string name;
  Unit unit;
  std::optional<characterise::RunSet> set;
  std::string refused;
};

/// The drift of one or more recordings and its input.
struct DriftReport {
  std::vector<std::string> inputs;  ///< files, as the user named them
  std::vector<ChannelDrift> channels;
  std::vector<ChannelRuns> runs;  ///< one per channel, from three recordings on
  std::vector<Note> notes;  ///< notes of reading and preparation; those of the analyses are added
  double since_switch_on_s = 0.0;
  std::optional<double> forecast_s;
  bool every_run = false;  ///< the text includes a section for each run of a set
};

/// For each channel: fitted curve, residuals at three scales and their autocorrelation, profile of
/// the time constant, the shapes tried, temperature and forecast. For several runs: their levels
/// and their common warm-up. Holds a reference to the report, which must outlive it.
[[nodiscard]] Document describe(const DriftReport& report);

/// Block means, curve, its standard deviation, and the bias without white noise, against time; the
/// content of `--output`.
[[nodiscard]] Recording drift_series(const DriftReport& report);

}  // namespace proofmass::report
