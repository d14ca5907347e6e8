#include "proofmass/characterise/noise/cosine_ordinates.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "proofmass/core/contract.hpp"
#include "proofmass/signal/fourier.hpp"

namespace proofmass::characterise {
namespace {

// Maximum number of single-sample blocks.
constexpr std::size_t most_blocks = std::size_t{1} << 16;
constexpr std::size_t shortest_stretch = 16;
constexpr std::size_t fewest_neighbours = 8;
constexpr std::size_t transform_any_length_below = 4096;

struct Stretch {
  std::size_t first = 0, end = 0;
};

std::size_t end_of_gap(View<double> means, std::size_t from) {
  while (from < means.size() && std::isnan(means[from])) ++from;
  return from;
}

// Parts between gaps too long to be filled.
std::vector<Stretch> stretches(View<double> means) {
  const std::size_t longest_gap = std::max<std::size_t>(fewest_neighbours, means.size() / 200);
  std::vector<Stretch> parts;
  std::size_t k = end_of_gap(means, 0);
  while (k < means.size()) {
    Stretch part{k, k};
    while (k < means.size()) {
      if (!std::isnan(means[k])) {
        part.end = ++k;
        continue;
      }
      const std::size_t after = end_of_gap(means, k);
      if (after - k > longest_gap) break;
      k = after;
    }
    if (part.end - part.first >= shortest_stretch) parts.push_back(part);
    k = end_of_gap(means, k);
  }
  return parts;
}

// On each side as many as are missing: the mean of a few would be white noise drawn out over a long
// gap, which looks like slow noise.
double mean_of_neighbours(View<double> values, std::size_t gap, std::size_t after) {
  const std::size_t neighbours = std::max(fewest_neighbours, after - gap);
  double sum = 0.0;
  std::size_t count = 0;
  const auto take = [&](double value) {
    if (std::isnan(value)) return;
    sum += value;
    ++count;
  };
  for (std::size_t k = gap - std::min(neighbours, gap); k < gap; ++k) take(values[k]);
  for (std::size_t k = after; k < std::min(values.size(), after + neighbours); ++k) take(values[k]);
  return sum / static_cast<double>(count);
}

// The stretch with its gaps filled, minus its mean; `share` is that of the available blocks.
std::vector<double> filled(View<double> means, double& share) {
  std::vector<double> values(means.begin(), means.end());
  std::size_t missing = 0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (!std::isnan(means[k])) continue;
    const std::size_t after = end_of_gap(means, k);
    const double fill = mean_of_neighbours(means, k, after);
    for (; k < after; ++k, ++missing) values[k] = fill;
  }
  const auto n = static_cast<double>(values.size());
  share = 1.0 - static_cast<double>(missing) / n;
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  for (double& value : values) value -= mean;
  return values;
}

// Ordinate of a ramp of 1 unit/s: √(2/n) step Σ (j + ½) cos((j + ½) π k/n) and √step for the
// density, the sum being the derivative of Σ sin((j + ½) θ) = (1 − cos nθ) / (2 sin(θ/2)) at θ = π
// k/n. None for even k.
double ramp_amplitude(std::size_t k, std::size_t n, double step_s) {
  if (k % 2 == 0) return 0.0;
  const double half = 0.5 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(n);
  const double sine = std::sin(half);
  return -std::sqrt(2.0 * step_s / static_cast<double>(n)) * step_s * std::cos(half) /
         (2.0 * sine * sine);
}

// The longest length up to n suitable for a fast transform: no prime factor above 13. For stretches
// of some thousand blocks it cuts off about one in a hundred at most.
std::size_t smooth_length(std::size_t n) {
  const auto rest = [](std::size_t m) {
    for (const std::size_t prime : {2U, 3U, 5U, 7U, 11U, 13U})
      while (m % prime == 0) m /= prime;
    return m;
  };
  while (n > 1 && rest(n) != 1) --n;
  return n;
}

constexpr std::size_t lanes = 8;

// For a whole number of lanes, in parallel.
double sum_of(View<double> samples) {
  std::array<double, lanes> sums{};
  for (std::size_t k = 0; k < samples.size(); k += lanes)
    for (std::size_t lane = 0; lane < lanes; ++lane) sums[lane] += samples[k + lane];
  return std::accumulate(sums.begin(), sums.end(), 0.0);
}

void append_ordinates(View<double> means,
                      const CosineVector& first,
                      bool whole_band,
                      std::vector<CosineOrdinate>& ordinates) {
  double share = 1.0;
  std::vector<double> values = filled(means, share);
  const std::size_t n = values.size(), last = whole_band ? n - 1 : n / 2;
  const std::vector<double> amplitudes = signal::cosine_transform(values);
  const double step_s = first.step_s, to_density = std::sqrt(step_s / share);
  ordinates.reserve(ordinates.size() + last);
  for (std::size_t k = 1; k <= last; ++k) {
    ordinates.push_back({static_cast<double>(k) / (2.0 * static_cast<double>(n) * step_s),
                         amplitudes[k] * to_density,
                         ramp_amplitude(k, n, step_s),
                         {k, n, first.start_s, step_s}});
  }
}

}  // namespace

double SlowWave::at(double time_s) const {
  const double phase = 2.0 * std::numbers::pi * frequency_hz * time_s;
  return cosine * std::cos(phase) + sine * std::sin(phase);
}

// √(2 step/n) Σ exp(iω(start + (j + ½) step)) cos(π k (j + ½)/n), the product being half the sum of
// two waves of θ = ω step ± π k/n, and Σ exp(iθ(j + ½)) = exp(iθn/2) sin(θn/2) / sin(θ/2).
std::complex<double> CosineVector::of_wave(double frequency_hz) const {
  const auto blocks = static_cast<double>(n);
  const double omega = 2.0 * std::numbers::pi * frequency_hz;
  const auto sum = [&](double theta) {
    const double half = 0.5 * theta, below = std::sin(half);
    const double size = std::abs(below) > 1e-12 ? std::sin(half * blocks) / below : blocks;
    return std::polar(1.0, half * blocks) * size;
  };
  const double of_vector = std::numbers::pi * static_cast<double>(k) / blocks;
  const std::complex<double> both =
      sum(omega * step_s + of_vector) + sum(omega * step_s - of_vector);
  return 0.5 * std::sqrt(2.0 * step_s / blocks) * std::polar(1.0, omega * start_s) * both;
}

BlockMeans::BlockMeans(double rate_hz, std::size_t first, std::size_t total)
    : rate_hz_(rate_hz), is_part_(true) {
  // What the blocks of the whole are in the end.
  while (block_ < longest_block && total / block_ >= most_blocks) block_ *= 2;
  before_ = taken_ = first % block_;
}

void BlockMeans::append(const BlockMeans& part) {
  PM_EXPECTS(is_part_ && part.is_part_ && part.block_ == block_ && part.before_ == taken_);
  if (part.sums_.empty()) {
    sum_ += part.sum_;
    valid_ += part.valid_;
    taken_ = part.taken_;
    return;
  }
  const std::size_t at = sums_.size();
  sums_.insert(sums_.end(), part.sums_.begin(), part.sums_.end());
  counts_.insert(counts_.end(), part.counts_.begin(), part.counts_.end());
  sums_[at] += sum_;
  counts_[at] = static_cast<std::uint16_t>(counts_[at] + valid_);
  sum_ = part.sum_;
  valid_ = part.valid_;
  taken_ = part.taken_;
}

void BlockMeans::exchange(StateBytes& bytes, std::size_t samples) {
  bytes(sums_);
  bytes(counts_);
  bytes(sum_);
  bytes(valid_);
  bytes(taken_);
  const auto is_too_many = [&](std::uint16_t count) { return count > block_; };
  if (sums_.size() != (before_ + samples) / block_ || counts_.size() != sums_.size() ||
      taken_ != (before_ + samples) % block_ || valid_ > block_ ||
      std::ranges::any_of(counts_, is_too_many))
    bytes.fail();
}

void BlockMeans::add(View<double> samples) {
  std::size_t k = 0;
  while (k < samples.size()) {
    if (taken_ == 0 && block_ % lanes == 0 && k + block_ <= samples.size()) {
      // A sum is finite if all its terms are: samples need no separate check.
      const double sum = sum_of(samples.subspan(k, block_));
      if (std::isfinite(sum)) {
        sum_ = sum;
        valid_ = block_;
        k += block_;
        close_block();
        continue;
      }
    }
    const double sample = samples[k++];
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
  if (!is_part_ && sums_.size() == most_blocks && block_ < longest_block) halve();
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
    means[k] =
        2 * counts_[k] >= block_ ? sums_[k] / counts_[k] : std::numeric_limits<double>::quiet_NaN();
  }
  return means;
}

std::vector<CosineOrdinate> BlockMeans::ordinates(const SlowWave& wave) const {
  std::vector<double> all = means();
  const double step_s = static_cast<double>(block_) / rate_hz_;
  for (std::size_t k = 0; k < all.size() && wave.frequency_hz > 0.0; ++k)
    all[k] -= wave.at((static_cast<double>(k) + 0.5) * step_s);
  std::vector<CosineOrdinate> ordinates;
  for (const Stretch& part : stretches(all)) {
    const std::size_t length = part.end - part.first;
    const bool worth_cutting = length > transform_any_length_below;
    const auto means_of_part =
        View<double>(all).subspan(part.first, worth_cutting ? smooth_length(length) : length);
    const CosineVector first{0, 0, static_cast<double>(part.first) * step_s, step_s};
    append_ordinates(means_of_part, first, block_ == 1, ordinates);
  }
  return ordinates;
}

}  // namespace proofmass::characterise
