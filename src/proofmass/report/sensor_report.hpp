#pragma once

#include <string>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/sensor/sensor_comparison.hpp"
#include "proofmass/sensor/sensor_model.hpp"

namespace proofmass::report {

/// A sensor file as it is.
struct SensorShow {
  std::string file;
  sensor::SensorModel model;
  std::vector<Note> notes;
};

/// The document of `sensor show`: docs/schema/sensor.schema.json.
[[nodiscard]] std::string sensor_show_json(const SensorShow& report);

/// Every figure with its unit, standard deviation and origin.
[[nodiscard]] std::string sensor_show_html(const SensorShow& report);

/// The same for a terminal.
[[nodiscard]] std::string sensor_show_text(const SensorShow& report);

/// Two sensor files and what has changed from the one to the other.
struct SensorDiff {
  std::string old_file, new_file;
  std::vector<Note> notes;  ///< of the files; the comparison has its own
  sensor::SensorComparison comparison;
};

/// The document of `sensor diff`: docs/schema/sensor.schema.json.
[[nodiscard]] std::string sensor_diff_json(const SensorDiff& report);

/// What has changed, by how many standard deviations, and what it would do to use the old file.
[[nodiscard]] std::string sensor_diff_html(const SensorDiff& report);

/// The same for a terminal.
[[nodiscard]] std::string sensor_diff_text(const SensorDiff& report);

/// What it comes to, in sentences.
[[nodiscard]] std::vector<std::string> sensor_diff_findings(const SensorDiff& report);

}  // namespace proofmass::report
