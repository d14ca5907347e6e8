#include "proofmass/signal/rests/noise.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "proofmass/core/chi_square.hpp"
#include "proofmass/core/statistics.hpp"
#include "proofmass/signal/events/source.hpp"

namespace proofmass::signal {
namespace {

constexpr std::size_t least_windows = 8;

struct Window {
  double level = 0.0;
  std::size_t first = 0;  ///< block
  PerAxis variance{};
};
using Set = View<Window>;

/// Uses the axis that is noisiest relative to its own 5 % quantile: motion along one axis is
/// motion.
void set_levels(std::size_t axes, std::vector<Window>& windows) {
  std::vector<double> logs(windows.size());
  for (Window& window : windows) window.level = -std::numeric_limits<double>::infinity();
  for (std::size_t a = 0; a < axes; ++a) {
    std::ranges::transform(windows, logs.begin(),
                           [a](const Window& w) { return 0.5 * std::log(w.variance[a]); });
    const double quiet = quantile(logs, 0.05).value_or(0.0);
    for (std::size_t k = 0; k < windows.size(); ++k)
      windows[k].level = std::max(windows[k].level, logs[k] - quiet);
  }
}

std::vector<Window> windows_of(const RestBlocks& blocks) {
  std::vector<Window> windows;
  if (blocks.size() < blocks.window) return windows;
  windows.reserve(blocks.size());
  const double enough = 0.75 * static_cast<double>(blocks.window * blocks.block);
  for (std::size_t k = 0; k + blocks.window <= blocks.size(); ++k) {
    const RestBlock all = joined(blocks, k, blocks.window);
    if (all.count < enough) continue;
    Window window{.first = k};
    for (std::size_t a = 0; a < blocks.axes; ++a)
      window.variance[a] = std::max(all.squares[a] / (all.count - 1.0), blocks.variance_floor[a]);
    windows.push_back(window);
  }
  set_levels(blocks.axes, windows);
  return windows;
}

/// The mean of variances with k degrees of freedom each, from their median. Source: E. B. Wilson,
/// M. M. Hilferty, The distribution of chi-square, Proc. Nat. Acad. Sci. 17 (1931) 684.
double mean_by_median(std::span<double> values, double dof) {
  const double root = 1.0 - 2.0 / (9.0 * dof);
  return median_of(values) / (root * root * root);
}

/// A number of windows sufficient for a median, evenly taken from the set.
std::vector<Window> some_of(Set set) {
  constexpr std::size_t most = 2048;
  const std::size_t stride = set.size() / most + 1;
  std::vector<Window> some;
  some.reserve(set.size() / stride + 1);
  for (std::size_t k = 0; k < set.size(); k += stride) some.push_back(set[k]);
  return some;
}

/// Adds the Allan variance of means over the width of `sums`: up to half a window within the
/// windows of the set, above from one window of the set to the next. False if too few are
/// consecutive.
bool add_allan_variance(const RestBlocks& blocks,
                        const BlockSums& sums,
                        const std::vector<Window>& some,
                        const std::vector<bool>& in_set,
                        RestNoise& noise) {
  const bool within = 2 * sums.width <= blocks.window;
  const auto is_followed = [&](const Window& window) {
    const std::size_t last = window.first + 2 * sums.width - blocks.window;
    return last < in_set.size() && in_set[last];
  };
  const auto samples = static_cast<double>(sums.width * blocks.block);
  std::vector<double> values;
  values.reserve(some.size());
  PerAxis allan{};
  for (std::size_t a = 0; a < blocks.axes; ++a) {
    values.clear();
    for (const Window& window : some)
      if (within || is_followed(window)) values.push_back(sums.half_square(a, window.first));
    if (values.size() < least_windows && !within) return false;
    const double one = noise.window_variance[a];
    const double floor = noise.quantum_variance[a];
    allan[a] = std::max({median_of(values) / median_of_square, 0.5 * one / samples, floor});
    const double most = std::max((within ? 0.8 : 0.5) * one, 4.0 * noise.step_variance[a]);
    noise.unrest = std::max(noise.unrest, (allan[a] - floor) / most);
  }
  if (within) noise.allan_variance.push_back(allan);
  return true;
}

RestNoise noise_of(const RestBlocks& blocks, Set set) {
  const std::vector<Window> some = some_of(set);
  std::vector<double> values(some.size());
  RestNoise noise;
  for (std::size_t a = 0; a < blocks.axes; ++a) {
    std::ranges::transform(some, values.begin(), [a](const Window& w) { return w.variance[a]; });
    noise.window_variance[a] =
        mean_by_median(values, static_cast<double>(blocks.window * blocks.block - 1));
    const double quantum = blocks.quantum[a] * blocks.quantum[a];
    noise.quantum_variance[a] = noise.window_variance[a] < 0.25 * quantum ? 0.09 * quantum : 0.0;
    const auto of_blocks = [&](const std::vector<double>& sums, double share) {
      std::ranges::transform(some, values.begin(), [&](const Window& window) {
        const std::size_t k = window.first + blocks.window / 2;
        return blocks.count[k] > 1.0 ? share * sums[k] / (blocks.count[k] - 1.0) : 0.0;
      });
      return std::max(mean_by_median(values, static_cast<double>(blocks.block - 1)),
                      blocks.variance_floor[a]);
    };
    noise.block_variance[a] = of_blocks(blocks.squares[a], 1.0);
    noise.step_variance[a] = of_blocks(blocks.steps[a], 0.5);
  }
  std::vector<bool> in_set(blocks.size(), false);
  for (const Window& window : set) in_set[window.first] = true;
  for (BlockSums sums(blocks); sums.width <= blocks.window; sums.widen()) {
    const bool compared = add_allan_variance(blocks, sums, some, in_set, noise);
    noise.followed = compared && 2 * sums.width > blocks.window;
    if (!compared) break;
  }
  return noise;
}

/// Number of windows, sorted by level, that are constant on every axis.
std::size_t constant_windows(const RestBlocks& blocks, Set sorted) {
  const auto is_constant = [&](const Window& window) {
    for (std::size_t a = 0; a < blocks.axes; ++a)
      if (window.variance[a] > blocks.variance_floor[a]) return false;
    return true;
  };
  return static_cast<std::size_t>(std::ranges::find_if_not(sorted, is_constant) - sorted.begin());
}

/// The set that begins with each window, as the index past its last.
std::vector<std::size_t> ends_of_sets(Set sorted, double width) {
  std::vector<std::size_t> ends(sorted.size());
  std::size_t end = 0;
  for (std::size_t k = 0; k < sorted.size(); ++k) {
    while (end < sorted.size() && sorted[end].level <= sorted[k].level + width) ++end;
    ends[k] = end;
  }
  return ends;
}

/// The windows whose two halves have means that agree within noise, Σ_a (m_a − m′_a)² / (var m_a +
/// var m′_a) ≤ 2 χ²_{0.999}(A), with the variances within blocks.
std::vector<Window> calm_part(const RestBlocks& blocks, Set set) {
  const double bound = 2.0 * chi_square_quantile(0.999, static_cast<double>(blocks.axes));
  const std::size_t half = blocks.window / 2;
  std::vector<Window> calm;
  for (const Window& window : set) {
    const RestBlock one = joined(blocks, window.first, half);
    const RestBlock other = joined(blocks, window.first + blocks.window - half, half);
    if (one.count == 0.0 || other.count == 0.0) continue;
    double sum = 0.0;
    for (std::size_t a = 0; a < blocks.axes; ++a) {
      double squares = 0.0;
      double free = 0.0;
      for (std::size_t b = window.first; b < window.first + blocks.window; ++b) {
        squares += blocks.squares[a][b];
        free += std::max(0.0, blocks.count[b] - 1.0);
      }
      const double variance = std::max(squares / free, blocks.variance_floor[a]);
      const double step = one.mean[a] - other.mean[a];
      sum += step * step / (variance * (1.0 / one.count + 1.0 / other.count));
    }
    if (sum <= bound) calm.push_back(window);
  }
  return calm;
}

}  // namespace

std::optional<RestNoise> find_rest_noise(const RestBlocks& blocks) {
  std::vector<Window> windows = windows_of(blocks);
  if (windows.size() < least_windows) return std::nullopt;
  std::ranges::sort(windows, {}, &Window::level);

  const auto samples = static_cast<double>(blocks.window * blocks.block);
  const double scatter = 1.0 / std::sqrt(2.0 * static_cast<double>(blocks.axes) * (samples - 1.0));
  const std::vector<std::size_t> ends = ends_of_sets(windows, std::log(2.0) + 4.0 * scatter);
  const auto size_of = [&](std::size_t k) { return ends[k] - k; };
  const auto set_from = [&](std::size_t k) { return Set(windows).subspan(k, size_of(k)); };

  // A sensor that is stuck temporarily is not quiet.
  const std::size_t constant = constant_windows(blocks, windows);
  std::size_t lowest = constant < windows.size() && size_of(constant) > 2 * constant ? constant : 0;
  while (lowest + least_windows < windows.size() && size_of(lowest) < least_windows) ++lowest;
  std::size_t fullest = lowest;
  const double reach = windows[lowest].level + std::log(4.0);
  for (std::size_t k = lowest; k < windows.size() && windows[k].level < reach; ++k)
    if (size_of(k) > size_of(fullest)) fullest = k;

  if (size_of(fullest) < least_windows) return std::nullopt;

  RestNoise noise = noise_of(blocks, set_from(fullest));
  if (noise.unrest < 1.0) return noise;
  if (const RestNoise quietest = noise_of(blocks, set_from(lowest)); quietest.unrest < 1.0)
    return quietest;
  // Slow rotations may be as quiet as rests, or quieter.
  const std::vector<Window> calm = calm_part(blocks, set_from(fullest));
  if (calm.size() < least_windows) return noise;
  const RestNoise calmest = noise_of(blocks, calm);
  return calmest.followed && calmest.unrest < 1.0 ? calmest : noise;
}

double loudness(const RestBlocks& blocks,
                const RestNoise& noise,
                std::size_t k,
                std::size_t count) {
  double sum = 0.0;
  double free = 0.0;
  for (std::size_t b = k; b < k + count; ++b) {
    const double there = blocks.count[b];
    if (there < 2.0) continue;
    for (std::size_t a = 0; a < blocks.axes; ++a)
      sum += blocks.squares[a][b] / noise.block_variance[a];
    free += static_cast<double>(blocks.axes) * (there - 1.0);
  }
  return free > 0.0 ? sum / free : 0.0;
}

PerAxis noise_ratio(const RestBlocks& blocks,
                    const RestNoise& noise,
                    std::size_t k,
                    std::size_t count) {
  PerAxis squares{};
  double free = 0.0;
  for (std::size_t b = k; b < k + count; ++b) {
    if (blocks.count[b] < 2.0) continue;
    for (std::size_t a = 0; a < blocks.axes; ++a) squares[a] += blocks.squares[a][b];
    free += blocks.count[b] - 1.0;
  }
  PerAxis ratio{};
  for (std::size_t a = 0; a < blocks.axes; ++a)
    ratio[a] = std::clamp(squares[a] / std::max(1.0, free) / noise.block_variance[a], 1.0,
                          most_noise_ratio);
  return ratio;
}

}  // namespace proofmass::signal
