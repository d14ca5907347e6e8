#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/thesis/wheel/first_turn.hpp"
#include "proofmass/thesis/wheel/fourteen_state_filter.hpp"
#include "proofmass/thesis/wheel/run_errors.hpp"
#include "proofmass/thesis/wheel_runs.hpp"

// All runs of sections 5.4 to 5.6, each by every estimator.
namespace proofmass::thesis {

/// At one speed.
struct SpeedStudy {
  double speed_radps = 0.0;     ///< as set, or as measured
  FirstTurn turn;               ///< by estimate_wheel(): the user's record, or the first seed's run
  std::vector<RunErrors> runs;  ///< one for each seed; of a record its own
  std::vector<RunErrors> datasheet;  ///< with all errors of the datasheet; of a record none
};

struct WheelStudy {
  bool simulated = false;
  std::size_t seeds = 0;
  std::vector<SpeedStudy> speeds = {};  ///< rising
  std::size_t shown = 0;                ///< the speed of figures 5.12 to 5.19: nearest to 11 rpm
  std::optional<FourteenStateFilter> fourteen_state_filter = {};  ///< of its `turn`

  [[nodiscard]] const SpeedStudy& at_11rpm() const { return speeds[shown]; }
};

/// Errors: those of estimate_wheel(), with the recording's name. Cost: about 0.5 s for each speed,
/// and 10 ms for each seed at each speed.
[[nodiscard]] Result<WheelStudy> study_wheel(const std::vector<WheelRecord>& records,
                                             const WheelRunsOptions& options);

}  // namespace proofmass::thesis
