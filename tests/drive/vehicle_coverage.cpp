#include "vehicle_coverage.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace proofmass::drive_world {

void Coverage::add(const std::optional<Uncertain>& estimate, double truth) {
  if (!estimate) {
    ++absent;
    return;
  }
  const double error = (estimate->value - truth) / estimate->std;
  ++recordings;
  inside += std::abs(error) < 1.959964 ? 1 : 0;
  sum += error;
  sum2 += error * error;
  largest = std::max(largest, std::abs(error));
  rms_error += (estimate->value - truth) * (estimate->value - truth);
}

double Coverage::percent() const {
  return recordings == 0 ? 0.0
                         : 100.0 * static_cast<double>(inside) / static_cast<double>(recordings);
}

Covered cover(const Scenario& scenario, std::uint64_t first, std::size_t count) {
  Covered covered;
  Table& table = covered.table;
  for (std::size_t k = 0; k < count; ++k) {
    const World world = make_world(scenario, first + k);
    const auto solved =
        estimate::estimate_drive(world.wheels, world.frame, world.fixes, world.options);
    if (!solved) {
      ++covered.refused;
      continue;
    }
    const Truth& truth = world.truth;
    table["distance"].add(solved->distance_m, truth.distance_m);
    table["heading"].add(solved->heading_change_rad, truth.heading_change_rad);
    table["end x"].add(solved->end_m[0], truth.end_m[0]);
    table["end y"].add(solved->end_m[1], truth.end_m[1]);
    if (scenario.left && scenario.right) table["track"].add(solved->track_m, truth.track_m);
    if (scenario.front_axle) table["wheelbase"].add(solved->wheelbase_m, truth.wheelbase_m);
    if (scenario.fixes && solved->heading_start_rad) {
      Uncertain start = *solved->heading_start_rad;
      start.value = truth.heading_start_rad +
                    std::remainder(start.value - truth.heading_start_rad, 2.0 * std::numbers::pi);
      table["heading start"].add(start, truth.heading_start_rad);
    }
    for (std::size_t i = 0; i < solved->wheels.size(); ++i) {
      table["circumference"].add(solved->wheels[i].circumference_m, truth.circumference_m[i]);
      if (scenario.own_clocks && truth.clock_offset_s[i] != 0.0)
        table["clock"].add(solved->wheels[i].clock_offset_s, truth.clock_offset_s[i]);
    }
  }
  return covered;
}

}  // namespace proofmass::drive_world
