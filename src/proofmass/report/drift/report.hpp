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

/// Bias at a later time.
struct DriftOutlook {
  std::optional<characterise::DriftForecast> forecast;
  std::string refused;  ///< why there is none
};

/// Bias against temperature, or why there is no such curve.
struct DriftTemperature {
  std::string channel;  ///< that holds the temperature
  std::optional<characterise::TemperatureModel> model;
  std::string refused;
};

/// One channel of one recording at rest: its analysis, or why there is none.
struct ChannelDrift {
  std::string name;
  std::string file;
  Unit unit;  ///< of the series analysed: SI where known, else counts or none
  std::optional<characterise::DriftAnalysis> analysis;
  std::string refused;
  std::optional<DriftOutlook> outlook;          ///< where a forecast was asked for
  std::optional<DriftTemperature> temperature;  ///< where there is a temperature channel
  std::optional<RestShare> rest;                ///< absent where it was not looked for
};

/// One channel over several power-ups.
struct ChannelRuns {
  std::string name;
  Unit unit;
  std::optional<characterise::RunSet> set;
  std::string refused;
};

/// The drift of one or more recordings and what it was computed from.
struct DriftReport {
  std::vector<std::string> inputs;  ///< files, as the user named them
  std::vector<ChannelDrift> channels;
  std::vector<ChannelRuns> runs;  ///< of three recordings or more
  std::vector<Note> notes;        ///< of reading and preparing; those of the analyses are added
  double since_switch_on_s = 0.0;
  std::optional<double> forecast_s;
  bool every_run = false;  ///< the text has a section for each run of a set
};

/// For each channel the fitted curve, residuals at three scales, their autocorrelation, the profile
/// of the time constant, the shapes tried, temperature and forecast; for several runs their levels
/// and the warm-up that they share. It refers to the report, which must outlive it.
[[nodiscard]] Document describe(const DriftReport& report);

/// Block means, curve, its standard deviation, and the bias without white noise, against time: what
/// `--output` writes.
[[nodiscard]] Recording drift_series(const DriftReport& report);

}  // namespace proofmass::report
