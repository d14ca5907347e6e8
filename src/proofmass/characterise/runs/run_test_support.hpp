#pragma once

#include <string>
#include <vector>

#include "proofmass/characterise/noise/noise_test_support.hpp"
#include "proofmass/characterise/run_set.hpp"

// Sets of simulated runs.
namespace proofmass::characterise::test {

struct RunSource {
  std::size_t runs = 10, samples = 512;
  double rate_hz = 8.0, white = 1.0;  ///< 64 s, so that the means scatter by 1/8
  double between_std = 0.0;
  unsigned seed = 1;
};

struct MadeRuns {
  std::vector<Series> series;
  std::vector<Run> runs;
};

inline void make_views(MadeRuns& made, double rate_hz) {
  made.runs.clear();
  for (std::size_t i = 0; i < made.series.size(); ++i)
    made.runs.push_back({"run" + std::to_string(i + 1), made.series[i], rate_hz});
}

inline MadeRuns made_of(const RunSource& source) {
  MadeRuns made;
  const Series level = normals(source.runs, 1000003 * source.seed);
  for (std::size_t i = 0; i < source.runs; ++i) {
    const auto own = static_cast<unsigned>(i + 1);
    made.series.push_back(
        white(source.white, source.rate_hz, source.samples, 1000003 * source.seed + own));
    for (double& y : made.series.back()) y += source.between_std * level[i];
  }
  make_views(made, source.rate_hz);
  return made;
}

}  // namespace proofmass::characterise::test
