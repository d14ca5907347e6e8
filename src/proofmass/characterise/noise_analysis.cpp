#include "proofmass/characterise/noise_analysis.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "proofmass/characterise/allan/deviation_curve.hpp"
#include "proofmass/characterise/noise/checks.hpp"
#include "proofmass/characterise/noise/notes.hpp"
#include "proofmass/characterise/noise/parts.hpp"
#include "proofmass/characterise/noise_accumulator.hpp"
#include "proofmass/characterise/record_overview.hpp"
#include "proofmass/core/in_parallel.hpp"

namespace proofmass::characterise {
namespace {

// Evaluating every factor of a long record would take hours.
constexpr double most_work = 4e10;

Status check(View<double> series, const NoiseOptions& options) {
  if (Status valid = check_options(options); !valid) return valid;
  if (series.size() < fewest_noise_samples) return too_few_samples(series.size());
  if (options.taus.kind == TauGrid::Kind::all &&
      static_cast<double>(series.size()) * static_cast<double>(series.size()) / 4.0 > most_work)
    return Error{Errc::invalid_argument,
                 fmt::format("every τ of {} samples would take hours: use N-per-decade, "
                             "or cut the recording",
                             series.size())};
  return Done{};
}

// Shocks and the edges of steps are marked missing. At a step the record is split by a gap so long
// that no term and no transform spans it: the step's height need not be known.
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

// The passes over a series, side by side where they are independent: over all of it, and over what
// is analysed of it, which may be without events.
class Passes {
 public:
  Passes(View<double> series, const NoiseOptions& options)
      : accumulator(options, series.size()), used(series), series_(series), options_(options) {}

  // Errors: those of RecordOverview's checks.
  Status run() {
    const auto look = [&] { overview.add(series_); };
    const auto find_events = [&] {
      events = signal::find_events(series_, {.rate_hz = options_.rate_hz});
    };
    const auto accumulate = [&] { accumulator.add(used); };
    const auto follow_level = [&] { level_.add(used); };
    const auto fit_model = [&] {
      analysis = accumulator.finish_spectrum();
      analysis.stationarity =
          test_stationarity(level_, used, options_.rate_hz, analysis.lines.lines);
    };
    report("outliers and steps", 0.0);
    if (options_.exclude_events)
      run_tasks(series_.size(), {find_events, look});
    else
      run_tasks(series_.size(), {accumulate, look});
    if (Status varies = overview.check_spread(options_.lsb); !varies) return varies;
    if (Status free = overview.check_rails(options_.lsb); !free) return free;
    short_term_std = overview.short_term_std();
    report("spectrum and deviations", 0.4);
    if (!options_.exclude_events) {
      run_tasks(series_.size(), {find_events, [&] {
                                   follow_level();
                                   fit_model();
                                 }});
      return Done{};
    }
    if (!events.empty()) {
      apart_ = without_events(series_, events, options_.rate_hz);
      used = apart_;
    }
    overview = RecordOverview();
    run_tasks(used.size(), {accumulate, follow_level, [&] { overview.add(used); }});
    fit_model();
    return Done{};
  }

  NoiseAnalysis analysis;   // spectrum, lines, model and stationarity
  RecordOverview overview;  // of `used`
  std::vector<signal::Event> events;
  NoiseAccumulator accumulator;
  double short_term_std = 0.0;  // of the whole series
  View<double> used;            // the series, or what is kept of it

 private:
  void report(const char* stage, double fraction) const {
    if (options_.progress) options_.progress(stage, fraction);
  }

  StationarityTest level_;
  View<double> series_;
  const NoiseOptions& options_;
  std::vector<double> apart_;
};

}  // namespace

Result<NoiseAnalysis> analyse_noise(View<double> series, const NoiseOptions& options) {
  if (Status checked = check(series, options); !checked) return checked.error();
  std::vector<double> changed;
  if (options.kind == SeriesKind::phase) {
    changed.resize(series.size() - 1);
    for (std::size_t k = 0; k < changed.size(); ++k)
      changed[k] = (series[k + 1] - series[k]) * options.rate_hz;
    series = changed;
  }
  Passes passes(series, options);
  if (Status usable = passes.run(); !usable) return usable.error();
  const View<double> used = passes.used;
  NoiseAnalysis analysis = std::move(passes.analysis);
  if (!analysis.stationarity.stationary) {
    analysis.parts = noise_of_parts(used, options);
    widen_to_parts(analysis.parts, analysis.model);
  }
  if (!options.exclude_events && !passes.events.empty() && analysis.model.ordinates > 0) {
    const std::vector<double> without = without_events(used, passes.events, options.rate_hz);
    NoiseAccumulator accumulator(options, without.size());
    accumulator.add(without);
    widen_to_fit_without_events(accumulator.finish_spectrum().model, analysis.model);
  }
  analysis.samples = series.size();
  analysis.duration_s = static_cast<double>(series.size()) / options.rate_hz;
  const CurveVariances variances = is_difference(options.statistic)
                                       ? passes.accumulator.variances()
                                       : whole_record_variances(used, options);
  if (variances.factors.empty()) return no_time_fits(options, series.size());
  analysis.deviation = deviation_curve(variances, analysis.model, used, options);
  analysis.lsb = options.lsb;
  analysis.mean = passes.overview.mean();
  analysis.missing = passes.overview.missing() - (used.size() - series.size());
  analysis.events = std::move(passes.events);
  note_stationarity(analysis);
  note_missing(analysis, variances.left_out);
  note_events(analysis, options.exclude_events);
  note_resolution(analysis, passes.short_term_std);
  note_model(analysis);
  if (options.progress) options.progress("done", 1.0);
  return analysis;
}

}  // namespace proofmass::characterise
