#pragma once

#include <optional>
#include <string>
#include <vector>

#include "proofmass/characterise/drift_analysis.hpp"
#include "proofmass/characterise/run_set.hpp"
#include "proofmass/characterise/temperature_model.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/report/rest_share.hpp"

namespace proofmass::report {

/// What the bias at a later time costs in position.
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
  bool every_run = false;  ///< the text goes on from a set of runs to each of them
};

/// The document of `drift`: docs/schema/drift.schema.json.
[[nodiscard]] std::string drift_json(const DriftReport& report);

/// The page: conclusion, key figures, and for each channel the data with the curve, the residuals
/// at three scales, their autocorrelation, the profile of the time constant, the shapes tried,
/// temperature and forecast; of several runs their levels and the warm-up that they share.
[[nodiscard]] std::string drift_html(const DriftReport& report);

/// For a terminal, without colour, closed by a newline: per channel plain sentences and a table.
[[nodiscard]] std::string drift_text(const DriftReport& report);

/// "x: warm-up of 5.0 ± 0.1 mg with time constant 900 ± 20 s", or that there is none to be told.
[[nodiscard]] std::string drift_conclusion(const DriftReport& report);

/// All notes: the report's own, then each channel's with its name, refusals as Severity::bad. Why a
/// figure is null stands in the document alone.
[[nodiscard]] std::vector<Note> drift_notes(const DriftReport& report);

/// Block means, curve, its standard deviation, and the bias with its wander but without white
/// noise, against time: what `--output` writes.
[[nodiscard]] Recording drift_series(const DriftReport& report);

}  // namespace proofmass::report
