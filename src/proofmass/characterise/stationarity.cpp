#include "proofmass/characterise/stationarity.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <numbers>

#include "proofmass/characterise/noise/series_kernels.hpp"
#include "proofmass/characterise/noise_model.hpp"
#include "proofmass/core/chi_square.hpp"
#include "proofmass/core/contract.hpp"
#include "proofmass/core/statistics.hpp"
#include "proofmass/signal/whiteness.hpp"

namespace proofmass::characterise {
namespace {

constexpr std::size_t fewest_coefficients = 32, fewest_spans_of_part = 4, fewest_line_blocks = 64;
constexpr std::array<std::size_t, 5> partitions{2, 4, 8, 16, 32};
constexpr std::size_t longest_line_block = 4096;
constexpr double significant_p = 0.005;

// Correlation of neighbouring spans, about the mean of four; −1/4 for independent ones.
double neighbour_correlation(const std::vector<double>& spans) {
  double products = 0.0, squares = 0.0;
  for (std::size_t s = 0; s + 4 <= spans.size(); s += 4) {
    const double mean = 0.25 * (spans[s] + spans[s + 1] + spans[s + 2] + spans[s + 3]);
    if (std::isnan(mean)) continue;
    for (std::size_t k = s; k < s + 4; ++k) squares += square(spans[k] - mean);
    for (std::size_t k = s; k < s + 3; ++k) products += (spans[k] - mean) * (spans[k + 1] - mean);
  }
  return squares > 0.0 ? products / squares : 0.0;
}

// 2 Σ ρ² over the lags: the excess variance of a mean of squares over that of independent ones, so
// that n/(1 + this) of n coefficients are independent. Up to twice the first lag without
// significant correlation, since an oscillating one passes through zero. Source: M. S. Bartlett,
// Suppl. J. Roy. Statist. Soc. 8 (1946) 27.
double excess_correlation(const std::vector<double>& differences) {
  const auto n = static_cast<double>(differences.size());
  const std::vector<double> correlation =
      signal::autocorrelation(differences, differences.size() / 16);
  const double seen = 2.0 / std::sqrt(n);
  std::size_t last = 1;
  while (last < correlation.size() && std::abs(correlation[last]) >= seen) ++last;
  last = last == 1 ? 0 : std::min(2 * last, correlation.size() - 1);
  double sum = 0.0;
  for (std::size_t lag = 1; lag <= last; ++lag)
    sum += std::max(0.0, square(correlation[lag]) - 1.0 / n);
  return 2.0 * sum;
}

// Spans long enough to be independent: noise far slower than the differences, after a filter of
// several poles, is correlated between short spans.
std::vector<double> independent_means(EqualSpans spans, double excess_correlation) {
  spans.grow();
  constexpr double lengths_of_correlation = 8.0, uncorrelated = 0.0;
  const double shortest = lengths_of_correlation * excess_correlation;
  while (static_cast<double>(spans.length()) < shortest && spans.count() > 1) spans.halve();
  std::vector<double> means = spans.means();
  while (means.size() > 2 * fewest_spans_of_part && neighbour_correlation(means) > uncorrelated) {
    spans.halve();
    means = spans.means();
  }
  return means;
}

// Length of a part's spans, for any total with as many binary digits as this one: no longer than
// those that the whole series would have.
std::size_t length_of_spans(std::size_t total, std::size_t octave) {
  constexpr std::size_t log2_most = 9;
  const auto digits = static_cast<std::size_t>(std::bit_width(total));
  return digits > octave + 1 + log2_most ? std::size_t{1} << (digits - octave - 1 - log2_most) : 1;
}

using Band = StationarityTest::Band;

struct Parts {
  double p = 1.0;
  double change = 0.0;  // of the level, relative, root mean square beyond the scatter
  std::vector<double> means;
};

std::optional<Parts> compare_parts(const std::vector<double>& spans, std::size_t count) {
  if (spans.size() < fewest_spans_of_part * count) return std::nullopt;
  std::vector<Moments> parts(count);
  Moments all;
  for (std::size_t s = 0; s < spans.size(); ++s) {
    parts[s * count / spans.size()].add(spans[s]);
    all.add(spans[s]);
  }
  double within = 0.0, between = 0.0;
  for (const Moments& part : parts) {
    if (part.count < 2) return std::nullopt;
    within += part.squares;
    between += static_cast<double>(part.count) * square(part.mean - all.mean);
  }
  const auto dof_between = static_cast<double>(count - 1);
  const auto dof_within = static_cast<double>(all.count - count);
  if (!(within > 0.0) || !(all.mean > 0.0)) return std::nullopt;
  between /= dof_between;
  within /= dof_within;
  Parts found;
  found.p = fisher_f_p(between / within, dof_between, dof_within);
  const double each = static_cast<double>(all.count) / static_cast<double>(count);
  // The relative change of a root is half that of the level.
  found.change = 2.0 * std::sqrt(std::max(0.0, between - within) / each) / all.mean;
  for (const Moments& part : parts) found.means.push_back(square(part.mean / all.mean));
  return found;
}

// A sine beats with the differences' own steps: if lines contribute much of the variance, they are
// tested instead.
bool belongs_to_lines(double tau_s,
                      double allan_variance,
                      const std::vector<signal::SpectralLine>& lines) {
  constexpr double good_part = 0.1;
  double of_lines = 0.0;
  for (const signal::SpectralLine& line : lines)
    of_lines += sine_allan_variance(line.amplitude, line.frequency_hz, tau_s);
  return of_lines > good_part * allan_variance;
}

// The root of the Hann-windowed Fourier coefficient of each block at the line's frequency.
std::optional<Band> line_band(View<double> series, double rate_hz, double line_hz) {
  constexpr double fewest_cycles = 4.0;
  const std::size_t length = std::min(longest_line_block, series.size() / fewest_line_blocks);
  const auto n = static_cast<double>(length);
  if (line_hz * n / rate_hz < fewest_cycles) return std::nullopt;
  std::vector<std::complex<double>> wave(length);
  for (std::size_t k = 0; k < length; ++k) {
    const double at = static_cast<double>(k) + 0.5;
    const double window = square(std::sin(std::numbers::pi * at / n));
    wave[k] = std::polar(window, -2.0 * std::numbers::pi * line_hz / rate_hz * at);
  }
  EqualSpans roots;
  for (std::size_t from = 0; from + length <= series.size(); from += length) {
    const View<double> block = series.subspan(from, length);
    const Moments moments = proofmass::moments(block);
    std::complex<double> sum = 0.0;
    for (std::size_t k = 0; k < length; ++k) sum += wave[k] * (block[k] - moments.mean);
    roots.add(moments.nonfinite > 0 ? no_value : std::sqrt(std::abs(sum)));
  }
  return Band{0.0, line_hz, independent_means(std::move(roots), 0.0)};
}

Stationarity judged(const std::vector<Band>& bands) {
  Stationarity result;
  double tests = 0.0, change = 0.0;
  for (const Band& band : bands) {
    for (const std::size_t count : partitions) {
      auto parts = compare_parts(band.spans, count);
      if (!parts) continue;
      tests += 1.0;
      if (result.tested && parts->p >= result.p) continue;
      result = {true, true, parts->p, band.averaging_s, band.line_hz, std::move(parts->means)};
      change = parts->change;
    }
  }
  result.p = std::min(1.0, tests * result.p);
  result.stationary = result.p >= significant_p || change < relevant_change;
  return result;
}

}  // namespace

EqualSpans::EqualSpans(std::size_t first, std::size_t length)
    : length_(length), taken_(first % length), is_fixed_(true) {
  if (taken_ == 0) return;
  sums_.push_back(0.0);
  counts_.push_back(0.0);
}

void EqualSpans::append(const EqualSpans& part) {
  PM_EXPECTS(is_fixed_ && part.is_fixed_ && part.length_ == length_);
  std::size_t from = 0;
  if (taken_ > 0) {
    sums_.back() += part.sums_.front();
    counts_.back() += part.counts_.front();
    from = 1;
  }
  for (std::size_t k = from; k < part.sums_.size(); ++k) {
    sums_.push_back(part.sums_[k]);
    counts_.push_back(part.counts_[k]);
  }
  taken_ = part.taken_;
}

void EqualSpans::grow() {
  while (is_fixed_ && sums_.size() > most) halve();
}

void EqualSpans::exchange(StateBytes& bytes, std::size_t first, std::size_t values) {
  bytes(sums_);
  bytes(counts_);
  const std::size_t end = first % length_ + values;
  taken_ = end % length_;
  if (sums_.size() != (end + length_ - 1) / length_ || counts_.size() != sums_.size()) bytes.fail();
}

void EqualSpans::add(View<double> values) {
  while (!values.empty()) {
    if (taken_ == 0) {
      if (sums_.size() == most && !is_fixed_) halve();
      sums_.push_back(0.0);
      counts_.push_back(0.0);
    }
    const std::size_t count = std::min(length_ - taken_, values.size());
    const PresentSum present = sum_present(values.data(), count);
    sums_.back() += present.sum;
    counts_.back() += static_cast<double>(present.count);
    taken_ += count;
    if (taken_ == length_) taken_ = 0;
    values = values.subspan(count);
  }
}

// A last span without a partner is continued.
void EqualSpans::halve() {
  const std::size_t pairs = sums_.size() / 2;
  const bool odd = sums_.size() % 2 == 1;
  for (std::size_t k = 0; k < pairs; ++k) {
    sums_[k] = sums_[2 * k] + sums_[2 * k + 1];
    counts_[k] = counts_[2 * k] + counts_[2 * k + 1];
  }
  if (odd) {
    sums_[pairs] = sums_.back();
    counts_[pairs] = counts_.back();
    if (taken_ == 0) taken_ = length_;
  } else if (taken_ > 0) {
    taken_ += length_;
  }
  sums_.resize(pairs + (odd ? 1 : 0));
  counts_.resize(sums_.size());
  length_ *= 2;
}

std::vector<double> EqualSpans::means() const {
  std::vector<double> means(taken_ == 0 ? sums_.size() : sums_.size() - 1);
  for (std::size_t k = 0; k < means.size(); ++k) means[k] = sums_[k] / counts_[k];
  return means;
}

void StationarityTest::Octave::add(View<double> values,
                                   std::vector<double>& means,
                                   std::vector<double>& buffer) {
  means.clear();
  if (wants_head && !head && !values.empty()) {
    head = values.front();
    values = values.subspan(1);
  }
  if (values.empty()) return;
  std::vector<double>& differences = buffer;
  const std::size_t waiting = first_of_pair ? 1 : 0;
  const std::size_t pairs = (waiting + values.size()) / 2;
  differences.resize(pairs);
  means.resize(pairs);
  if (first_of_pair) {
    const std::array<double, 2> pair{*first_of_pair, values.front()};
    split_pairs(pair.data(), 1, differences.data(), means.data());
    first_of_pair.reset();
    values = values.subspan(1);
  }
  split_pairs(values.data(), pairs - waiting, differences.data() + waiting, means.data() + waiting);
  if (values.size() % 2 == 1) first_of_pair = values.back();
  coefficients += pairs;
  if (beginning.size() < room) {
    const std::size_t wanted = std::min(pairs, room - beginning.size());
    beginning.insert(beginning.end(), differences.begin(),
                     differences.begin() + static_cast<std::ptrdiff_t>(wanted));
  }
  const PresentSum sum = sum_finite_squares(differences.data(), pairs);
  squares += sum.sum;
  finite += sum.count;
  take_roots(differences.data(), pairs);
  roots.add(View<double>(differences));
}

void StationarityTest::Octave::append(const Octave& part) {
  if (part.coefficients > 0) {
    PM_EXPECTS(!first_of_pair);
    coefficients += part.coefficients;
    roots.append(part.roots);
    squares += part.squares;
    finite += part.finite;
    for (const double difference : part.beginning)
      if (beginning.size() < room) beginning.push_back(difference);
  }
  if (part.first_of_pair) first_of_pair = part.first_of_pair;
}

void StationarityTest::Octave::exchange(StateBytes& bytes,
                                        std::size_t first_pair,
                                        std::size_t means) {
  bytes(first_of_pair);
  bytes(head);
  coefficients = (means - (wants_head ? 1 : 0)) / 2;
  roots.exchange(bytes, first_pair, coefficients);
  bytes(squares);
  bytes(finite);
  bytes(beginning);
  const bool is_odd = (means - (wants_head ? 1 : 0)) % 2 == 1;
  if (head.has_value() != wants_head || first_of_pair.has_value() != is_odd ||
      finite > coefficients || beginning.size() != std::min(room, coefficients))
    bytes.fail();
}

StationarityTest::StationarityTest(std::size_t first, std::size_t total)
    : first_(first), total_(total) {}

// The next octave, where this part begins in it: an octave's means are over 2^k samples.
StationarityTest::Octave StationarityTest::new_octave() const {
  constexpr std::size_t enough_for_correlation = 8192;
  Octave octave;
  octave.room = enough_for_correlation;
  if (total_ == 0) return octave;
  const std::size_t k = octaves_.size(), samples = std::size_t{1} << k;
  const std::size_t first_mean = (first_ + samples - 1) / samples;
  octave.wants_head = first_mean % 2 == 1;
  const std::size_t first_pair = (first_mean + 1) / 2;
  octave.room -= std::min(octave.room, first_pair);
  octave.roots = EqualSpans(first_pair, length_of_spans(total_, k));
  return octave;
}

void StationarityTest::append(const StationarityTest& part) {
  PM_EXPECTS(total_ > 0 && part.total_ == total_ && part.first_ == first_ + samples_);
  samples_ += part.samples_;
  std::optional<double> mean;
  std::vector<double> made, buffer;
  for (std::size_t k = 0; mean || k < part.octaves_.size(); ++k) {
    if (k == octaves_.size()) octaves_.push_back(new_octave());
    std::optional<double> next;
    const auto add = [&](double value) {
      octaves_[k].add(View<double>(&value, 1), made, buffer);
      if (!made.empty()) next = made.front();
    };
    // The mean that spans the border, and the one after it that waits for its partner.
    if (mean) add(*mean);
    if (k < part.octaves_.size()) {
      const Octave& other = part.octaves_[k];
      if (other.head) add(*other.head);
      octaves_[k].append(other);
    }
    mean = next;
  }
}

void StationarityTest::exchange(StateBytes& bytes) {
  bytes(samples_);
  constexpr std::size_t most_samples = std::size_t{1} << 48;
  if (samples_ > most_samples || first_ > most_samples) return bytes.fail();
  for (std::size_t k = 0; !bytes.failed(); ++k) {
    const std::size_t samples = std::size_t{1} << k;
    const std::size_t first_mean = (first_ + samples - 1) / samples;
    const std::size_t end = (first_ + samples_) / samples;
    if (end <= first_mean) break;
    if (k == octaves_.size()) octaves_.push_back(new_octave());
    octaves_[k].exchange(bytes, (first_mean + 1) / 2, end - first_mean);
  }
}

void StationarityTest::add(View<double> samples) {
  // Short enough for the means of all octaves to stay in the cache.
  constexpr std::size_t piece = 1024;
  std::vector<double> means, above, buffer;
  samples_ += samples.size();
  for (std::size_t from = 0; from < samples.size(); from += piece) {
    View<double> values = samples.subspan(from, std::min(piece, samples.size() - from));
    for (std::size_t k = 0; !values.empty(); ++k) {
      if (k == octaves_.size()) octaves_.push_back(new_octave());
      octaves_[k].add(values, above, buffer);
      std::swap(means, above);
      values = means;
    }
  }
}

std::vector<StationarityTest::Band> StationarityTest::bands(
    double rate_hz, const std::vector<signal::SpectralLine>& lines) const {
  std::vector<Band> bands;
  double averaging_s = 1.0 / rate_hz;
  for (const Octave& octave : octaves_) {
    if (octave.coefficients < fewest_coefficients) break;
    const double mean_of_squares =
        octave.finite > 0 ? octave.squares / static_cast<double>(octave.finite) : 0.0;
    if (!belongs_to_lines(averaging_s, mean_of_squares / 2.0, lines))
      bands.push_back({averaging_s, std::nullopt,
                       independent_means(octave.roots, excess_correlation(octave.beginning))});
    averaging_s *= 2.0;
  }
  return bands;
}

Stationarity StationarityTest::finish(double rate_hz,
                                      const std::vector<signal::SpectralLine>& lines) const {
  return judged(bands(rate_hz, lines));
}

Stationarity test_stationarity(const StationarityTest& differences,
                               View<double> series,
                               double rate_hz,
                               const std::vector<signal::SpectralLine>& lines) {
  std::vector<Band> bands = differences.bands(rate_hz, lines);
  for (const signal::SpectralLine& line : lines)
    if (auto band = line_band(series, rate_hz, line.frequency_hz))
      bands.push_back(std::move(*band));
  return judged(bands);
}

}  // namespace proofmass::characterise
