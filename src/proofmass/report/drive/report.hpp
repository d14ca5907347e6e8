#pragma once

#include <string>
#include <vector>

#include "proofmass/estimate/drive.hpp"
#include "proofmass/report/document.hpp"
#include "proofmass/report/page/figure.hpp"

namespace proofmass::report {

/// A solution and what it was computed from.
struct DriveReport {
  std::vector<std::string> inputs;  ///< files, as the user named them
  std::vector<Note> notes;          ///< of reading; the solution's own are added
  estimate::DriveSolution solution;
};

/// Distance, heading, end position and the vehicle's constants, with the path drawn to scale. It
/// refers to the report, which must outlive it.
[[nodiscard]] Document describe(const DriveReport& report);

/// The path as a recording with the columns time, x, x_std, y, …: what `--output` writes. Empty of
/// samples where the path is not determined.
[[nodiscard]] Recording drive_series(const DriveReport& report);

/// The path as a GeoJSON FeatureCollection (RFC 7946): a line in longitude and latitude, with the
/// figures as its properties. Without fixes or a path, a collection without features.
[[nodiscard]] std::string drive_geojson(const DriveReport& report);

/// The path seen from above, one metre alike along both axes, with 95 % ellipses.
[[nodiscard]] Figure path_figure(const estimate::DriveSolution& solution);
[[nodiscard]] Figure heading_figure(const estimate::DriveSolution& solution);
[[nodiscard]] Figure drive_speed_figure(const estimate::DriveSolution& solution);

}  // namespace proofmass::report
