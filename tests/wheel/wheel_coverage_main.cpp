// The table of docs/methods/wheel.md: wheel_coverage [--recordings N] [--first SEED] [--each]
// [SCENARIO...]
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "wheel_coverage.hpp"

namespace {

using proofmass::wheel_world::Coverage;
using proofmass::wheel_world::Tally;

void cell(const Tally& tally) {
  if (tally.given() == 0) {
    std::printf(" none |");
    return;
  }
  const double given = static_cast<double>(tally.given());
  const double share =
      100.0 * static_cast<double>(tally.none) / (given + static_cast<double>(tally.none));
  std::printf(" %.0f %%, %.1f", 100.0 * tally.coverage_95(), tally.largest());
  if (tally.none > 0) std::printf(", %.0f %% none", share);
  std::printf(" |");
}

}  // namespace

int main(int count, char** arguments) {
  int recordings = 100;
  std::uint64_t first = 1;
  bool each = false;
  std::vector<std::string_view> names;
  for (int i = 1; i < count; ++i) {
    const std::string_view word = arguments[i];
    if (word == "--recordings" && i + 1 < count)
      recordings = std::atoi(arguments[++i]);
    else if (word == "--first" && i + 1 < count)
      first = static_cast<std::uint64_t>(std::atoll(arguments[++i]));
    else if (word == "--each")
      each = true;
    else
      names.push_back(word);
  }
  std::printf(
      "| scenario | refused | turns | final angle | radius | bias | scale | skew |\n"
      "|---|---|---|---|---|---|---|---|\n");
  for (const auto& scenario : proofmass::wheel_world::scenarios()) {
    bool wanted = names.empty();
    for (const std::string_view name : names) wanted = wanted || name == scenario.name;
    if (!wanted) continue;
    const Coverage found = proofmass::wheel_world::coverage_of(scenario, first, recordings, each);
    std::printf("| %s | %zu |", scenario.name, found.refused);
    for (const Tally* tally :
         {&found.turns, &found.angle, &found.radius, &found.bias, &found.scale, &found.skew})
      cell(*tally);
    std::printf("\n");
    std::fflush(stdout);
  }
}
