#include "proofmass/signal/events/thresholds.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "proofmass/signal/events/source.hpp"

namespace proofmass::signal {
namespace {

/// Number of evenly spaced values that is sufficient for accurate quantiles.
constexpr std::size_t sample_size = 8192;
std::size_t stride_of(std::size_t size) {
  return size / sample_size + 1;
}

/// Level that a Gumbel law with the quartiles of `largest` exceeds once in a hundred records of
/// `blocks`.
double gumbel_reach(std::vector<double> largest, std::size_t blocks) {
  if (largest.size() < 4) return 0.0;
  const auto at = [&](std::size_t rank) {
    return largest.begin() + static_cast<std::ptrdiff_t>(rank);
  };
  const auto half = at(largest.size() / 2);
  std::ranges::nth_element(largest, half);
  std::nth_element(largest.begin(), at(largest.size() / 4), half);
  std::nth_element(half + 1, at(largest.size() * 3 / 4), largest.end());
  const double lower = *at(largest.size() / 4);
  const double middle = *half;
  const double upper = *at(largest.size() * 3 / 4);
  const double beta = (upper - lower) / 1.5725;  // ln ln 4 − ln ln 4/3
  return middle + beta * (std::log(100.0 * static_cast<double>(blocks)) - 0.3665);
}

/// The median of `seen` values or `least`, whichever is larger, computed from the values above
/// `least` alone: most groups need no search.
double median_above(std::span<double> above, std::size_t seen, double least) {
  const std::size_t below = seen - above.size();
  if (seen / 2 < below || above.empty()) return least;
  const auto middle = above.begin() + static_cast<std::ptrdiff_t>(seen / 2 - below);
  std::ranges::nth_element(above, middle);
  return *middle;
}

constexpr double sigma_per_mean = 1.2533141373155003;  ///< √(π/2)

/// The median scale of the whole record, at least `floor`.
double scale_of_record(const std::vector<Tally>& blocks, double floor) {
  std::vector<double> all;
  for (std::size_t b = 0; b < blocks.size(); b += stride_of(blocks.size()))
    if (!std::isnan(blocks[b].mean)) all.push_back(sigma_per_mean * blocks[b].mean);
  return std::max(floor, all.empty() ? 0.0 : median_of(all));
}

/// The median scale of a group's blocks, at least `least`; `above` is scratch space.
double scale_of_group(View<Tally> blocks, double least, std::vector<double>& above) {
  above.resize(blocks.size());
  std::size_t seen = 0;
  std::size_t count = 0;
  for (const Tally& block : blocks) {
    const double sigma = sigma_per_mean * block.mean;
    above[count] = sigma;
    count += sigma > least ? 1 : 0;
    seen += std::isnan(sigma) ? 0 : 1;
  }
  above.resize(count);
  return median_above(above, seen, least);
}

}  // namespace

Tally tally(View<double> outputs) {
  double sum = 0.0;
  double max = 0.0;
  double count = 0.0;
  for (const double output : outputs) {
    const double size = std::abs(output);
    const bool there = size >= 0.0;
    sum += there ? size : 0.0;
    max = size > max ? size : max;
    count += there ? 1.0 : 0.0;
  }
  return {count > 0.0 ? sum / count : nan, max};
}

std::vector<Tally> tallies(View<double> outputs) {
  const std::size_t whole = outputs.size() / coarse_block;
  std::vector<Tally> result(whole);
  tally_outputs(outputs.data(), whole, result.data());
  for (std::size_t b = 0; b < whole; ++b)
    if (std::isnan(result[b].mean))
      result[b] = tally(outputs.subspan(b * coarse_block, coarse_block));
  if (whole * coarse_block < outputs.size())
    result.push_back(tally(outputs.subspan(whole * coarse_block)));
  return result;
}

std::size_t group_of(double rate_hz, std::size_t samples_per_block) {
  return std::max<std::size_t>(16, samples_in(30.0, rate_hz) / samples_per_block);
}

std::vector<double> group_scales(const std::vector<Tally>& blocks,
                                 std::size_t group,
                                 double floor) {
  const double overall = scale_of_record(blocks, floor);
  std::vector<double> own(std::max<std::size_t>(blocks.size() / group, 1));
  std::vector<double> above;
  for (std::size_t g = 0; g < own.size(); ++g) {
    const std::size_t end = (g + 2) * group > blocks.size() ? blocks.size() : (g + 1) * group;
    const View<Tally> members = View<Tally>(blocks).subspan(g * group, end - g * group);
    own[g] = scale_of_group(members, overall, above);
  }
  std::vector<double> scale(own.size());
  for (std::size_t g = 0; g < own.size(); ++g)
    scale[g] =
        std::max({overall, own[g], own[g > 0 ? g - 1 : 0], own[std::min(g + 1, own.size() - 1)]});
  return scale;
}

Bar bar_of(const std::vector<Tally>& blocks, std::size_t group, double floor, std::size_t outputs) {
  Bar bar{group, group_scales(blocks, group, floor), 0.0};
  std::vector<double> largest;
  for (std::size_t b = 0; b < blocks.size(); b += stride_of(blocks.size()))
    if (blocks[b].max > 0.0 && bar.scale_at(b) > 0.0)
      largest.push_back(blocks[b].max / bar.scale_at(b));
  const double few = 1.0 + 3.0 / static_cast<double>(std::max<std::size_t>(blocks.size(), 1));
  const double gauss = few * std::sqrt(2.0 * std::log(1000.0 * static_cast<double>(outputs + 1)));
  bar.sigmas = std::max(gauss, gumbel_reach(std::move(largest), blocks.size()));
  return bar;
}

}  // namespace proofmass::signal
