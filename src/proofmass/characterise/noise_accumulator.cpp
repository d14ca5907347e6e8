#include "proofmass/characterise/noise_accumulator.hpp"

#include <algorithm>
#include <utility>

#include "proofmass/characterise/allan/averaging_times.hpp"
#include "proofmass/characterise/noise_fit.hpp"
#include "proofmass/core/in_parallel.hpp"

namespace proofmass::characterise {
namespace {

// Assumed length of a recording of unknown length: three thousand years at a kilohertz.
constexpr std::size_t any_length = std::size_t{1} << 46;
// Minimum number of segments in an averaged spectrum, as long as these have 64 samples.
constexpr std::size_t segments_wanted = 16, shortest_segment = 64;
// Short enough that the data stay in the cache from one accumulator to the next.
constexpr std::size_t chunk = 8192;

std::size_t segment_for(std::size_t samples, std::size_t longest) {
  std::size_t segment = longest;
  while (segment > shortest_segment && samples / segment < segments_wanted) segment /= 2;
  return segment;
}

std::size_t overlap_for(std::size_t samples) {
  return samples <= decimate_above ? DifferenceVariances::full_overlap : least_decimated_overlap;
}

std::vector<std::size_t> factors_for(const NoiseOptions& options, std::size_t samples) {
  if (!is_difference(options.statistic)) return {};
  return averaging_factors(options.taus, options.statistic, samples, 1.0 / options.rate_hz);
}

// A spectrum computed for another rate.
signal::Spectrum at_rate(signal::Spectrum spectrum, double rate_hz) {
  if (spectrum.rate_hz == rate_hz) return spectrum;
  const double scale = rate_hz / spectrum.rate_hz;
  spectrum.rate_hz = rate_hz;
  spectrum.window_bandwidth_hz *= scale;
  for (double& frequency_hz : spectrum.frequency_hz) frequency_hz *= scale;
  for (double& psd : spectrum.one_sided_psd) psd /= scale;
  return spectrum;
}

}  // namespace

NoiseAccumulator::NoiseAccumulator(const NoiseOptions& options, std::size_t expected_samples)
    : options_(options),
      least_overlap_(overlap_for(expected_samples > 0 ? expected_samples : any_length)),
      factors_(factors_for(options, expected_samples > 0 ? expected_samples : any_length)),
      differences_(is_difference(options.statistic) ? options.statistic : Statistic::oadev,
                   factors_,
                   least_overlap_),
      spectrum_({.rate_hz = options.rate_hz,
                 .segment = segment_for(expected_samples > 0 ? expected_samples : any_length,
                                        options.segment)}),
      slow_(options.rate_hz) {}

NoiseAccumulator::NoiseAccumulator(const NoiseOptions& options, const PartPlace& place)
    : options_(options),
      least_overlap_(least_decimated_overlap),
      factors_(factors_for(options, any_length)),
      differences_(
          options.statistic,
          factors_,
          least_overlap_,
          static_cast<std::ptrdiff_t>(place.first) - static_cast<std::ptrdiff_t>(place.origin)),
      spectrum_({.rate_hz = options.rate_hz, .segment = options.segment}, place.first),
      slow_(options.rate_hz, place.first, place.total) {}

void NoiseAccumulator::append(NoiseAccumulator part) {
  samples_ += part.samples_;
  differences_.append(std::move(part.differences_));
  spectrum_.append(part.spectrum_);
  slow_.append(part.slow_);
}

void NoiseAccumulator::exchange(StateBytes& bytes) {
  bytes(samples_);
  constexpr std::size_t most_samples = std::size_t{1} << 48;
  if (samples_ > most_samples) return bytes.fail();
  differences_.exchange(bytes, samples_);
  if (!bytes.failed()) spectrum_.exchange(bytes, samples_);
  if (!bytes.failed()) slow_.exchange(bytes, samples_);
}

void NoiseAccumulator::add(View<double> samples) {
  const auto in_chunks = [&](const auto& add_chunk) {
    for (std::size_t from = 0; from < samples.size(); from += chunk)
      add_chunk(samples.subspan(from, std::min(chunk, samples.size() - from)));
  };
  run_tasks(samples.size(), {[&] {
                               if (!factors_.empty())
                                 in_chunks([&](View<double> part) { differences_.add(part); });
                             },
                             [&] {
                               in_chunks([&](View<double> part) {
                                 spectrum_.add(part);
                                 slow_.add(part);
                               });
                             }});
  samples_ += samples.size();
}

void NoiseAccumulator::set_rate(double rate_hz) {
  options_.rate_hz = rate_hz;
  slow_.set_rate(rate_hz);
}

NoiseAnalysis NoiseAccumulator::finish_spectrum() const {
  NoiseAnalysis analysis;
  analysis.rate_hz = options_.rate_hz;
  analysis.samples = samples_;
  analysis.duration_s = static_cast<double>(samples_) / options_.rate_hz;
  analysis.spectrum = at_rate(spectrum_.finish(), options_.rate_hz);
  if (analysis.spectrum.averaged == 0) return analysis;
  analysis.lines = signal::find_lines(analysis.spectrum);
  auto model = fit_noise_model({slow_, analysis.spectrum, analysis.lines, analysis.duration_s});
  if (model) analysis.model = std::move(model).value();
  return analysis;
}

CurveVariances NoiseAccumulator::variances() const {
  CurveVariances curve;
  curve.phase_points = samples_ + 1;
  curve.least_overlap = least_overlap_;
  // The factors may have been chosen for a longer recording.
  const TauGrid& taus = options_.taus;
  const double ratio =
      taus.stop_ratio > 0.0 ? taus.stop_ratio : default_stop_ratio(options_.statistic);
  const auto longest = static_cast<std::size_t>(static_cast<double>(samples_) / ratio);
  const std::vector<PhaseVariance> variances = differences_.finish();
  for (std::size_t k = 0; k < factors_.size(); ++k) {
    const bool asked_for = taus.kind == TauGrid::Kind::given || factors_[k] <= longest;
    if (!asked_for || variances[k].terms == 0) continue;
    curve.factors.push_back(factors_[k]);
    curve.variances.push_back(variances[k]);
  }
  return curve;
}

NoiseAnalysis NoiseAccumulator::finish() const {
  NoiseAnalysis analysis = finish_spectrum();
  analysis.deviation = deviation_curve(variances(), analysis.model, {}, options_);
  return analysis;
}

}  // namespace proofmass::characterise
