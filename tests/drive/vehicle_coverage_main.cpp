#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "vehicle_coverage.hpp"

// vehicle_coverage [SCENARIO [COUNT [SEED]]] prints the table of docs/methods/drive.md.
int main(int count, char** words) {
  using namespace proofmass::drive_world;
  const std::string_view wanted = count > 1 ? words[1] : "all";
  const auto recordings = static_cast<std::size_t>(count > 2 ? std::atoi(words[2]) : 100);
  const auto seed = static_cast<std::uint64_t>(count > 3 ? std::atoi(words[3]) : 9001);
  for (const Scenario& scenario : scenarios()) {
    if (wanted != "all" && wanted != scenario.name) continue;
    const Covered covered = cover(scenario, seed, recordings);
    std::printf("%s: refused %zu\n", scenario.name.c_str(), covered.refused);
    for (const auto& [name, coverage] : covered.table) {
      const double n = static_cast<double>(coverage.recordings);
      std::printf(
          "  %-14s %5.1f %%  n %zu none %zu  mean %+.2f  rms %.2f  largest %.1f  rms error %.4g\n",
          name.c_str(), coverage.percent(), coverage.recordings, coverage.absent, coverage.sum / n,
          std::sqrt(coverage.sum2 / n), coverage.largest, std::sqrt(coverage.rms_error / n));
    }
    std::fflush(stdout);
  }
}
