#include "proofmass/thesis/motor/turning_items.hpp"

#include "proofmass/thesis/motor/turning_parts.hpp"

namespace proofmass::thesis {

Result<std::vector<Item>> turning_items(const WheelStudy& study) {
  const auto run = angular_run(study.at_11rpm().turn);
  if (!run) return run.error();
  return std::vector<Item>{turning_accel_item(study, *run), turning_angle_item(study, *run)};
}

}  // namespace proofmass::thesis
