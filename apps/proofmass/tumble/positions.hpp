#pragma once

#include <optional>
#include <string>
#include <vector>

#include "proofmass/calibrate/tumble/model.hpp"
#include "proofmass/core/recording.hpp"
#include "tumble/command.hpp"

// From tables of positions, or recordings that rest in them, to the readings of a tumble.
namespace proofmass::app {

/// One output over all positions, in SI where its unit is known.
struct TumbleOutput {
  std::string name;
  Unit unit;
  std::vector<double> values, std;  ///< std 0 where nobody knows it
  double noise_dof = 0.0;           ///< of std; 0: infinitely many
  std::optional<std::size_t> axis;  ///< 0, 1, 2 for x, y, z of the only accelerometer
};

struct TumbleReadings {
  std::vector<calibrate::TumblePosition> positions;  ///< without outputs
  std::vector<TumbleOutput> outputs;
  std::string source;  ///< "a table of 12 positions"
};

/// All files as one test. Notes of reading are added to `notes`. Throws Failure.
[[nodiscard]] TumbleReadings tumble_readings(const TumbleCommand& command,
                                             std::vector<Note>& notes);

}  // namespace proofmass::app
