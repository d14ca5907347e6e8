#include "proofmass/signal/events/level.hpp"

#include <algorithm>
#include <cmath>

#include "proofmass/signal/events/kernels.hpp"

namespace proofmass::signal {
namespace {

struct Part {
  double mean;
  float weight;
};

/// Mean of the samples present, and their fraction.
Part part_of(View<double> block) {
  double sum = 0.0;
  double count = 0.0;
  for (const double x : block) {
    const bool there = !std::isnan(x);
    sum += there ? x : 0.0;
    count += there ? 1.0 : 0.0;
  }
  return {count > 0.0 ? sum / count : 0.0,
          static_cast<float>(count / static_cast<double>(block.size()))};
}

}  // namespace

Level base_level(const Source& source) {
  constexpr std::size_t stretch = 256;  // blocks
  Level level;
  const std::size_t blocks = source.series.size() / base_block;
  level.mean.resize(blocks);
  level.weight.assign(blocks, 1.0F);
  std::vector<double> x(stretch * base_block);
  for (std::size_t first = 0; first < blocks; first += stretch) {
    const std::size_t count = std::min(stretch, blocks - first);
    source.read(static_cast<std::ptrdiff_t>(first * base_block), x);
    sum_blocks(x.data(), count, &level.mean[first]);
    for (std::size_t b = 0; b < count; ++b) {
      double& mean = level.mean[first + b];
      if (std::isnan(mean)) {
        const Part part = part_of(View<double>(x).subspan(b * base_block, base_block));
        mean = part.mean;
        level.weight[first + b] = part.weight;
      } else {
        mean /= static_cast<double>(base_block);
      }
    }
  }
  return level;
}

Level halved(const Level& level) {
  Level result;
  result.block = 2 * level.block;
  const std::size_t size = level.mean.size() / 2;
  result.mean.resize(size);
  result.weight.resize(size);
  for (std::size_t k = 0; k < size; ++k) {
    const auto a = static_cast<double>(level.weight[2 * k]);
    const auto b = static_cast<double>(level.weight[2 * k + 1]);
    const double sum = a * level.mean[2 * k] + b * level.mean[2 * k + 1];
    result.mean[k] = a + b > 0.0 ? sum / (a + b) : 0.0;
    result.weight[k] = static_cast<float>(0.5 * (a + b));
  }
  return result;
}

std::vector<double> windows(const Level& level, std::size_t width) {
  if (level.mean.size() < width) return {};
  std::vector<double> m(level.mean.size() - width + 1);
  const double enough = (width * level.block < 256 ? 0.75 : 0.85) * static_cast<double>(width);
  window_means({level.mean.data(), level.weight.data(), width, enough}, m.data(), m.size());
  return m;
}

void level_out(Level& level, View<Step> steps) {
  std::vector<Step> sorted(steps.begin(), steps.end());
  std::ranges::sort(sorted, {}, &Step::at);
  double offset = 0.0;
  auto next = sorted.begin();
  for (std::size_t k = 0; k < level.mean.size(); ++k) {
    for (; next != sorted.end() && next->at < (k + 1) * level.block; ++next) {
      if (next->at > k * level.block) level.weight[k] = 0.0F;
      offset += next->size;
    }
    level.mean[k] -= offset;
  }
}

}  // namespace proofmass::signal
