#pragma once

#include <optional>
#include <string>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/report/document.hpp"
#include "proofmass/sensor/sensor_comparison.hpp"
#include "proofmass/sensor/sensor_model.hpp"

namespace proofmass::report {

/// The content of a sensor file.
struct SensorShow {
  std::string file;
  sensor::SensorModel model;
  std::vector<Note> notes;
};

/// The result of `sensor show`: every figure with its unit, standard deviation and origin.
[[nodiscard]] Document describe(const SensorShow& report);

/// Two sensor files and the changes from one to the other.
struct SensorDiff {
  std::string old_file, new_file;
  std::vector<Note> notes;  ///< notes of the files; the comparison has its own
  sensor::SensorComparison comparison;
};

/// The result of `sensor diff`: the changes, also in standard deviations, and the error that the
/// old file would cause.
[[nodiscard]] Document describe(const SensorDiff& report);

/// A sensor file in another format.
struct SensorExport {
  std::string file, format;           ///< format: "imu-yaml" or "c-header"
  std::optional<std::string> output;  ///< file written, "-" for standard output
  std::string text;                   ///< the export itself
  std::vector<Note> notes;
};

/// The result of `sensor export`.
[[nodiscard]] Document describe(const SensorExport& report);

}  // namespace proofmass::report
