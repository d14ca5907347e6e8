#include "proofmass/thesis/motor/wheel_path_items.hpp"

#include <optional>
#include <utility>

#include "proofmass/thesis/gain/kalman_gain_item.hpp"
#include "proofmass/thesis/motor/pair_parts.hpp"

namespace proofmass::thesis {
namespace {

constexpr Pair roll{WheelAxis::forward, "figure 5.12",    "figure 5.13",
                    "y1 and y2",        &RunErrors::roll, &RunErrors::roll_gravity};
constexpr Pair pitch{WheelAxis::outward, "figure 5.14",     "figure 5.15",
                     "x1 and x2",        &RunErrors::pitch, &RunErrors::pitch_gravity};

Result<PairPaths> paths_of(const FirstTurn& turn, WheelAxis axis) {
  PairPaths paths{.cancelled = fuse(turn, axis, Fusion::gravity_cancelled),
                  .gravity = fuse(turn, axis, Fusion::gravity_left_in),
                  .cancelled_paths = {},
                  .gravity_paths = {}};
  for (auto [reading, path] : {std::pair{&paths.cancelled, &paths.cancelled_paths},
                               std::pair{&paths.gravity, &paths.gravity_paths}}) {
    if (!*reading) continue;
    Result<ThesisPaths> found = thesis_paths(**reading);
    if (!found) return Error(found.error()).at(turn.source);
    *path = std::move(found).value();
  }
  return paths;
}

}  // namespace

Result<std::vector<Item>> wheel_path_items(const WheelStudy& study) {
  std::vector<Item> items;
  const FirstTurn& turn = study.at_11rpm().turn;
  for (const Pair* pair : {&roll, &pitch}) {
    const Result<PairPaths> paths = paths_of(turn, pair->axis);
    if (!paths) return paths.error();
    items.push_back(pair_accel_item(study, *pair, *paths));
    items.push_back(pair_path_item(study, *pair, *paths));
    if (pair == &roll)
      items.push_back(
          kalman_gain_item(turn, *(paths->cancelled ? paths->cancelled : paths->gravity),
                           *(paths->cancelled ? paths->cancelled_paths : paths->gravity_paths)));
  }
  return items;
}

}  // namespace proofmass::thesis
