#include "proofmass/estimate/track/settle.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "proofmass/estimate/track/hypotheses.hpp"

namespace proofmass::estimate {
namespace {

constexpr double long_rest_s = 1.0;

double length_s(const TrackSignal& signal, const signal::Rest& rest) {
  return signal.time_s[rest.last] - signal.time_s[rest.first];
}

bool is_rest(QuietStretch stretch) {
  return stretch == QuietStretch::rest;
}

std::vector<signal::Rest> stops_of(const std::vector<signal::Rest>& stops,
                                   const StopHypothesis& hypothesis) {
  std::vector<signal::Rest> rests;
  for (std::size_t i = 0; i < stops.size(); ++i)
    if (is_rest(hypothesis.stretches[i])) rests.push_back(stops[i]);
  return rests;
}

// Probability, over the alternatives, that the displacement equals that of the first.
double probability_of_first(const std::vector<TrackAlternative>& alternatives) {
  constexpr double same = 2.0;  // standard deviations
  const Uncertain& first = alternatives.front().displacement_m;
  double sum = 0.0;
  for (const TrackAlternative& one : alternatives)
    if (std::abs(one.displacement_m.value - first.value) <
        same * std::hypot(one.displacement_m.std, first.std))
      sum += one.probability;
  return sum;
}

// Displacement for each interpretation of the quiet intervals.
std::vector<TrackAlternative> alternatives_of(TrackSignal signal,
                                              const std::vector<StopHypothesis>& hypotheses,
                                              const TrackOptions& options) {
  constexpr std::size_t most = 4;
  constexpr double least_probability = 0.02;
  const std::vector<signal::Rest> all = signal.stops.rests;
  std::vector<TrackAlternative> alternatives;
  for (const StopHypothesis& hypothesis : hypotheses) {
    if (hypothesis.probability < least_probability || alternatives.size() == most) break;
    std::vector<TimeSpan> no_rests;
    for (std::size_t i = 0; i < all.size(); ++i)
      if (!is_rest(hypothesis.stretches[i]))
        no_rests.push_back({signal.time_s[all[i].first], signal.time_s[all[i].last]});
    // Whether an interval is a cruise or a plateau makes no difference to the displacement.
    const auto same = std::ranges::find_if(alternatives, [&](const TrackAlternative& one) {
      return std::ranges::equal(one.no_rests, no_rests, {}, &TimeSpan::start_s, &TimeSpan::start_s);
    });
    if (same != alternatives.end()) {
      same->probability += hypothesis.probability;
      continue;
    }
    signal.stops.rests = stops_of(all, hypothesis);
    const auto solved = solve(signal, options);
    if (!solved) continue;
    TrackAlternative& alternative = alternatives.emplace_back();
    alternative.probability = hypothesis.probability;
    alternative.no_rests = std::move(no_rests);
    const Gaussian<3>& end = solved->pass.smoothed.back();
    alternative.displacement_m = {end.mean(inertial_axis::position_m), std::sqrt(end.cov(0, 0))};
  }
  return alternatives;
}

// Whether the measurements resemble jerk without the loud and the short stops; if so, these are
// removed.
bool leaves_jerk(TrackSignal& signal, const TrackOptions& options, Result<AlongAxis>& solved) {
  if (options.take_as_acceleration || signal.gravity == GravityContent::present) return false;
  TrackSignal quiet = signal;
  quiet.stops.rests = quiet_rests(signal);
  std::erase_if(quiet.stops.rests, [&](const signal::Rest& rest) {
    return length_s(signal, rest) < long_rest_s;  // may be quiet by chance
  });
  quiet.stops.cruises = signal.stops.rests.size() - quiet.stops.rests.size();
  auto found = solve(quiet, options);
  if (!found) return false;
  TrackSolution solution = described(quiet, options);
  solution.series.accel_mps2 = found->accel_mps2;
  fill_series(quiet, found->run, found->pass, solution);
  if (!suspect_jerk(quiet, solution.series).suspected) return false;
  signal = std::move(quiet);
  solved = std::move(found);
  return true;
}

}  // namespace

void keep_ends_of_rest(TrackSignal& signal) {
  constexpr double nearly_all = 0.95, longest_end_s = 2.0;
  const double all_s = signal.time_s.back() - signal.time_s.front();
  if (signal.stops.quiet_s < nearly_all * all_s) return;
  const double end_s = std::min(longest_end_s, 0.25 * all_s);
  const std::size_t n = signal.time_s.size();
  const std::size_t first = sample_at(signal.time_s, signal.time_s.front() + end_s),
                    last = sample_at(signal.time_s, signal.time_s.back() - end_s);
  if (first == 0 || last + 1 >= n || first >= last) return;
  signal.stops.rests = {{0, first}, {last, n - 1}};
  signal.stops.only_ends = true;
}

std::size_t drop_belied_rests(TrackSignal& signal,
                              View<double> accel,
                              const TrackOptions& options) {
  auto& rests = signal.stops.rests;
  const std::vector<signal::Rest> all = rests;
  const auto is_short = [&](const signal::Rest& rest) {
    return length_s(signal, rest) < long_rest_s;
  };
  std::erase_if(rests, is_short);
  if (rests.size() == all.size() || rests.size() < 2) {
    rests = all;
    return 0;
  }
  const auto knots_of = [&](const AxisRun& run) {
    return join_epochs(run.made.epochs, run.made.knots);
  };
  AxisRun run = prepare_axis(signal, accel, readings_of(signal, options), {});
  const MotionError error = motion_error(knots_of(run), run.noise, run.start);
  rests = all;
  constexpr double unbelievable = 27.6;  // χ² of two degrees of freedom, p = 1e-6
  while (true) {
    run = prepare_axis(signal, accel, readings_of(signal, options), {});
    run.noise.motion_walk_m2ps5 = error.walk_m2ps5;
    run.noise.motion_jump_m2ps4 = error.jump_m2ps4;
    run.noise.motion_lean_m2ps3 = error.lean_m2ps3;
    const std::vector<double> surprise = surprise_of_rests(knots_of(run), run.noise, run.start);
    std::optional<std::size_t> worst;
    for (std::size_t i = 0; i < rests.size(); ++i)
      if (is_short(rests[i]) &&
          surprise[i] > std::max(unbelievable, worst ? surprise[*worst] : 0.0))
        worst = i;
    if (!worst) return all.size() - rests.size();
    rests.erase(rests.begin() + static_cast<std::ptrdiff_t>(*worst));
  }
}

std::vector<TrackAlternative> settle_stops(TrackSignal& signal,
                                           const TrackOptions& options,
                                           Result<AlongAxis>& solved) {
  constexpr double clear = 0.95;
  std::vector<TrackAlternative> alternatives;
  const auto hypotheses = stop_hypotheses(signal, solved->run, solved->closures);
  if (hypotheses.empty()) {
    signal.stops.too_many_in_doubt = true;
    return alternatives;
  }
  const StopHypothesis& likeliest = hypotheses.front();
  const bool all_rest = hypotheses.size() == 1 && std::ranges::all_of(likeliest.stretches, is_rest);
  const bool some_are_loud = quiet_rests(signal).size() < signal.stops.rests.size();
  if ((!all_rest || some_are_loud) && leaves_jerk(signal, options, solved)) return alternatives;
  if (likeliest.probability < clear) {
    alternatives = alternatives_of(signal, hypotheses, options);
    if (alternatives.empty() || probability_of_first(alternatives) >= clear) alternatives.clear();
  }
  const auto count = [&](QuietStretch kind) {
    return static_cast<std::size_t>(std::ranges::count(likeliest.stretches, kind));
  };
  if (count(QuietStretch::rest) == likeliest.stretches.size()) return alternatives;
  signal.stops.cruises = count(QuietStretch::cruise);
  signal.stops.plateaus += count(QuietStretch::plateau);
  signal.stops.rests = stops_of(signal.stops.rests, likeliest);
  solved = solve(signal, options);
  return alternatives;
}

}  // namespace proofmass::estimate
