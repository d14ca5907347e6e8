// The table of docs/methods/servo.md: two ways to treat backlash in the filter of the drive.
#include <cstdio>

#include "observer_comparison.hpp"

int main() {
  using namespace proofmass::servo_comparison;
  constexpr int recordings = 20;
  std::printf("| motion | smooth dead zone | bank of contacts |\n|---|---|---|\n");
  for (const Scenario& scenario : scenarios()) {
    const Comparison found = compare(scenario, recordings);
    std::printf("| %s |", scenario.name);
    for (const Crossing* one : {&found.smooth, &found.bank})
      std::printf(" %.2f mrad, %.0f %%, %.1f |", 1e3 * one->rms_rad, 100.0 * one->coverage_95,
                  one->largest_z);
    std::printf("\n");
  }
}
