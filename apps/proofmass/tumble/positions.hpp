#pragma once

#include <optional>
#include <string>
#include <vector>

#include "proofmass/calibrate/tumble/model.hpp"
#include "proofmass/core/recording.hpp"
#include "tumble/command.hpp"

// Outputs of a tumble test from tables of positions, or from recordings with a rest in each
// position.
namespace proofmass::app {

/// One output over all positions, in SI if its unit is known.
struct TumbleOutput {
  std::string name;
  Unit unit;
  std::vector<double> values, std;  ///< std is 0 if unknown
  double noise_dof = 0.0;           ///< of std; 0: infinite
  std::optional<std::size_t> axis;  ///< 0, 1, 2 for x, y, z of the only accelerometer
};

struct TumbleReadings {
  std::vector<calibrate::TumblePosition> positions;  ///< without outputs
  std::vector<TumbleOutput> outputs;
  std::string source;  ///< "a table of 12 positions"
};

/// All files combined into one test. Notes of reading are added to `notes`. Throws Failure.
[[nodiscard]] TumbleReadings tumble_readings(const TumbleCommand& command,
                                             std::vector<Note>& notes);

}  // namespace proofmass::app
