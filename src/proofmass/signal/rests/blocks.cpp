#include "proofmass/signal/rests/blocks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "proofmass/core/contract.hpp"
#include "proofmass/signal/audit/chunk_statistics.hpp"
#include "proofmass/signal/audit/lsb_detector.hpp"

namespace proofmass::signal {
namespace {

using Axes = View<View<double>>;

bool is_complete(const RestBlocks& blocks, std::size_t first, std::size_t end) {
  return blocks.there.empty() || std::all_of(blocks.there.data() + first, blocks.there.data() + end,
                                             [](unsigned char there) { return there != 0; });
}

/// The samples of block k except `left_out`.
RestBlock block_of(Axes axes, const RestBlocks& blocks, std::size_t k, std::size_t left_out) {
  RestBlock block;
  const auto is_used = [&](std::size_t s) { return s != left_out && blocks.is_there(s); };
  const std::size_t end = blocks.end_sample(k);
  std::size_t first = blocks.first_sample(k);
  while (first < end && !is_used(first)) ++first;
  if (first == end) return block;
  if (end <= left_out && is_complete(blocks, first, end)) {
    block.count = static_cast<double>(end - first);
    for (std::size_t a = 0; a < axes.size(); ++a) {
      const DepartureSums sums = sum_departures(axes[a].subspan(first, end - first));
      block.mean[a] = axes[a][first] + sums.sum / block.count;
      block.squares[a] = std::max(0.0, sums.squares - sums.sum * sums.sum / block.count);
      block.steps[a] = sums.steps;
    }
    return block;
  }
  for (std::size_t a = 0; a < axes.size(); ++a) {
    const View<double> axis = axes[a];
    const double anchor = axis[first];  // preserves digits where the level is far from zero
    double count = 0.0, sum = 0.0, squares = 0.0, steps = 0.0, last = 0.0;
    for (std::size_t s = first; s < end; ++s) {
      if (!is_used(s)) continue;
      const double x = axis[s] - anchor;
      count += 1.0;
      sum += x;
      squares += x * x;
      steps += (x - last) * (x - last);
      last = x;
    }
    block.count = count;
    block.mean[a] = anchor + sum / count;
    block.squares[a] = std::max(0.0, squares - sum * sum / count);
    block.steps[a] = steps;
  }
  return block;
}

// Marks the implausible samples from `first` to `end` − 1. Returns whether there are none.
bool mark_missing(Axes axes, std::size_t first, std::size_t end, RestBlocks& blocks) {
  bool complete = true;
  for (const View<double> axis : axes)
    for_each_implausible(axis.subspan(first, end - first), [&](std::size_t k) {
      if (blocks.there.empty()) blocks.there.assign(blocks.samples, 1);
      blocks.there[first + k] = 0;
      complete = false;
    });
  return complete;
}

// Determines the quantisation steps and the largest magnitudes.
class Resolution {
 public:
  Resolution(std::size_t axes, std::size_t window) : seekers_(axes, LsbDetector(window)) {}

  // Adds the samples from `first` to `end` − 1 that are not missing.
  void add(
      Axes axes, const RestBlocks& blocks, std::size_t first, std::size_t end, bool is_complete) {
    for (std::size_t a = 0; a < axes.size(); ++a) {
      const View<double> values = axes[a].subspan(first, end - first);
      if (is_complete && !values.empty()) {
        seekers_[a].add(first, values);
        const ChunkStatistics figures = chunk_statistics(values);
        largest_[a] = std::max({largest_[a], -figures.min, figures.max});
        continue;
      }
      for (std::size_t k = first; k < end; ++k) {
        if (!blocks.is_there(k)) continue;
        seekers_[a].add(k, axes[a][k]);
        largest_[a] = std::max(largest_[a], std::abs(axes[a][k]));
      }
    }
  }

  void finish(RestBlocks& blocks) const {
    for (std::size_t a = 0; a < seekers_.size(); ++a) {
      blocks.quantum[a] = seekers_[a].quantum();
      blocks.variance_floor[a] = variance_floor(blocks.quantum[a], largest_[a]);
    }
  }

 private:
  std::vector<LsbDetector> seekers_;
  PerAxis largest_{};
};

}  // namespace

RestBlock RestBlocks::at(std::size_t k) const {
  RestBlock out{.count = count[k], .cleaned = cleaned[k] != 0};
  for (std::size_t a = 0; a < axes; ++a) {
    out.mean[a] = mean[a][k];
    out.squares[a] = squares[a][k];
    out.steps[a] = steps[a][k];
  }
  return out;
}

void RestBlocks::set(std::size_t k, const RestBlock& to) {
  count[k] = to.count;
  cleaned[k] = to.cleaned ? 1 : 0;
  for (std::size_t a = 0; a < axes; ++a) {
    mean[a][k] = to.mean[a];
    squares[a][k] = to.squares[a];
    steps[a][k] = to.steps[a];
  }
}

void RestBlocks::resize(std::size_t size) {
  count.resize(size);
  cleaned.resize(size);
  for (AxisColumns* columns : {&mean, &squares, &steps})
    for (std::size_t a = 0; a < axes; ++a) (*columns)[a].resize(size);
}

void RestBlocks::drop_first() {
  count.erase(count.begin());
  cleaned.erase(cleaned.begin());
  for (AxisColumns* columns : {&mean, &squares, &steps})
    for (std::size_t a = 0; a < axes; ++a) (*columns)[a].erase((*columns)[a].begin());
}

std::size_t RestBlocks::samples_there() const {
  return there.empty() ? samples : static_cast<std::size_t>(std::ranges::count(there, 1));
}

double variance_floor(double quantum, double largest) {
  const double rounding = 1e-14 * largest;
  return std::max(
      {quantum * quantum / 12.0, rounding * rounding, std::numeric_limits<double>::min()});
}

RestBlocks no_blocks(std::size_t axes, std::size_t window) {
  PM_EXPECTS(axes > 0 && axes <= most_axes);
  constexpr std::size_t least_block = 4;
  RestBlocks blocks;
  blocks.axes = axes;
  blocks.block = std::max(least_block, window / 8);
  blocks.window = std::max<std::size_t>(2, window / blocks.block);
  return blocks;
}

RestBlocks blocks_of(Axes axes, std::size_t window) {
  RestBlocks blocks = no_blocks(axes.size(), window);
  blocks.samples = axes[0].size();
  for (const View<double> axis : axes) PM_EXPECTS(axis.size() == blocks.samples);
  blocks.resize(blocks.samples / blocks.block);
  Resolution resolution(axes.size(), window);
  // Short enough that the samples stay in the cache from one pass to the next.
  const std::size_t piece = std::max<std::size_t>(1, 2048 / blocks.block);
  std::size_t k = 0;
  do {
    const std::size_t next = std::min(k + piece, blocks.size());
    const std::size_t first = blocks.first_sample(k);
    const std::size_t end = next == blocks.size() ? blocks.samples : blocks.first_sample(next);
    const bool is_complete = mark_missing(axes, first, end, blocks);
    for (; k < next; ++k) blocks.set(k, block_of(axes, blocks, k, blocks.samples));
    resolution.add(axes, blocks, first, end, is_complete);
  } while (k < blocks.size());
  resolution.finish(blocks);
  return blocks;
}

RestBlock without_outlier(Axes axes,
                          const RestBlocks& blocks,
                          std::size_t k,
                          const PerAxis& variance) {
  const std::size_t first = blocks.first_sample(k);
  const std::size_t end = blocks.end_sample(k);
  PerAxis middle{};  // median: a mean would follow the outlier
  std::vector<double> values;
  values.reserve(end - first);
  for (std::size_t a = 0; a < axes.size(); ++a) {
    values.clear();
    for (std::size_t s = first; s < end; ++s)
      if (blocks.is_there(s)) values.push_back(axes[a][s]);
    if (values.empty()) return {};
    const auto half = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, half);
    middle[a] = *half;
  }
  std::size_t farthest = first;
  double largest = -1.0;
  for (std::size_t s = first; s < end; ++s) {
    if (!blocks.is_there(s)) continue;
    double distance = 0.0;
    for (std::size_t a = 0; a < axes.size(); ++a)
      distance += (axes[a][s] - middle[a]) * (axes[a][s] - middle[a]) / variance[a];
    if (distance <= largest) continue;
    largest = distance;
    farthest = s;
  }
  RestBlock block = block_of(axes, blocks, k, farthest);
  block.cleaned = true;
  return block;
}

RestBlock joined(const RestBlocks& blocks, std::size_t k, std::size_t count) {
  RestBlock all;
  for (std::size_t b = k; b < k + count; ++b) {
    const double more = blocks.count[b];
    if (more == 0.0) continue;
    const double total = all.count + more;
    for (std::size_t a = 0; a < blocks.axes; ++a) {
      const double step = blocks.mean[a][b] - all.mean[a];
      all.squares[a] += blocks.squares[a][b] + step * step * all.count * more / total;
      all.mean[a] += step * more / total;
    }
    all.count = total;
  }
  return all;
}

BlockSums::BlockSums(const RestBlocks& blocks) : count(blocks.size()) {
  for (std::size_t k = 0; k < count.size(); ++k)
    count[k] = blocks.missing(k) ? 0.0 : blocks.count[k];
  for (std::size_t a = 0; a < blocks.axes; ++a) {
    sum[a].resize(count.size());
    for (std::size_t k = 0; k < count.size(); ++k) sum[a][k] = count[k] * blocks.mean[a][k];
  }
}

void BlockSums::widen() {
  const auto fold = [this](std::vector<double>& values) {
    if (values.empty()) return;
    const std::size_t size = values.size() > width ? values.size() - width : 0;
    for (std::size_t k = 0; k < size; ++k) values[k] += values[k + width];
    values.resize(size);
  };
  fold(count);
  for (std::vector<double>& values : sum) fold(values);
  width *= 2;
}

double BlockSums::half_square(std::size_t axis, std::size_t k) const {
  const double n0 = count[k];
  const double n1 = count[k + width];
  if (n0 == 0.0 || n1 == 0.0) return 0.0;
  const double step = sum[axis][k + width] / n1 - sum[axis][k] / n0;
  return 0.5 * step * step;
}

}  // namespace proofmass::signal
