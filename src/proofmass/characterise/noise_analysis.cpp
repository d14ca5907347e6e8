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
  View<double> used = series;
  RecordOverview raw, kept;
  std::vector<signal::Event> events;
  NoiseAccumulator accumulator(options, series.size());
  StationarityTest differences;
  const auto look = [&] { raw.add(series); };
  const auto find_events = [&] {
    events = signal::find_events(series, {.rate_hz = options.rate_hz});
  };
  const auto accumulate = [&] { accumulator.add(used); };
  const auto follow_level = [&] { differences.add(used); };
  if (options.progress) options.progress("outliers and steps", 0.0);
  if (options.exclude_events)
    run_tasks(series.size(), {find_events, look});
  else
    run_tasks(series.size(), {accumulate, find_events, follow_level, look});
  if (Status varies = raw.check_spread(options.lsb); !varies) return varies.error();
  if (Status free = raw.check_rails(options.lsb); !free) return free.error();
  if (options.progress) options.progress("spectrum and deviations", 0.4);
  if (options.exclude_events) {
    if (!events.empty()) {
      apart = without_events(series, events, options.rate_hz);
      used = apart;
    }
    run_tasks(used.size(), {accumulate, follow_level, [&] { kept.add(used); }});
  }
  NoiseAnalysis analysis = accumulator.finish_spectrum();
  analysis.stationarity =
      test_stationarity(differences, used, options.rate_hz, analysis.lines.lines);
  if (!analysis.stationarity.stationary) {
    analysis.parts = noise_of_parts(used, options);
    widen_to_parts(analysis.parts, analysis.model);
  }
  analysis.samples = series.size();
  analysis.duration_s = static_cast<double>(series.size()) / options.rate_hz;
  const CurveVariances variances = is_difference(options.statistic)
                                       ? accumulator.variances()
                                       : whole_record_variances(used, options);
  if (variances.factors.empty()) return no_time_fits(options, series.size());
  analysis.deviation = deviation_curve(variances, analysis.model, used, options);
  analysis.lsb = options.lsb;
  const RecordOverview& counted = options.exclude_events ? kept : raw;
  analysis.mean = counted.mean();
  analysis.missing = counted.missing() - (used.size() - series.size());
  analysis.events = std::move(events);
  note_stationarity(analysis);
  note_missing(analysis, variances.left_out);
  note_events(analysis, options.exclude_events);
  note_resolution(analysis, raw.short_term_std());
  note_model(analysis);
  if (options.progress) options.progress("done", 1.0);
  return analysis;
}

}  // namespace proofmass::characterise
