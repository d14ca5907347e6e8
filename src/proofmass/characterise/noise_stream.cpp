#include "proofmass/characterise/noise_stream.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <string>
#include <utility>

#include "proofmass/characterise/allan/averaging_times.hpp"
#include "proofmass/characterise/allan/deviation_curve.hpp"
#include "proofmass/characterise/allan/difference_variance.hpp"
#include "proofmass/characterise/noise/checks.hpp"
#include "proofmass/characterise/noise/notes.hpp"

namespace proofmass::characterise {
namespace {

// Points of the integral that a term may span at its level, in memory up to six times over.
constexpr std::size_t most_spacing = std::size_t{1} << 22;

bool overlaps(Statistic statistic) {
  return is_difference(statistic) && statistic != Statistic::adev && statistic != Statistic::hdev;
}

Error whole_only(const std::string& what, const std::string& instead) {
  return {Errc::invalid_argument,
          fmt::format("{} only of a recording that fits into memory: analyse a part, "
                      "or {}",
                      what, instead),
          {Advice{"from"}, Advice{"to"}}};
}

// Requested times may be any number of samples, including those not shortened by halving.
Status check_times(const NoiseOptions& options, std::size_t expected_samples) {
  if (options.taus.kind != TauGrid::Kind::given) return Done{};
  for (const double tau_s : options.taus.times_s) {
    const double factor = tau_s * options.rate_hz;
    if (!(factor >= 1.0) || !(factor < 1e15)) continue;
    const auto m = static_cast<std::size_t>(factor + 0.5);
    if (expected_samples > 0 && m > expected_samples) continue;
    if (m / DifferenceVariances::stride(options.statistic, m, least_decimated_overlap) >
        most_spacing)
      return whole_only(
          fmt::format("the deviation at just {:.6g} s, {} samples, is taken", tau_s, m),
          "choose octave or N-per-decade");
  }
  return Done{};
}

Status check_stream(const NoiseOptions& options, std::size_t expected_samples) {
  if (Status valid = check_options(options); !valid) return valid;
  if (!overlaps(options.statistic))
    return whole_only(fmt::format("the {} is taken", title_of(options.statistic)),
                      "choose oadev, mdev, tdev or ohdev");
  if (options.taus.kind == TauGrid::Kind::all)
    return whole_only("every τ is taken", "choose octave or N-per-decade");
  if (options.noise_type == NoiseTypeSource::lag1)
    return whole_only("noise types by lag 1 are found", "leave them to the model");
  if (options.exclude_events)
    return whole_only("outliers and steps are excluded", "analyse it with them");
  if (options.kind == SeriesKind::phase)
    return whole_only("phase data are analysed", "differentiate them first");
  return check_times(options, expected_samples);
}

}  // namespace

NoiseStream::NoiseStream(const NoiseOptions& options, std::size_t expected_samples)
    : options_(options), accumulator_(options, expected_samples) {}

Result<NoiseStream> NoiseStream::start(const NoiseOptions& options, std::size_t expected_samples) {
  if (Status possible = check_stream(options, expected_samples); !possible) return possible.error();
  return NoiseStream(options, expected_samples);
}

NoiseStream::NoiseStream(const NoiseOptions& options, const PartPlace& place)
    : options_(options),
      accumulator_(options, place),
      overview_(place.first),
      stationarity_(place.first, place.total) {}

Result<NoiseStream> NoiseStream::start_part(const NoiseOptions& options, const PartPlace& place) {
  if (Status possible = check_stream(options, place.total); !possible) return possible.error();
  return NoiseStream(options, place);
}

void NoiseStream::append(NoiseStream part) {
  overview_.append(part.overview_);
  accumulator_.append(std::move(part.accumulator_));
  stationarity_.append(part.stationarity_);
}

void NoiseStream::exchange(StateBytes& bytes) {
  accumulator_.exchange(bytes);
  if (!bytes.failed()) overview_.exchange(bytes);
  if (!bytes.failed()) stationarity_.exchange(bytes);
  if (overview_.samples() != accumulator_.samples() ||
      stationarity_.samples() != accumulator_.samples())
    bytes.fail();
}

void NoiseStream::add(View<double> samples) {
  overview_.add(samples);
  accumulator_.add(samples);
  stationarity_.add(samples);
}

Result<NoiseAnalysis> NoiseStream::finish(const StreamEnd& end) {
  NoiseOptions options = options_;
  if (end.rate_hz > 0.0) options.rate_hz = end.rate_hz;
  const std::size_t samples = overview_.samples();
  if (samples < fewest_noise_samples) return too_few_samples(samples);
  if (Status varies = overview_.check_spread(end.lsb); !varies) return varies.error();
  if (Status free = overview_.check_rails(end.lsb); !free) return free.error();
  accumulator_.set_rate(options.rate_hz);
  NoiseAnalysis analysis = accumulator_.finish_spectrum();
  const CurveVariances variances = accumulator_.variances();
  if (variances.factors.empty()) return no_time_fits(options, samples);
  analysis.deviation = deviation_curve(variances, analysis.model, {}, options);
  analysis.lsb = end.lsb;
  analysis.mean = overview_.mean();
  analysis.missing = overview_.missing();
  analysis.stationarity = stationarity_.finish(options.rate_hz, analysis.lines.lines);
  note_stationarity(analysis);
  note_missing(analysis, variances.left_out);
  analysis.notes.push_back(
      {Severity::warning,
       "outliers and steps were not searched for, and the stability of lines "
       "was not tested: the recording was analysed in pieces; both are possible for "
       "a part of it",
       {Advice{"from"}, Advice{"to"}}});
  note_resolution(analysis, overview_.short_term_std());
  note_model(analysis);
  return analysis;
}

}  // namespace proofmass::characterise
