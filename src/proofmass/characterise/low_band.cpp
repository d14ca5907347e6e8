#include "proofmass/characterise/low_band.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "proofmass/signal/fourier.hpp"

namespace proofmass::characterise {
namespace {

// As many blocks of one sample fit before the blocks grow.
constexpr std::size_t most_blocks = std::size_t{1} << 16;
constexpr std::size_t shortest_stretch = 16;
constexpr std::size_t neighbours = 8;

struct Stretch {
  std::size_t first = 0, end = 0;
};

std::size_t end_of_gap(View<double> means, std::size_t from) {
  while (from < means.size() && std::isnan(means[from])) ++from;
  return from;
}

// Parts between gaps that are too long to be filled.
std::vector<Stretch> stretches(View<double> means) {
  const std::size_t longest_gap = std::max<std::size_t>(neighbours, means.size() / 200);
  std::vector<Stretch> parts;
  std::size_t k = end_of_gap(means, 0);
  while (k < means.size()) {
    Stretch part{k, k};
    while (k < means.size()) {
      if (!std::isnan(means[k])) {
        part.end = ++k;
        continue;
      }
      const std::size_t behind = end_of_gap(means, k);
      if (behind - k > longest_gap) break;
      k = behind;
    }
    if (part.end - part.first >= shortest_stretch) parts.push_back(part);
    k = end_of_gap(means, k);
  }
  return parts;
}

double mean_of_neighbours(View<double> values, std::size_t gap, std::size_t behind) {
  double sum = 0.0;
  std::size_t count = 0;
  const auto take = [&](double value) {
    if (std::isnan(value)) return;
    sum += value;
    ++count;
  };
  for (std::size_t k = gap - std::min(neighbours, gap); k < gap; ++k) take(values[k]);
  for (std::size_t k = behind; k < std::min(values.size(), behind + neighbours); ++k)
    take(values[k]);
  return sum / static_cast<double>(count);
}

// The stretch with its gaps filled, less its mean; `share` is that of the blocks that are there.
std::vector<double> filled(View<double> means, double& share) {
  std::vector<double> values(means.begin(), means.end());
  std::size_t missing = 0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (!std::isnan(means[k])) continue;
    const std::size_t behind = end_of_gap(means, k);
    const double fill = mean_of_neighbours(means, k, behind);
    for (; k < behind; ++k, ++missing) values[k] = fill;
  }
  const auto n = static_cast<double>(values.size());
  share = 1.0 - static_cast<double>(missing) / n;
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  for (double& value : values) value -= mean;
  return values;
}

void append_ordinates(View<double> means, double step_s, bool whole_band,
                      std::vector<CosineOrdinate>& ordinates) {
  double share = 1.0;
  std::vector<double> values = filled(means, share);
  const std::size_t n = values.size(), last = whole_band ? n - 1 : n / 2;
  const std::vector<double> amplitudes = signal::cosine_transform(values);
  for (std::size_t k = 0; k < n; ++k) {
    values[k] = step_s * (static_cast<double>(k) - 0.5 * static_cast<double>(n - 1));
  }
  const std::vector<double> of_ramp = signal::cosine_transform(values);
  const double to_density = std::sqrt(step_s / share);
  for (std::size_t k = 1; k <= last; ++k) {
    ordinates.push_back({static_cast<double>(k) / (2.0 * static_cast<double>(n) * step_s),
                         amplitudes[k] * to_density, of_ramp[k] * std::sqrt(step_s)});
  }
}

}  // namespace

void BlockMeans::add(View<double> samples) {
  for (const double sample : samples) {
    if (std::isfinite(sample)) {
      sum_ += sample;
      ++valid_;
    }
    if (++taken_ == block_) close_block();
  }
}

void BlockMeans::close_block() {
  sums_.push_back(sum_);
  counts_.push_back(static_cast<std::uint16_t>(valid_));
  sum_ = 0.0;
  valid_ = taken_ = 0;
  if (sums_.size() == most_blocks && block_ < longest_block) halve();
}

void BlockMeans::halve() {
  for (std::size_t k = 0; k < sums_.size() / 2; ++k) {
    sums_[k] = sums_[2 * k] + sums_[2 * k + 1];
    counts_[k] = static_cast<std::uint16_t>(counts_[2 * k] + counts_[2 * k + 1]);
  }
  sums_.resize(sums_.size() / 2);
  counts_.resize(counts_.size() / 2);
  block_ *= 2;
}

std::vector<double> BlockMeans::means() const {
  std::vector<double> means(sums_.size());
  for (std::size_t k = 0; k < means.size(); ++k) {
    means[k] = 2 * counts_[k] >= block_ ? sums_[k] / counts_[k]
                                        : std::numeric_limits<double>::quiet_NaN();
  }
  return means;
}

std::vector<CosineOrdinate> BlockMeans::ordinates() const {
  const std::vector<double> all = means();
  const double step_s = static_cast<double>(block_) / rate_hz_;
  std::vector<CosineOrdinate> ordinates;
  for (const Stretch& part : stretches(all)) {
    const auto means_of_part = View<double>(all).subspan(part.first, part.end - part.first);
    append_ordinates(means_of_part, step_s, block_ == 1, ordinates);
  }
  return ordinates;
}

}  // namespace proofmass::characterise
