#include "proofmass/signal/spectrum/regress_out.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "proofmass/core/contract.hpp"

namespace proofmass::signal {
namespace {

constexpr std::size_t most_blocks = 256, fewest_paired_blocks = 8, shortest_block = 16;

struct Block {
  double middle, y, u;
};

std::vector<Block> paired_means(View<double> series, View<double> cause, std::size_t count) {
  std::vector<Block> blocks;
  for (std::size_t b = 0; b < count; ++b) {
    const std::size_t begin = b * series.size() / count, end = (b + 1) * series.size() / count;
    Block sum{};
    std::size_t both = 0;
    for (std::size_t k = begin; k < end; ++k) {
      if (!std::isfinite(series[k]) || !std::isfinite(cause[k])) continue;
      sum.y += series[k];
      sum.u += cause[k];
      ++both;
    }
    if (2 * both < end - begin) continue;
    const auto n = static_cast<double>(both);
    blocks.push_back({0.5 * static_cast<double>(begin + end - 1), sum.y / n, sum.u / n});
  }
  return blocks;
}

struct Line {
  double mean_u = 0.0, mean_y = 0.0, squares = 0.0, slope = 0.0;
};

Line fit_line(const std::vector<Block>& blocks) {
  Line line;
  const auto n = static_cast<double>(blocks.size());
  for (const Block& block : blocks) {
    line.mean_u += block.u / n;
    line.mean_y += block.y / n;
  }
  double products = 0.0;
  for (const Block& block : blocks) {
    line.squares += (block.u - line.mean_u) * (block.u - line.mean_u);
    products += (block.u - line.mean_u) * (block.y - line.mean_y);
  }
  line.slope = products / line.squares;
  return line;
}

double std_of_slope(const std::vector<Block>& blocks, const Line& line) {
  double squares = 0.0, lagged = 0.0, before = 0.0;
  for (const Block& block : blocks) {
    const double residual = block.y - line.mean_y - line.slope * (block.u - line.mean_u);
    squares += residual * residual;
    lagged += residual * before;
    before = residual;
  }
  if (!(squares > 0.0)) return 0.0;
  // A larger correlation, from so few blocks, is not reliable enough to divide by.
  const double r = std::clamp(lagged / squares, 0.0, 0.98);
  const double degrees = static_cast<double>(blocks.size()) - 2.0;
  return std::sqrt(squares / degrees / line.squares * (1.0 + r) / (1.0 - r));
}

void subtract(std::span<double> series, const std::vector<Block>& blocks, const Line& line) {
  std::size_t b = 0;  // first of the two blocks whose centres enclose the sample
  for (std::size_t k = 0; k < series.size(); ++k) {
    const auto place = static_cast<double>(k);
    while (b + 2 < blocks.size() && blocks[b + 1].middle < place) ++b;
    const Block &from = blocks[b], &to = blocks[b + 1];
    const double u = from.u + (to.u - from.u) * (place - from.middle) / (to.middle - from.middle);
    series[k] -= line.slope * (u - line.mean_u);
  }
}

}  // namespace

Result<Uncertain> regress_out(std::span<double> series, View<double> cause) {
  PM_EXPECTS(series.size() == cause.size());
  const std::size_t count = std::min(most_blocks, series.size() / shortest_block);
  const std::vector<Block> blocks = paired_means(series, cause, count);
  if (blocks.size() < fewest_paired_blocks) {
    return Error{Errc::too_few_samples,
                 "fewer than 8 stretches of 16 samples have both the series and its cause"};
  }
  const Line line = fit_line(blocks);
  const double size = std::abs(line.mean_u) * 1e-12;
  if (!(line.squares > size * size * static_cast<double>(blocks.size()))) {
    return Error{Errc::not_observable, "the cause does not vary: there is nothing to take out"};
  }
  subtract(series, blocks, line);
  return Uncertain{line.slope, std_of_slope(blocks, line)};
}

}  // namespace proofmass::signal
