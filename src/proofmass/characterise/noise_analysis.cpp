#include "proofmass/characterise/noise_analysis.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "proofmass/characterise/deviation_curve.hpp"
#include "proofmass/characterise/noise_accumulator.hpp"

namespace proofmass::characterise {
namespace {

constexpr std::size_t fewest_samples = 3;
// Evaluating every factor of a long record would take hours.
constexpr double most_work = 4e10;

Status check(View<double> series, const NoiseOptions& options) {
  if (!std::isfinite(options.rate_hz) || options.rate_hz <= 0.0)
    return Error{Errc::invalid_argument, "rate_hz must be positive and finite"};
  if (std::isnan(options.confidence) || options.confidence <= 0.0 || options.confidence >= 1.0)
    return Error{Errc::invalid_argument, "confidence must lie between 0 and 1"};
  if (options.noise_type == NoiseTypeSource::fixed && (options.alpha > 2 || options.alpha < -4))
    return Error{Errc::invalid_argument, "the noise type must be one of 2, 1, 0, -1, -2, -3, -4"};
  if (series.size() < fewest_samples)
    return Error{Errc::too_few_samples,
                 fmt::format("{} samples, expected at least {}", series.size(), fewest_samples)};
  if (options.taus.kind == TauGrid::Kind::all &&
      static_cast<double>(series.size()) * static_cast<double>(series.size()) / 4.0 > most_work)
    return Error{Errc::invalid_argument,
                 fmt::format("every τ of {} samples would take hours: ask for so many per decade, "
                             "or cut the recording",
                             series.size())};
  return Done{};
}

struct Overview {
  std::size_t missing = 0;
  double mean = 0.0;
  double short_term_std = 0.0;  ///< about the means of blocks short enough for drift not to count
  double low = std::numeric_limits<double>::infinity(), high = -low;
};

// One pass: sums over blocks, each about its first sample so that an offset takes no digits.
Overview overview_of(View<double> series) {
  constexpr std::size_t block = 64;
  Overview overview;
  double total = 0.0, squares = 0.0, freedom = 0.0;
  for (std::size_t from = 0; from < series.size(); from += block) {
    const View<double> part = series.subspan(from, std::min(block, series.size() - from));
    double first = 0.0, sum = 0.0, sum_of_squares = 0.0, count = 0.0;
    for (const double sample : part) {
      if (!std::isfinite(sample)) continue;
      if (count == 0.0) first = sample;
      const double departure = sample - first;
      sum += departure;
      sum_of_squares += departure * departure;
      count += 1.0;
      overview.low = std::min(overview.low, sample);
      overview.high = std::max(overview.high, sample);
    }
    overview.missing += part.size() - static_cast<std::size_t>(count);
    if (count < 1.0) continue;
    total += count * first + sum;
    squares += sum_of_squares - sum * sum / count;
    freedom += count - 1.0;
  }
  const auto present = static_cast<double>(series.size() - overview.missing);
  if (present > 0.0) overview.mean = total / present;
  if (freedom > 0.0) overview.short_term_std = std::sqrt(std::max(0.0, squares) / freedom);
  return overview;
}

// Noise of half a step is what still makes rounding a white noise of its own, of variance step²/12:
// B. Widrow, I. Kollár, Quantization Noise (2008), section 4.
Status check_spread(const Overview& overview, std::size_t samples, std::optional<double> lsb) {
  if (overview.missing == samples) return Error{Errc::not_finite, "no sample is a number"};
  const double spread = overview.short_term_std;
  if (!(spread > 0.0)) return Error{Errc::not_observable, "the samples do not vary"};
  // The likelihood divides by squares of squares.
  constexpr double least_spread = 1e-60, most_spread = 1e60;
  if (spread < least_spread || spread > most_spread)
    return Error{Errc::not_observable,
                 fmt::format("the samples spread by {:.3g}, expected {:g} to {:g}: bring them to "
                             "another unit",
                             spread, least_spread, most_spread)};
  if (!lsb) return Done{};
  const double added = *lsb * *lsb / 12.0, least = 0.25 * *lsb * *lsb;
  if (spread * spread - added >= least) return Done{};
  return Error{Errc::not_observable,
               fmt::format("the readings spread by {:.2f} steps of the converter, of which the "
                           "steps themselves make 0.29: noise below half a step cannot be told "
                           "from rounding: record with a finer converter or more gain",
                           spread / *lsb)};
}

// Noise thins out towards its extremes. Where the very last value comes up more often than all that
// lies beside it, the converter, or the sensor, could go no further.
Status check_rails(View<double> series, const Overview& overview, std::optional<double> lsb) {
  constexpr double beside_share = 0.02, times = 1.3;
  constexpr std::size_t fewest = 10;
  const double width =
      std::max(beside_share * (overview.high - overview.low), 1.01 * lsb.value_or(0.0));
  for (const double rail : {overview.low, overview.high}) {
    std::size_t at = 0, near = 0;
    for (const double sample : series) {
      at += sample == rail ? 1 : 0;
      near += std::abs(sample - rail) < width ? 1 : 0;
    }
    const auto beside = static_cast<double>(near - at);
    if (at < fewest || static_cast<double>(at) <= times * beside) continue;
    return Error{
        Errc::not_observable,
        fmt::format("clipped: {} of {} samples read exactly {:.6g}, the {} value there is: "
                    "what is cut off there is not in the figures",
                    at, series.size(), rail, rail == overview.low ? "lowest" : "highest")};
  }
  return Done{};
}

void note_resolution(NoiseAnalysis& analysis, double spread) {
  if (!analysis.lsb) return;
  const double density = *analysis.lsb / std::sqrt(12.0 * analysis.rate_hz);
  const bool coarse = spread < 2.0 * *analysis.lsb;
  const double white = analysis.model.white.value;
  std::string text =
      fmt::format("the converter's step is {:.2g} of the readings' spread", *analysis.lsb / spread);
  if (white > 0.0)
    text += fmt::format(": rounding alone has {:.0f} % of the density of the white noise found",
                        100.0 * density / white);
  analysis.notes.push_back({coarse ? Severity::warning : Severity::info, std::move(text)});
}

// Knocks and the edges of steps go missing. At a step the record is drawn apart, by a gap so long
// that no term and no transform reaches across: how high the step was need not be known.
std::vector<double> without_events(View<double> series,
                                   const std::vector<signal::Event>& events,
                                   double rate_hz) {
  std::vector<double> kept(series.begin(), series.end());
  signal::drop_events(kept, events, rate_hz);
  const std::size_t gap = series.size() / 16 + 1;
  std::vector<double> apart;
  std::size_t from = 0;
  const auto append = [&](std::size_t end) {
    apart.insert(apart.end(), kept.begin() + static_cast<std::ptrdiff_t>(from),
                 kept.begin() + static_cast<std::ptrdiff_t>(end));
    from = end;
  };
  for (const signal::Event& event : events) {
    if (event.kind != signal::EventKind::step) continue;
    append(event.first);
    apart.insert(apart.end(), gap, std::numeric_limits<double>::quiet_NaN());
  }
  append(kept.size());
  return apart;
}

std::string counted(std::size_t n, const char* noun) {
  return n == 0 ? std::string() : fmt::format("{} {}{}", n, noun, n == 1 ? "" : "s");
}

void note_events(NoiseAnalysis& analysis, bool excluded) {
  if (analysis.events.empty()) return;
  const auto steps = static_cast<std::size_t>(
      std::ranges::count(analysis.events, signal::EventKind::step, &signal::Event::kind));
  const std::size_t knocks = analysis.events.size() - steps;
  const std::string all =
      counted(knocks, "knock") + (knocks > 0 && steps > 0 ? " and " : "") + counted(steps, "step");
  if (excluded) {
    analysis.notes.push_back({Severity::warning, all + " left out of everything"});
    return;
  }
  const bool one = analysis.events.size() == 1;
  analysis.notes.push_back(
      {Severity::warning,
       fmt::format("{0} {1} in the figures, and {1} no noise of the sensor: leave {2} out with "
                   "--exclude-events",
                   all, one ? "is" : "are", one ? "it" : "them")});
}

void note_missing(NoiseAnalysis& analysis, std::size_t left_out) {
  if (left_out > analysis.samples / 100)
    analysis.notes.push_back(
        {Severity::warning,
         fmt::format("this statistic needs one piece without gaps: {} of {} samples are left out",
                     left_out, analysis.samples)});
  if (analysis.missing == 0) return;
  const double share =
      static_cast<double>(analysis.missing) / static_cast<double>(analysis.samples);
  analysis.notes.push_back(
      {share > 0.05 ? Severity::warning : Severity::info,
       fmt::format("{} of {} samples are missing: the deviation counts the terms that are complete",
                   analysis.missing, analysis.samples)});
}

void note_model(NoiseAnalysis& analysis) {
  const NoiseModelFit& model = analysis.model;
  if (model.ordinates == 0) {
    analysis.notes.push_back(
        {Severity::warning, "too short for coefficients: limits are those of white noise"});
    return;
  }
  if (model.misfit > 0.0)
    analysis.notes.push_back(
        {Severity::info, fmt::format("the spectrum departs from the model by {:.0f} % beyond its "
                                     "scatter; standard deviations are widened for it",
                                     100.0 * model.misfit)});
  const auto ambiguous = [](const Coefficient& c) {
    return c.verdict == Verdict::identified && c.lower_95 == 0.0;
  };
  if (ambiguous(model.random_walk) || ambiguous(model.flicker))
    analysis.notes.push_back(
        {Severity::warning,
         "there is slow noise beyond the white, but this recording is too short to tell flicker "
         "from random walk: the simpler reading is given, its interval reaches down to zero"});
}

}  // namespace

Result<NoiseAnalysis> analyse_noise(View<double> series, const NoiseOptions& options) {
  if (Status checked = check(series, options); !checked) return checked.error();
  std::vector<double> changed, apart;
  if (options.kind == SeriesKind::phase) {
    changed.resize(series.size() - 1);
    for (std::size_t k = 0; k < changed.size(); ++k)
      changed[k] = (series[k + 1] - series[k]) * options.rate_hz;
    series = changed;
  }
  const Overview raw = overview_of(series);
  if (Status varies = check_spread(raw, series.size(), options.lsb); !varies) return varies.error();
  if (Status free = check_rails(series, raw, options.lsb); !free) return free.error();
  View<double> used = series;
  if (options.progress) options.progress("knocks and steps", 0.0);
  std::vector<signal::Event> events = signal::find_events(series, {.rate_hz = options.rate_hz});
  if (options.exclude_events && !events.empty()) {
    apart = without_events(series, events, options.rate_hz);
    used = apart;
  }
  if (options.progress) options.progress("spectrum and deviations", 0.4);
  NoiseAccumulator accumulator(options, series.size());
  accumulator.add(used);
  NoiseAnalysis analysis = accumulator.finish_spectrum();
  analysis.samples = series.size();
  analysis.duration_s = static_cast<double>(series.size()) / options.rate_hz;
  const CurveVariances variances = is_difference(options.statistic)
                                       ? accumulator.variances()
                                       : whole_record_variances(used, options);
  if (variances.factors.empty())
    return Error{
        options.taus.kind == TauGrid::Kind::given ? Errc::invalid_argument : Errc::too_few_samples,
        fmt::format("no averaging time fits: {} samples of {:.6g} s, of which the {} needs "
                    "two or three times τ",
                    series.size(), 1.0 / options.rate_hz, title_of(options.statistic))};
  analysis.deviation = deviation_curve(variances, analysis.model, used, options);
  analysis.lsb = options.lsb;
  const Overview kept = overview_of(used);
  analysis.mean = kept.mean;
  analysis.missing = kept.missing - (used.size() - series.size());
  analysis.events = std::move(events);
  note_missing(analysis, variances.left_out);
  note_events(analysis, options.exclude_events);
  note_resolution(analysis, raw.short_term_std);
  note_model(analysis);
  if (options.progress) options.progress("done", 1.0);
  return analysis;
}

}  // namespace proofmass::characterise
