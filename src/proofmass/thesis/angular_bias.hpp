#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "proofmass/calibrate/tumble.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/thesis/item.hpp"

// Section 5.1.2: the four-point tumble test of the x and y axes at 3.3 V.
namespace proofmass::thesis {

/// One output at all positions.
struct TumbleChannel {
  std::string name;
  Unit unit;                        ///< unit of the outputs
  std::vector<double> output, std;  ///< at each position; std NaN if unknown
  double noise_dof = 0.0;           ///< degrees of freedom of std; 0: infinite
};

struct TumbleRecord {
  std::string source;  ///< the file, or "simulated"
  bool simulated = false;
  std::vector<calibrate::TumblePosition> positions;  ///< without outputs
  std::vector<TumbleChannel> channels;
};

/// The rig's first sensor on a table, 0° to 360° in steps of 90°, in volts, with the bias and scale
/// factor of table 5.1.
[[nodiscard]] Result<TumbleRecord> simulate_tumble(std::uint64_t seed, double gravity_mps2);

/// Figures 5.4, 5.5 and 5.6, table 5.1.
/// Errors: those of fit_tumble(), with the channel's name.
[[nodiscard]] Result<std::vector<Item>> tumble_items(const TumbleRecord& record,
                                                     double gravity_mps2);

}  // namespace proofmass::thesis
