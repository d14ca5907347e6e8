#include "proofmass/signal/rests/ends.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "proofmass/core/chi_square.hpp"

namespace proofmass::signal {
namespace {

constexpr double level = 0.9995;

void trim_edges(const RestBlocks& blocks, RestRun& run) {
  if (run.first > 0) ++run.first;
  if (run.end < blocks.size()) --run.end;
  // An outlier at the very end is motion, or a sample from before the rest.
  const auto is_bad = [&](std::size_t k) { return blocks.cleaned[k] || blocks.missing(k); };
  while (run.first < run.end && is_bad(run.first)) ++run.first;
  while (run.first < run.end && is_bad(run.end - 1)) --run.end;
}

void trim_loud_ends(const RestBlocks& blocks, const RestNoise& noise, RestRun& run) {
  const std::size_t width = std::max<std::size_t>(2, blocks.window / 2);
  if (run.size() < 2 * width) return;
  std::vector<double> all;
  all.reserve(run.size());
  for (std::size_t k = run.first; k + width <= run.end; ++k)
    all.push_back(loudness(blocks, noise, k, width));
  const auto quarter = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 4);
  std::ranges::nth_element(all, quarter);
  const auto dof = static_cast<double>(blocks.axes * width * (blocks.block - 1));
  const double bound = 2.0 * std::max(1.0, *quarter) * chi_square_quantile(level, dof) / dof;
  while (run.size() > width && loudness(blocks, noise, run.first, width) > bound) ++run.first;
  while (run.size() > width && loudness(blocks, noise, run.end - width, width) > bound) --run.end;
}

/// Σ_a (m_a − M_a)² / variance_a between the means of two segments of blocks.
double departure(const RestBlocks& blocks,
                 const PerAxis& variance,
                 const RestRun& stretch,
                 const RestRun& beside) {
  const RestBlock one = joined(blocks, stretch.first, stretch.size());
  const RestBlock other = joined(blocks, beside.first, beside.size());
  if (one.count == 0.0 || other.count == 0.0) return 0.0;
  double sum = 0.0;
  for (std::size_t a = 0; a < blocks.axes; ++a) {
    const double step = one.mean[a] - other.mean[a];
    sum += step * step / variance[a];
  }
  return sum;
}

void trim_creeping_ends(const RestBlocks& blocks, const RestNoise& noise, RestRun& run) {
  const double bound = chi_square_quantile(level, static_cast<double>(blocks.axes));
  for (std::size_t scale = noise.allan_variance.size(); scale-- > 0;) {
    const std::size_t width = std::size_t{1} << scale;
    if (run.size() < 3 * width) continue;
    PerAxis variance = noise_ratio(blocks, noise, run.first, run.size());
    for (std::size_t a = 0; a < blocks.axes; ++a)
      variance[a] *= 2.0 * noise.allan_variance[scale][a];
    const std::size_t step = std::max<std::size_t>(1, width / 4);
    while (run.size() >= 3 * width && departure(blocks, variance, {run.first, run.first + width},
                                                {run.first + width, run.first + 3 * width}) > bound)
      run.first += step;
    while (run.size() >= 3 * width && departure(blocks, variance, {run.end - width, run.end},
                                                {run.end - 3 * width, run.end - width}) > bound)
      run.end -= step;
  }
}

bool agree(const RestBlocks& blocks,
           const RestNoise& noise,
           const RestRun& one,
           const RestRun& next) {
  const std::size_t shorter = std::min(one.size(), next.size());
  if (shorter < blocks.window || next.first - one.end > blocks.window) return false;
  const std::size_t scale = std::min<std::size_t>(
      static_cast<std::size_t>(std::bit_width(shorter)) - 1, noise.allan_variance.size() - 1);
  const std::size_t width = std::size_t{1} << scale;
  const PerAxis r0 = noise_ratio(blocks, noise, one.first, one.size());
  const PerAxis r1 = noise_ratio(blocks, noise, next.first, next.size());
  PerAxis variance{};
  for (std::size_t a = 0; a < blocks.axes; ++a)
    variance[a] = (r0[a] + r1[a]) * noise.allan_variance[scale][a];
  return departure(blocks, variance, {one.end - width, one.end},
                   {next.first, next.first + width}) <=
         chi_square_quantile(level, static_cast<double>(blocks.axes));
}

/// True if the sensor changed position between two rests: the measurements minus the level on both
/// sides, integrated twice, exceed the effect of noise. Independent of the unit; a shock causes no
/// large displacement.
bool moves(const RestBlocks& blocks,
           const RestNoise& noise,
           const RestRun& one,
           const RestRun& next) {
  constexpr double beyond_noise = 12.0;
  const RestBlock before = joined(blocks, one.first, one.size());
  const RestBlock after = joined(blocks, next.first, next.size());
  const auto end = static_cast<double>(blocks.end_sample(next.first - 1));
  const double samples = end - static_cast<double>(blocks.first_sample(one.end));
  for (std::size_t a = 0; a < blocks.axes; ++a) {
    double moved = 0.0;  // in units of sample periods squared
    for (std::size_t k = one.end; k < next.first; ++k) {
      const auto first = static_cast<double>(blocks.first_sample(k));
      const auto last = static_cast<double>(blocks.end_sample(k));
      const double level = 0.5 * (before.mean[a] + after.mean[a]);
      if (blocks.count[k] > 0.0)
        moved += (blocks.mean[a][k] - level) * (last - first) * (end - 0.5 * (first + last));
    }
    // White noise over n samples, plus the error of the level itself, times n²/2.
    const double of_level =
        0.25 * noise.block_variance[a] * (1.0 / before.count + 1.0 / after.count);
    const double variance = noise.block_variance[a] * samples * samples * samples / 3.0 +
                            of_level * std::pow(samples, 4) / 4.0;
    if (moved * moved > beyond_noise * beyond_noise * variance) return true;
  }
  return false;
}

}  // namespace

void trim_ends(const RestBlocks& blocks, const RestNoise& noise, RestRun& run) {
  trim_edges(blocks, run);
  if (run.first >= run.end) return;
  trim_loud_ends(blocks, noise, run);
  trim_creeping_ends(blocks, noise, run);
}

void join_runs(const RestBlocks& blocks, const RestNoise& noise, std::vector<RestRun>& runs) {
  std::vector<RestRun> joined_runs;
  joined_runs.reserve(runs.size());
  for (const RestRun& run : runs) {
    if (!joined_runs.empty() && agree(blocks, noise, joined_runs.back(), run) &&
        !moves(blocks, noise, joined_runs.back(), run))
      joined_runs.back().end = run.end;
    else
      joined_runs.push_back(run);
  }
  runs = std::move(joined_runs);
}

}  // namespace proofmass::signal
