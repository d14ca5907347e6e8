#include "proofmass/signal/rests.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/core/contract.hpp"
#include "proofmass/signal/rests/ends.hpp"
#include "proofmass/signal/rests/lengths.hpp"

namespace proofmass::signal {
namespace {

double samples_in(const RestBlocks& blocks, const RestRun& run) {
  double count = 0.0;
  for (std::size_t k = run.first; k < run.end; ++k) count += blocks.count[k];
  return count;
}

Rest rest_of(const RestBlocks& blocks, const RestRun& run) {
  Rest rest{blocks.first_sample(run.first), blocks.end_sample(run.end - 1) - 1};
  while (rest.first < rest.last && !blocks.is_there(rest.first)) ++rest.first;
  while (rest.first < rest.last && !blocks.is_there(rest.last)) --rest.last;
  return rest;
}

/// Standard deviation of one sample about the mean of its window, over all runs.
std::vector<double> std_over(const RestBlocks& blocks, const std::vector<RestRun>& runs) {
  PerAxis squares{};
  double free = 0.0;
  for (const RestRun& run : runs)
    for (std::size_t k = run.first; k < run.end; k += blocks.window) {
      const RestBlock window = joined(blocks, k, std::min(blocks.window, run.end - k));
      if (window.count < 2.0) continue;
      for (std::size_t a = 0; a < blocks.axes; ++a) squares[a] += window.squares[a];
      free += window.count - 1.0;
    }
  std::vector<double> std(blocks.axes);
  for (std::size_t a = 0; a < blocks.axes; ++a)
    std[a] = std::sqrt(squares[a] / std::max(1.0, free));
  return std;
}

}  // namespace

RestLengths rest_lengths(const RestOptions& options) {
  constexpr double usual_s = 0.5;
  constexpr double usual_samples = 50.0;
  constexpr double least_samples = 8.0;
  const double rate_hz = options.rate_hz > 0.0 ? options.rate_hz : usual_samples / usual_s;
  const double shortest_s = options.shortest_s.value_or(usual_s);
  const auto samples = [&](double seconds) {
    return static_cast<std::size_t>(std::clamp(std::round(seconds * rate_hz), least_samples, 1e15));
  };
  return {samples(std::min(shortest_s, usual_s)), samples(shortest_s)};
}

RestSearch find_rests(View<View<double>> axes, const RestOptions& options) {
  PM_EXPECTS(std::isfinite(options.rate_hz) && options.rate_hz >= 0.0);
  PM_EXPECTS(!options.shortest_s || *options.shortest_s > 0.0);
  const RestLengths lengths = rest_lengths(options);
  RestBlocks blocks = blocks_of(axes, lengths.window);
  RestSearch search;
  search.window = blocks.window * blocks.block;

  std::optional<RestNoise> noise = find_noise_and_drop_stuck(blocks);
  if (!noise) {
    search.why_none = fmt::format(
        "{} usable samples are too few to distinguish the noise of the sensor from motion",
        blocks.samples_there());
    return search;
  }
  if (noise->unrest >= 1.0) {
    search.why_none =
        "the sensor was never at rest: even where the recording is quietest, its mean varies as "
        "much "
        "as its samples";
    return search;
  }
  drop_stuck(blocks, *noise);
  clean_outliers(axes, blocks, *noise);
  std::vector<RestRun> runs = still_runs(blocks, *noise, quiet_runs(blocks, *noise));
  for (RestRun& run : runs) trim_ends(blocks, *noise, run);
  std::erase_if(runs, [](const RestRun& run) { return run.first >= run.end; });
  std::vector<RestRun> joined = runs;
  join_runs(blocks, *noise, joined);
  const auto is_short = [&](const RestRun& run) {
    return samples_in(blocks, run) < static_cast<double>(lengths.shortest);
  };
  std::erase_if(joined, is_short);
  if (joined.empty()) {
    search.why_none = fmt::format("the sensor is nowhere at rest for {} samples", lengths.shortest);
    return search;
  }
  std::erase_if(runs, is_short);
  search.noise_std = std_over(blocks, runs.empty() ? joined : runs);
  for (const RestRun& run : joined) search.rests.push_back(rest_of(blocks, run));
  return search;
}

std::vector<Rest> stuck_intervals(View<View<double>> axes, const RestOptions& options) {
  RestBlocks blocks = blocks_of(axes, rest_lengths(options).window);
  const std::vector<RestRun> constant = constant_runs(blocks);
  if (constant.empty() || !find_noise_and_drop_stuck(blocks)) return {};
  if (blocks.count[constant.front().first] > 0.0) return {};
  const auto is_repeated = [&](std::size_t k) {
    return std::ranges::all_of(axes, [k](View<double> axis) { return axis[k] == axis[k - 1]; });
  };
  std::vector<Rest> stuck;
  for (const RestRun& run : constant) {
    Rest all{blocks.first_sample(run.first), blocks.end_sample(run.end - 1) - 1};
    while (all.first > 0 && is_repeated(all.first)) --all.first;
    while (all.last + 1 < blocks.samples && is_repeated(all.last + 1)) ++all.last;
    stuck.push_back(all);
  }
  return stuck;
}

}  // namespace proofmass::signal
