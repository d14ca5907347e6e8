#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/core/progress.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/thesis/angular_bias.hpp"
#include "proofmass/thesis/item.hpp"
#include "proofmass/thesis/static_bias.hpp"
#include "proofmass/thesis/wheel_runs.hpp"

// The whole programme of the thesis, from the first table to the last.
namespace proofmass::thesis {

/// Recordings from a user's own rig; those absent are simulated.
struct OwnRecordings {
  std::optional<StaticRecord> still;
  std::optional<TumbleRecord> tumble;
  std::vector<WheelRecord> wheel;  ///< one for each speed
};

struct ProgrammeOptions {
  std::uint64_t seed = 1;
  std::size_t seeds = 50;             ///< simulated runs at each speed, for the bands
  double static_duration_s = 7200.0;  ///< of the simulated test at rest
  double gravity_mps2 = standard_gravity_mps2;
  Progress progress = {};
};

struct Programme {
  std::vector<Item> items = {};  ///< in the order of the thesis
  /// Those of "static", "tumble" and "wheel" without a recording.
  std::vector<std::string> simulated = {};
};

/// Runs the programme on the recordings, or else on the simulated rig. The same recordings, options
/// and seed give the same items.
///
/// Errors: those of the analyses, with the recording's name; invalid_argument (options). Cost:
/// about 20 s of one processor if all is simulated; independent parts run in parallel.
[[nodiscard]] Result<Programme> run_programme(const OwnRecordings& own,
                                              const ProgrammeOptions& options);

}  // namespace proofmass::thesis
