#pragma once

#include <optional>

#include "proofmass/core/result.hpp"
#include "proofmass/thesis/item.hpp"
#include "proofmass/thesis/thesis_paths.hpp"
#include "proofmass/thesis/wheel/first_turn.hpp"
#include "proofmass/thesis/wheel/run_errors.hpp"
#include "proofmass/thesis/wheel/study.hpp"

// Shared by the items of section 5.4 on one pair of axes.
namespace proofmass::thesis {

/// Statements of the thesis on one pair of axes.
struct Pair {
  WheelAxis axis;
  const char *accel_id, *path_id;
  const char* axes;
  std::optional<ThesisErrors> RunErrors::*cancelled, RunErrors::*gravity;
};

/// One revolution by the thesis's estimators, both ways of fusing.
struct PairPaths {
  std::optional<FusedReading> cancelled, gravity;
  std::optional<ThesisPaths> cancelled_paths, gravity_paths;
};

/// Figures 5.12 and 5.14: motor/pair_accel_item.cpp.
[[nodiscard]] Item pair_accel_item(const WheelStudy& study,
                                   const Pair& pair,
                                   const PairPaths& paths);

/// Figures 5.13 and 5.15: motor/pair_path_item.cpp.
[[nodiscard]] Item pair_path_item(const WheelStudy& study,
                                  const Pair& pair,
                                  const PairPaths& paths);

}  // namespace proofmass::thesis
