#include "proofmass/signal/spectrum.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "proofmass/core/contract.hpp"
#include "proofmass/signal/spectrum/lane_fourier.hpp"

namespace proofmass::signal {
namespace {

constexpr std::size_t shortest_segment = 16;
constexpr std::size_t batch_segments = 2 * lanes;

bool is_valid(const SpectrumOptions& options) {
  return std::isfinite(options.rate_hz) && options.rate_hz > 0.0 &&
         options.segment >= shortest_segment && std::has_single_bit(options.segment);
}

/// The periodic Hann window, (1 − cos(2π n / L)) / 2.
std::vector<double> hann_window(std::size_t length) {
  std::vector<double> window(length);
  for (std::size_t n = 0; n < length; ++n)
    window[n] =
        0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * static_cast<double>(n) / double(length));
  return window;
}

/// 1/36 for a Hann window: the correlation of the powers of adjacent segments of white noise.
constexpr double neighbour_correlation = 1.0 / 36.0;

double equivalent_degrees_of_freedom(std::size_t segments) {
  const auto n = static_cast<double>(segments);
  return 2.0 * n / (1.0 + 2.0 * neighbour_correlation * (n - 1.0) / n);
}

}  // namespace

struct SpectrumAccumulator::State {
  State(SpectrumOptions chosen, std::size_t first)
      : options(chosen),
        head_wanted(first == 0 ? 0 : (half() - first % half()) % half() + half()),
        fourier(chosen.segment),
        window(hann_window(chosen.segment)),
        work(chosen.segment),
        sums(chosen.segment) {
    for (const double w : window) window_power += w * w;
    buffer.reserve((batch_segments + 1) * half());
  }

  [[nodiscard]] std::size_t half() const { return options.segment / 2; }

  /// Segments that start in the buffer and are complete.
  [[nodiscard]] std::size_t complete() const {
    return buffer.size() < options.segment ? 0 : buffer.size() / half() - 1;
  }

  /// Σ w² over the valid samples of a segment.
  [[nodiscard]] double valid_window_power(const double* samples) const {
    double power = 0.0;
    for (std::size_t n = 0; n < options.segment; ++n)
      if (std::isfinite(samples[n])) power += window[n] * window[n];
    return power;
  }

  /// Transforms what is complete, so that less than a segment stays in the buffer.
  void flush() {
    const std::size_t segments = complete();
    if (segments == 0) return;
    transform_segments();
    full_batch_seen = true;
    buffer.erase(buffer.begin(), buffer.begin() + static_cast<long>(segments * half()));
  }

  /// Takes samples into the head; returns the rest.
  [[nodiscard]] View<double> fill_head(View<double> samples) {
    const std::size_t count = std::min(samples.size(), head_wanted - head.size());
    if (count == 0) return samples;
    head.insert(head.end(), samples.begin(), samples.begin() + static_cast<long>(count));
    if (head.size() == head_wanted)
      buffer.assign(head.end() - static_cast<long>(half()), head.end());
    return samples.subspan(count);
  }

  /// Σ |X|² of all segments so far.
  [[nodiscard]] std::vector<double> power() const {
    std::vector<double> all = fourier.real_power(sums);
    for (std::size_t k = 0; k < appended.size(); ++k) all[k] += appended[k];
    return all;
  }

  /// Adds the power of the complete segments in the buffer.
  void transform_segments() {
    SegmentBatch batch{buffer.data(), half(), window.data(), {}, {}, complete()};
    ValidSum left = valid_sum(buffer.data(), half());
    for (std::size_t s = 0; s < batch.segments; ++s) {
      const ValidSum right = valid_sum(buffer.data() + (s + 1) * half(), half());
      const double valid = left.count + right.count;
      const double power = valid == static_cast<double>(options.segment)
                               ? window_power
                               : valid_window_power(buffer.data() + s * half());
      if (power >= 0.5 * window_power) {
        batch.mean[s] = (left.sum + right.sum) / valid;
        batch.scale[s] = 1.0 / std::sqrt(power);
        ++averaged;
      }
      left = right;
    }
    load_segments(batch, work);
    fourier.add_power(work, sums);
  }

  SpectrumOptions options;
  /// Samples from the start of a part to the end of the first half segment of the whole series that
  /// lies in it; the last half segment of them is the first of the buffer.
  std::size_t head_wanted;
  std::vector<double> head;
  std::vector<double> appended;  ///< Σ |X|² of parts; empty: none
  LaneFourier fourier;
  std::vector<double> window;
  double window_power = 0.0;
  std::vector<double> buffer;  ///< samples from the start of the next segment
  std::vector<LaneComplex> work;
  std::vector<LaneReal> sums;
  std::size_t averaged = 0;
  bool full_batch_seen = false;
};

SpectrumAccumulator::SpectrumAccumulator(SpectrumOptions options, std::size_t first) {
  PM_EXPECTS(is_valid(options));
  state_ = std::make_unique<State>(options, first);
}

SpectrumAccumulator::SpectrumAccumulator(SpectrumAccumulator&&) noexcept = default;
SpectrumAccumulator& SpectrumAccumulator::operator=(SpectrumAccumulator&&) noexcept = default;
SpectrumAccumulator::~SpectrumAccumulator() = default;

void SpectrumAccumulator::add(View<double> samples) {
  std::vector<double>& buffer = state_->buffer;
  const std::size_t half = state_->half(), batch = (batch_segments + 1) * half;
  samples = state_->fill_head(samples);
  while (!samples.empty()) {
    const std::size_t count = std::min(samples.size(), batch - buffer.size());
    buffer.insert(buffer.end(), samples.begin(), samples.begin() + static_cast<long>(count));
    samples = samples.subspan(count);
    if (buffer.size() < batch) return;
    state_->transform_segments();
    state_->full_batch_seen = true;
    buffer.erase(buffer.begin(), buffer.end() - static_cast<long>(half));
  }
}

void SpectrumAccumulator::append(const SpectrumAccumulator& part) {
  const State& other = *part.state_;
  PM_EXPECTS(other.options.segment == state_->options.segment);
  add(other.head);
  if (other.head.size() < other.head_wanted) return;
  // The half segment at the end of the head is now the last of this buffer, and the first of that.
  state_->flush();
  PM_EXPECTS(state_->buffer.size() == state_->half() || other.head_wanted == 0);
  State next = other;
  next.flush();
  state_->buffer = next.buffer;
  state_->averaged += next.averaged;
  state_->full_batch_seen = state_->full_batch_seen || next.full_batch_seen;
  if (next.averaged == 0) return;
  const std::vector<double> power = next.power();
  state_->appended.resize(power.size(), 0.0);
  for (std::size_t k = 0; k < power.size(); ++k) state_->appended[k] += power[k];
}

void SpectrumAccumulator::exchange(StateBytes& bytes, std::size_t samples) {
  State& state = *state_;
  state.flush();
  if (!bytes.reading() && state.averaged > 0) {
    state.appended = state.power();
    std::vector<LaneReal>(state.sums.size()).swap(state.sums);
  }
  bytes(state.head);
  bytes(state.buffer);
  bytes(state.appended);
  bytes(state.averaged);
  bytes(state.full_batch_seen);
  const std::size_t half = state.half(), segment = state.options.segment;
  const std::size_t before = state.head_wanted == 0 ? 0 : state.head_wanted - half;
  const std::size_t from_buffer = samples < state.head_wanted ? 0 : samples - before;
  const std::size_t segments = from_buffer < segment ? 0 : from_buffer / half - 1;
  if (state.head.size() != std::min(samples, state.head_wanted) ||
      state.buffer.size() != from_buffer - segments * half || state.averaged > samples / half + 1 ||
      state.appended.size() != (state.averaged > 0 ? half + 1 : 0))
    bytes.fail();
}

Spectrum SpectrumAccumulator::finish() const {
  const State& state = *state_;
  const SpectrumOptions& options = state.options;
  Spectrum spectrum;
  spectrum.rate_hz = options.rate_hz;
  if (!state.full_batch_seen && state.buffer.size() < options.segment) {
    const std::size_t shorter = std::bit_floor(state.buffer.size());
    if (shorter < shortest_segment) return spectrum;
    SpectrumAccumulator whole({.rate_hz = options.rate_hz, .segment = shorter});
    whole.add(state.buffer);
    return whole.finish();
  }
  State last = state;
  if (last.complete() > 0) last.transform_segments();

  const auto length = static_cast<double>(options.segment);
  const double window_sum = 0.5 * length;
  spectrum.segment = options.segment;
  spectrum.averaged = last.averaged;
  spectrum.window_bandwidth_hz = options.rate_hz * last.window_power / (window_sum * window_sum);
  if (last.averaged == 0) return spectrum;
  spectrum.edf_per_bin = equivalent_degrees_of_freedom(last.averaged);
  spectrum.one_sided_psd = last.power();
  const double scale = 2.0 / (options.rate_hz * static_cast<double>(last.averaged));
  for (double& psd : spectrum.one_sided_psd) psd *= scale;
  spectrum.one_sided_psd.front() *= 0.5;
  spectrum.one_sided_psd.back() *= 0.5;
  for (std::size_t k = 0; k < spectrum.one_sided_psd.size(); ++k)
    spectrum.frequency_hz.push_back(static_cast<double>(k) * options.rate_hz / length);
  return spectrum;
}

Result<Spectrum> welch(View<double> series, const SpectrumOptions& options) {
  if (!is_valid(options))
    return Error{Errc::invalid_argument,
                 "a spectrum needs a positive rate and segments of a power of two, at least 16"};
  if (series.size() < shortest_segment)
    return Error{Errc::too_few_samples, "a spectrum needs at least 16 samples"};
  SpectrumAccumulator accumulator(options);
  accumulator.add(series);
  Spectrum spectrum = accumulator.finish();
  if (spectrum.averaged == 0)
    return Error{Errc::too_few_samples, "no segment of the series is half valid"};
  return spectrum;
}

}  // namespace proofmass::signal
