#include "proofmass/characterise/temperature/blocks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "proofmass/core/chi_square.hpp"
#include "proofmass/core/statistics.hpp"

namespace proofmass::characterise {
namespace {

using Eigen::Index;

constexpr std::size_t most_blocks = 256, shortest_block = 8;
constexpr int range_parts = 12, point_parts = 24;

std::vector<TemperatureBlock> means(View<double> series, View<double> temperature_k) {
  const std::size_t count = std::min(most_blocks, series.size() / shortest_block);
  std::vector<TemperatureBlock> blocks;
  for (std::size_t b = 0; b < count; ++b) {
    TemperatureBlock block;
    block.begin = b * series.size() / count;
    block.end = (b + 1) * series.size() / count;
    block.place = static_cast<double>(b);
    Moments y, temperature;
    for (std::size_t k = block.begin; k < block.end; ++k) {
      if (!std::isfinite(series[k]) || !std::isfinite(temperature_k[k])) continue;
      y.add(series[k]);
      temperature.add(temperature_k[k]);
    }
    if (2 * y.count < block.end - block.begin) continue;
    block.mean = y.mean;
    block.temperature_k = temperature.mean;
    blocks.push_back(block);
  }
  return blocks;
}

std::vector<double> sorted_temperatures(const std::vector<TemperatureBlock>& blocks) {
  std::vector<double> sorted(blocks.size());
  std::ranges::transform(blocks, sorted.begin(), &TemperatureBlock::temperature_k);
  std::ranges::sort(sorted);
  return sorted;
}

int part_of(const TemperatureBlocks& of, double temperature_k, int parts) {
  const double share = (temperature_k - of.lowest_k) / of.span_k();
  return std::clamp(static_cast<int>(share * parts), 0, parts - 1);
}

void set_range(TemperatureBlocks& of, const std::vector<double>& sorted) {
  of.lowest_k = sorted.front();
  of.highest_k = sorted.back();
  if (!(of.span_k() > 0.0)) return;
  std::array<bool, range_parts> seen{};
  for (std::size_t k = 0; k < sorted.size(); ++k) {
    seen[static_cast<std::size_t>(part_of(of, sorted[k], range_parts))] = true;
    if (k > 0 && sorted[k] - sorted[k - 1] > of.widest_gap_k) {
      of.widest_gap_k = sorted[k] - sorted[k - 1];
      of.gap_from_k = sorted[k - 1];
    }
  }
  of.occupied = static_cast<int>(std::ranges::count(seen, true));
}

void set_crowds(TemperatureBlocks& of, const std::vector<double>& sorted) {
  const double half = of.span_k() / 16.0;
  if (!(half > 0.0)) return;
  const double floor = static_cast<double>(sorted.size()) / 8.0 / 8.0;
  double sum = 0.0;
  for (TemperatureBlock& block : of.blocks) {
    const double from = std::max(block.temperature_k - half, of.lowest_k);
    const double to = std::min(block.temperature_k + half, of.highest_k);
    const auto within =
        std::ranges::upper_bound(sorted, to) - std::ranges::lower_bound(sorted, from);
    // At the ends of the range half the window is necessarily empty.
    block.crowd = std::max(static_cast<double>(within) * 2.0 * half / (to - from), floor);
    sum += 1.0 / block.crowd;
  }
  for (TemperatureBlock& block : of.blocks) block.crowd *= sum / static_cast<double>(sorted.size());
}

// Kelvin a block at each block, of the straight line through it and `reach` neighbours each side.
std::vector<double> slopes(const std::vector<TemperatureBlock>& blocks, std::size_t reach) {
  std::vector<double> found;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const std::size_t from = b - std::min(b, reach), to = std::min(b + reach + 1, blocks.size());
    Moments place, temperature;
    for (std::size_t k = from; k < to; ++k) {
      place.add(blocks[k].place);
      temperature.add(blocks[k].temperature_k);
    }
    double products = 0.0;
    for (std::size_t k = from; k < to; ++k)
      products += (blocks[k].place - place.mean) * (blocks[k].temperature_k - temperature.mean);
    found.push_back(products / place.squares);
  }
  return found;
}

// Noise of one block's temperature, from second differences, in which slow changes cancel.
double thermometer_std(const std::vector<TemperatureBlock>& blocks) {
  std::vector<double> bends;
  for (std::size_t b = 1; b + 1 < blocks.size(); ++b) {
    bends.push_back(blocks[b - 1].temperature_k - 2.0 * blocks[b].temperature_k +
                    blocks[b + 1].temperature_k);
  }
  return robust_std(bends).value_or(0.0) / std::sqrt(6.0);
}

void mark_sweeps(const std::vector<double>& slope, double least, TemperatureBlocks& of) {
  for (std::size_t b = 0; b < slope.size(); ++b) {
    if (std::abs(slope[b]) <= least) continue;
    of.blocks[b].sweep = slope[b] > 0.0 ? Sweep::heating : Sweep::cooling;
    (slope[b] > 0.0 ? of.risen_k : of.fallen_k) += std::abs(slope[b]);
  }
}

void set_sweeps(TemperatureBlocks& of) {
  const double std_k = thermometer_std(of.blocks);
  for (std::size_t reach = 2; reach <= of.blocks.size() / 8; reach *= 2) {
    const std::vector<double> slope = slopes(of.blocks, reach);
    double speed = 0.0;
    for (const double s : slope) speed += std::abs(s) / static_cast<double>(slope.size());
    const auto r = static_cast<double>(reach);
    const double doubt = 3.0 * std_k / std::sqrt(r * (r + 1.0) * (2.0 * r + 1.0) / 3.0);
    // A longer reach is less noisy, but smooths the reversals.
    if (doubt > 0.5 * speed) continue;
    mark_sweeps(slope, std::max(doubt, 0.2 * speed), of);
    return;
  }
}

Bounds range_of(const TemperatureBlocks& of, Sweep sweep) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Bounds range{infinity, -infinity};
  for (const TemperatureBlock& block : of.blocks) {
    if (block.sweep != sweep) continue;
    range.lower = std::min(range.lower, block.temperature_k);
    range.upper = std::max(range.upper, block.temperature_k);
  }
  return range;
}

bool goes_both_ways(const TemperatureBlocks& of) {
  const Bounds up = range_of(of, Sweep::heating), down = range_of(of, Sweep::cooling);
  const double from = std::max(up.lower, down.lower), to = std::min(up.upper, down.upper);
  if (!(to - from >= 0.2 * of.span_k()) || !(of.span_k() > 0.0)) return false;
  const auto within = [&](Sweep sweep) {
    return std::ranges::count_if(of.blocks, [&](const TemperatureBlock& block) {
      return block.sweep == sweep && block.temperature_k >= from && block.temperature_k <= to;
    });
  };
  return within(Sweep::heating) >= 4 && within(Sweep::cooling) >= 4;
}

}  // namespace

TemperatureBlocks temperature_blocks(View<double> series,
                                     View<double> temperature_k,
                                     double rate_hz) {
  TemperatureBlocks of;
  of.blocks = means(series, temperature_k);
  if (of.blocks.empty()) return of;
  of.block_s = static_cast<double>(of.blocks.front().end - of.blocks.front().begin) / rate_hz;
  const std::vector<double> sorted = sorted_temperatures(of.blocks);
  set_range(of, sorted);
  set_crowds(of, sorted);
  set_sweeps(of);
  of.both_ways = goes_both_ways(of);
  return of;
}

OrthogonalPolynomials orthogonal_polynomials(const TemperatureBlocks& of, int degree) {
  OrthogonalPolynomials basis;
  basis.reference_k = 0.5 * (of.lowest_k + of.highest_k);
  if (of.span_k() > 0.0) basis.scale_k = 0.5 * of.span_k();
  double before = 0.0;  // Σ p_{j−1}² / crowd
  for (int j = 0; j < degree; ++j) {
    double squares = 0.0, moment = 0.0;
    for (const TemperatureBlock& block : of.blocks) {
      const double x = (block.temperature_k - basis.reference_k) / basis.scale_k;
      const double p = basis.at(block.temperature_k)(j);
      squares += p * p / block.crowd;
      moment += x * p * p / block.crowd;
    }
    basis.alpha.push_back(moment / squares);
    basis.beta.push_back(j > 0 ? squares / before : 0.0);
    before = squares;
  }
  return basis;
}

Eigen::MatrixXd block_means(const OrthogonalPolynomials& basis,
                            const TemperatureBlocks& blocks,
                            View<double> series,
                            View<double> temperature_k) {
  Eigen::MatrixXd means(static_cast<Index>(blocks.blocks.size()),
                        static_cast<Index>(basis.alpha.size()) + 1);
  Index row = 0;
  for (const TemperatureBlock& block : blocks.blocks) {
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(means.cols());
    for (std::size_t k = block.begin; k < block.end; ++k) {
      if (std::isfinite(series[k]) && std::isfinite(temperature_k[k]))
        sum += basis.at(temperature_k[k]);
    }
    means.row(row++) = sum / sum(0);
  }
  return means;
}

std::vector<TemperaturePoint> temperature_points(const TemperatureBlocks& of) {
  std::vector<TemperaturePoint> points;
  for (const Sweep sweep : {Sweep::dwell, Sweep::heating, Sweep::cooling}) {
    std::array<Moments, point_parts> mean, temperature;
    for (const TemperatureBlock& block : of.blocks) {
      if (block.sweep != sweep) continue;
      const int part = of.span_k() > 0.0 ? part_of(of, block.temperature_k, point_parts) : 0;
      mean[static_cast<std::size_t>(part)].add(block.mean);
      temperature[static_cast<std::size_t>(part)].add(block.temperature_k);
    }
    for (std::size_t part = 0; part < mean.size(); ++part) {
      if (mean[part].count == 0) continue;
      points.push_back(
          {sweep, temperature[part].mean, mean[part].mean, mean[part].std(), mean[part].count});
    }
  }
  return points;
}

}  // namespace proofmass::characterise
