#include "proofmass/signal/rests/runs.hpp"

#include <algorithm>
#include <cmath>

#include "proofmass/core/chi_square.hpp"
#include "proofmass/signal/events/source.hpp"

namespace proofmass::signal {
namespace {

/// The bound that χ² over its degrees of freedom exceeds somewhere in one recording in a hundred.
double bound_of(const RestBlocks& blocks, double dof) {
  const double tests = 10.0 * static_cast<double>(blocks.size()) + 1.0;
  return chi_square_quantile(1.0 - 1e-2 / tests, dof) / dof;
}

double dof_of_block(const RestBlocks& blocks) {
  return static_cast<double>(blocks.axes * (blocks.block - 1));
}

/// Runs of the blocks that pass; up to a window of missing blocks passes as well.
template <class Passes>
void add_runs(const RestBlocks& blocks,
              RestRun within,
              Passes&& passes,
              std::vector<RestRun>& runs) {
  RestRun run{within.first, within.first};  // up to its last block that is present
  const auto close = [&](std::size_t next) {
    if (run.end > run.first) runs.push_back(run);
    run = {next, next};
  };
  for (std::size_t k = within.first; k < within.end; ++k) {
    if (blocks.missing(k)) {
      if (run.end == run.first || k + 1 - run.end > blocks.window) close(k + 1);
    } else if (passes(k)) {
      run.end = k + 1;
    } else {
      close(k + 1);
    }
  }
  close(within.end);
}

/// Adds the parts of a run that are in no noisy window.
void add_quiet_parts(const RestBlocks& blocks,
                     const RestNoise& noise,
                     double bound,
                     RestRun run,
                     std::vector<RestRun>& out) {
  if (run.size() < blocks.window) {
    out.push_back(run);
    return;
  }
  std::vector<bool> loud(run.size(), false);
  std::size_t marked = 0;
  for (std::size_t k = 0; k + blocks.window <= run.size(); ++k) {
    if (loudness(blocks, noise, run.first + k, blocks.window) <= bound) continue;
    for (marked = std::max(marked, k); marked < k + blocks.window; ++marked) loud[marked] = true;
  }
  add_runs(blocks, run, [&](std::size_t k) { return !loud[k - run.first]; }, out);
}

/// True if the windows before and after `boundary` contain enough samples to compare their means.
bool can_compare(const RestBlocks& blocks, const BlockSums& sums, std::size_t boundary) {
  const double enough = 0.5 * static_cast<double>(sums.width * blocks.block);
  return sums.count[boundary - sums.width] >= enough && sums.count[boundary] >= enough;
}

/// Runs with their noise_ratio.
struct RatedRuns {
  std::vector<RestRun> runs;
  std::vector<PerAxis> ratios;

  RatedRuns(const RestBlocks& blocks, const RestNoise& noise, std::vector<RestRun> first) {
    replace(blocks, noise, first);
  }

  /// Takes the runs of `next`, which are in order as the present ones are. Runs that are in both
  /// keep their ratios.
  void replace(const RestBlocks& blocks, const RestNoise& noise, std::vector<RestRun>& next) {
    std::vector<PerAxis> next_ratios;
    next_ratios.reserve(next.size());
    std::size_t k = 0;
    for (const RestRun& run : next) {
      while (k < ratios.size() && runs[k].first < run.first) ++k;
      const bool same = k < ratios.size() && runs[k].first == run.first && runs[k].end == run.end;
      next_ratios.push_back(same ? ratios[k] : noise_ratio(blocks, noise, run.first, run.size()));
    }
    std::swap(runs, next);
    ratios = std::move(next_ratios);
  }
};

/// The Allan variance at the width of `sums`, from the runs.
PerAxis allan_variance_of(const RestBlocks& blocks,
                          const RestNoise& noise,
                          const BlockSums& sums,
                          const RatedRuns& rated) {
  std::array<std::vector<double>, most_axes> values;
  double independent = 0.0;
  const std::size_t stride = std::max<std::size_t>(1, sums.width / 4);
  for (std::size_t r = 0; r < rated.runs.size(); ++r) {
    const RestRun& run = rated.runs[r];
    if (run.size() < 2 * sums.width) continue;
    const PerAxis& ratio = rated.ratios[r];
    for (std::size_t k = run.first + sums.width; k + sums.width <= run.end; k += stride) {
      if (!can_compare(blocks, sums, k)) continue;
      independent += static_cast<double>(stride) / static_cast<double>(sums.width);
      for (std::size_t a = 0; a < blocks.axes; ++a)
        values[a].push_back(sums.half_square(a, k - sums.width) / ratio[a]);
    }
  }
  PerAxis allan = noise.allan_variance.back();
  constexpr double enough = 10.0;
  if (independent < enough) return allan;
  for (std::size_t a = 0; a < blocks.axes; ++a)
    allan[a] = std::max(
        std::clamp(median_of(values[a]) / median_of_square, 0.5 * allan[a], 2.0 * allan[a]),
        noise.quantum_variance[a]);
  return allan;
}

/// Splits the run at boundaries where the means on either side differ, and adds the parts.
void add_still_parts(const RestBlocks& blocks,
                     const BlockSums& sums,
                     const PerAxis& bound,
                     RestRun run,
                     std::vector<RestRun>& out) {
  const std::size_t width = sums.width;
  std::size_t first = run.first;
  std::size_t last_cut = 0;
  for (std::size_t k = run.first + width; k + width <= run.end; ++k) {
    if (!can_compare(blocks, sums, k)) continue;
    double sum = 0.0;
    for (std::size_t a = 0; a < blocks.axes; ++a) sum += sums.half_square(a, k - width) / bound[a];
    if (sum <= 1.0) continue;
    // At the first boundary with a complete window before it, the start of the motion is unknown.
    if (k > run.first + width) out.push_back({first, k});
    first = k;
    last_cut = k;
  }
  if (last_cut == 0 || last_cut + width < run.end) out.push_back({first, run.end});
}

}  // namespace

QuietTest::QuietTest(const RestBlocks& blocks)
    : block_bound(most_noise_ratio * bound_of(blocks, dof_of_block(blocks))),
      window_bound(most_noise_ratio *
                   bound_of(blocks, dof_of_block(blocks) * static_cast<double>(blocks.window))) {}

void clean_outliers(View<View<double>> axes, RestBlocks& blocks, const RestNoise& noise) {
  const QuietTest test(blocks);
  for (std::size_t k = 0; k < blocks.size(); ++k) {
    if (blocks.missing(k) || test.passes(blocks, noise, k)) continue;
    const RestBlock as_it_was = blocks.at(k);
    blocks.set(k, without_outlier(axes, blocks, k, noise.block_variance));
    if (!test.passes(blocks, noise, k)) blocks.set(k, as_it_was);
  }
}

namespace {

// True if the noise exceeds the quantisation step on any axis: such a sensor repeats no value for
// half a window.
bool exceeds_quantum(const RestBlocks& blocks, const RestNoise& noise) {
  bool noisy = false;
  for (std::size_t a = 0; a < blocks.axes; ++a)
    noisy = noisy || noise.window_variance[a] > std::max(blocks.quantum[a] * blocks.quantum[a],
                                                         4.0 * blocks.variance_floor[a]);
  return noisy;
}

void drop_runs(const std::vector<RestRun>& runs, RestBlocks& blocks) {
  for (const RestRun& run : runs)
    for (std::size_t b = run.first; b < run.end; ++b) blocks.count[b] = 0.0;
}

}  // namespace

std::vector<RestRun> constant_runs(const RestBlocks& blocks) {
  std::vector<RestRun> runs;
  const auto is_constant = [&](std::size_t k) {
    for (std::size_t a = 0; a < blocks.axes; ++a)
      if (blocks.squares[a][k] > 0.0) return false;
    return blocks.count[k] > 0.0;
  };
  std::size_t run = 0;
  for (std::size_t k = 0; k <= blocks.size(); ++k) {
    if (k < blocks.size() && is_constant(k)) {
      ++run;
      continue;
    }
    if (2 * run >= blocks.window) runs.push_back({k - run, k});
    run = 0;
  }
  return runs;
}

std::optional<RestNoise> find_noise_and_drop_stuck(RestBlocks& blocks) {
  const std::vector<RestRun> constant = constant_runs(blocks);
  std::size_t repeated = 0;
  for (const RestRun& run : constant) repeated += run.size();
  if (repeated > 0 && 3 * repeated < blocks.size()) {
    RestBlocks others = blocks;
    drop_runs(constant, others);
    std::optional<RestNoise> noise = find_rest_noise(others);
    if (noise && noise->unrest < 1.0 && exceeds_quantum(others, *noise)) {
      blocks = std::move(others);
      return noise;
    }
  }
  return find_rest_noise(blocks);
}

void drop_stuck(RestBlocks& blocks, const RestNoise& noise) {
  if (exceeds_quantum(blocks, noise)) drop_runs(constant_runs(blocks), blocks);
}

std::vector<RestRun> quiet_runs(const RestBlocks& blocks, const RestNoise& noise) {
  const QuietTest test(blocks);
  std::vector<RestRun> runs;
  add_runs(
      blocks, {0, blocks.size()}, [&](std::size_t k) { return test.passes(blocks, noise, k); },
      runs);
  std::vector<RestRun> quiet;
  quiet.reserve(runs.size());
  for (const RestRun& run : runs) add_quiet_parts(blocks, noise, test.window_bound, run, quiet);
  return quiet;
}

std::vector<RestRun> still_runs(const RestBlocks& blocks,
                                RestNoise& noise,
                                std::vector<RestRun> runs) {
  const auto axes = static_cast<double>(blocks.axes);
  const double slack = 2.25 * axes * bound_of(blocks, axes);
  RatedRuns rated(blocks, noise, std::move(runs));
  std::vector<RestRun> parts;
  BlockSums sums(blocks);
  for (std::size_t scale = 0; sums.width <= 16 * blocks.window; ++scale, sums.widen()) {
    if (sums.count.size() <= sums.width) break;
    if (scale == noise.allan_variance.size())
      noise.allan_variance.push_back(allan_variance_of(blocks, noise, sums, rated));
    parts.clear();
    for (std::size_t r = 0; r < rated.runs.size(); ++r) {
      const RestRun& run = rated.runs[r];
      if (run.size() < 2 * sums.width) {
        parts.push_back(run);
        continue;
      }
      PerAxis bound = rated.ratios[r];
      for (std::size_t a = 0; a < blocks.axes; ++a)
        bound[a] *= slack * noise.allan_variance[scale][a];
      add_still_parts(blocks, sums, bound, run, parts);
    }
    rated.replace(blocks, noise, parts);
  }
  return std::move(rated.runs);
}

}  // namespace proofmass::signal
