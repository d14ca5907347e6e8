// The tables of docs/methods/wheel.md, and with --live that of docs/methods/live.md:
// wheel_coverage [--live] [--recordings N] [--first SEED] [--each] [SCENARIO...]
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "wheel_live_coverage.hpp"

namespace {

using proofmass::wheel_world::Coverage;
using proofmass::wheel_world::LiveCoverage;
using proofmass::wheel_world::Scenario;
using proofmass::wheel_world::Tally;

void cell(const Tally& tally) {
  if (tally.given() == 0) {
    std::printf(tally.none > 0 ? " none |" : " |");
    return;
  }
  const double given = static_cast<double>(tally.given());
  const double share =
      100.0 * static_cast<double>(tally.none) / (given + static_cast<double>(tally.none));
  std::printf(" %.0f %%, %.1f", 100.0 * tally.coverage_95(), tally.largest());
  if (tally.none > 0) std::printf(", %.0f %% none", share);
  std::printf(" |");
}

void print_header(bool live) {
  if (live)
    std::printf(
        "| scenario | never found | angle | smoothed angle | with turns | speed | slipped | "
        "silently |\n"
        "|---|---|---|---|---|---|---|---|\n");
  else
    std::printf(
        "| scenario | refused | turns | final angle | radius | bias | scale | skew | encoder's "
        "errors | gyroscope | rolling radius |\n"
        "|---|---|---|---|---|---|---|---|---|---|---|\n");
}

void print_row(const Scenario& scenario, const Coverage& found) {
  std::printf("| %s | %zu |", scenario.name, found.refused);
  for (const Tally* tally : {&found.turns, &found.angle, &found.radius, &found.bias, &found.scale,
                             &found.skew, &found.encoder, &found.gyro, &found.rolling})
    cell(*tally);
  std::printf("\n");
}

void print_row(const Scenario& scenario, const LiveCoverage& found) {
  std::printf("| %s | %zu |", scenario.name, found.never_found);
  for (const Tally* tally : {&found.angle, &found.smoothed, &found.counted, &found.speed})
    cell(*tally);
  std::printf(" %zu | %zu |\n", found.slipped, found.silently);
}

}  // namespace

int main(int count, char** arguments) {
  int recordings = 100;
  std::uint64_t first = 1;
  bool each = false, live = false;
  std::vector<std::string_view> names;
  for (int i = 1; i < count; ++i) {
    const std::string_view word = arguments[i];
    if (word == "--recordings" && i + 1 < count)
      recordings = std::atoi(arguments[++i]);
    else if (word == "--first" && i + 1 < count)
      first = static_cast<std::uint64_t>(std::atoll(arguments[++i]));
    else if (word == "--each")
      each = true;
    else if (word == "--live")
      live = true;
    else
      names.push_back(word);
  }
  print_header(live);
  for (const auto& scenario : proofmass::wheel_world::scenarios()) {
    bool wanted = names.empty();
    for (const std::string_view name : names) wanted = wanted || name == scenario.name;
    if (!wanted) continue;
    if (live)
      print_row(scenario,
                proofmass::wheel_world::live_coverage_of(scenario, first, recordings, each));
    else
      print_row(scenario, proofmass::wheel_world::coverage_of(scenario, first, recordings, each));
    std::fflush(stdout);
  }
}
