#include "proofmass/estimate/track/hypotheses.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

#include "proofmass/estimate/track/motion_noise.hpp"

namespace proofmass::estimate {
namespace {

double log_normal_density(double x, double std) {
  return -0.5 * (x * x / (std * std) + std::log(2.0 * std::numbers::pi * std * std));
}

/// Density of the logarithm of an interval's noise over that of the quietest.
double log_loudness_density(double log_ratio, QuietStretch kind) {
  constexpr double same_std = 0.1;
  const bool rests = kind == QuietStretch::rest;
  const double same = rests ? 0.75 : 0.3, louder_std = rests ? 0.5 : 0.8;
  return std::log(same * std::exp(log_normal_density(log_ratio, same_std)) +
                  (1.0 - same) * 2.0 * std::exp(log_normal_density(log_ratio, louder_std)));
}

/// Prior of the types of all intervals. The first and the last are rests 999 times in 1000. The
/// fraction of the others that are not rests has a beta distribution with mean 0.1, since it is
/// large in a recording of slow motion; the counts are then beta-binomial.
double log_prior(const std::vector<QuietStretch>& kinds) {
  constexpr double none_at_an_end = 1e-3, none = 0.5, rest = 4.5;
  double log = 0.0, rests = rest, others = none;
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    const bool is_rest = kinds[i] == QuietStretch::rest;
    if (i == 0 || i + 1 == kinds.size()) {
      log += std::log(is_rest ? 1.0 - none_at_an_end : none_at_an_end);
      continue;
    }
    double& count = is_rest ? rests : others;
    log += std::log(count / (rests + others));
    count += 1.0;
  }
  return log;
}

/// Knots of one stretch: that of the arrival, and those on the way through.
struct StretchKnots {
  std::size_t arrival = 0, first = 0, end = 0;
  double level_mps2 = 0.0, level_std_mps2 = 0.0;
};

std::vector<StretchKnots> stretches_in(const std::vector<InertialEpoch>& knots) {
  std::vector<StretchKnots> found;
  for (std::size_t k = 0; k + 1 < knots.size(); ++k) {
    if (knots[k].resting || !knots[k + 1].resting) continue;
    StretchKnots stretch{k, k + 1, k + 1};
    double weight = 0.0, sum = 0.0;
    for (; stretch.end < knots.size() && knots[stretch.end].resting; ++stretch.end) {
      const InertialEpoch& knot = knots[stretch.end];
      if (std::isnan(knot.level_mps2)) continue;
      weight += 1.0 / knot.level_variance;
      sum += knot.level_mps2 / knot.level_variance;
    }
    stretch.level_mps2 = weight > 0.0 ? sum / weight : 0.0;
    stretch.level_std_mps2 = weight > 0.0 ? 1.0 / std::sqrt(weight) : 1.0;
    found.push_back(stretch);
  }
  return found;
}

/// What an interval may be instead of a rest: in a cruise its level equals that of a neighbour up
/// to a change of the bias, and on a plateau it differs from one.
std::vector<std::vector<QuietStretch>> kinds_besides_rest(
    const std::vector<StretchKnots>& stretches) {
  constexpr double bias_change_mps2 = 0.02;
  std::vector<std::vector<QuietStretch>> kinds(stretches.size(), {QuietStretch::cruise});
  for (std::size_t i = 1; i + 1 < stretches.size(); ++i) {
    const auto beyond_noise_mps2 = [&](std::size_t j) {
      return std::abs(stretches[i].level_mps2 - stretches[j].level_mps2) -
             5.0 * std::hypot(stretches[i].level_std_mps2, stretches[j].level_std_mps2);
    };
    const auto [nearest_mps2, farthest_mps2] =
        std::minmax({beyond_noise_mps2(i - 1), beyond_noise_mps2(i + 1)});
    if (nearest_mps2 > bias_change_mps2) kinds[i].clear();
    if (farthest_mps2 > 0.0) kinds[i].push_back(QuietStretch::plateau);
  }
  return kinds;
}

void make_cruise(const StretchKnots& stretch,
                 double speed_std_mps,
                 std::vector<InertialEpoch>& knots) {
  knots[stretch.arrival].velocity_std_mps = speed_std_mps;
  for (std::size_t k = stretch.first; k < stretch.end; ++k) knots[k].cruising = true;
}

/// Integrates the measurements instead of using them as bias measurements; returns the log density
/// about a level of their own, for as many as without_middles() keeps of a rest. Like that of a
/// rest the level may drift.
double make_plateau(const StretchKnots& stretch,
                    double walk_m2ps5,
                    std::vector<InertialEpoch>& knots) {
  constexpr double slow_mps2 = 0.05, usual_mps2 = 0.5;
  constexpr std::size_t counted = 6;
  double log_density = std::log(0.5 * std::exp(log_normal_density(stretch.level_mps2, slow_mps2)) +
                                0.5 * std::exp(log_normal_density(stretch.level_mps2, usual_mps2)));
  knots[stretch.arrival].velocity_std_mps = std::numeric_limits<double>::quiet_NaN();
  knots[stretch.arrival].arrives_at_rest = false;
  double walked_m2ps4 = 0.0;
  for (std::size_t k = stretch.first; k < stretch.end; ++k) {
    InertialEpoch& knot = knots[k];
    walked_m2ps4 += walk_m2ps5 * knot.dt_s;
    const double level = std::isnan(knot.level_mps2) ? stretch.level_mps2 : knot.level_mps2;
    if (k > stretch.first && k < stretch.first + counted && knot.level_variance > 0.0)
      log_density += log_normal_density(level - stretch.level_mps2,
                                        std::sqrt(knot.level_variance + walked_m2ps4));
    knot.resting = false;
    knot.velocity_step_mps = level * knot.dt_s;
    knot.position_step_m = 0.5 * level * knot.dt_s * knot.dt_s;
    knot.level_mps2 = std::numeric_limits<double>::quiet_NaN();
  }
  if (stretch.end < knots.size()) knots[stretch.end].leaves_rest = false;
  return log_density;
}

/// Log evidence of the measurements, given the type of each interval.
double log_evidence_of(const std::vector<QuietStretch>& kinds,
                       const std::vector<StretchKnots>& stretches,
                       const std::vector<InertialEpoch>& knots,
                       const AxisRun& run) {
  const bool cruises = std::ranges::find(kinds, QuietStretch::cruise) != kinds.end();
  const std::vector<double> speeds_mps =
      cruises ? std::vector{0.03, 0.3, 3.0, 30.0} : std::vector{0.0};
  std::vector<double> logs;
  for (const double speed_mps : speeds_mps) {
    std::vector<InertialEpoch> labelled = knots;
    double log_density = 0.0;
    for (std::size_t i = 0; i < kinds.size(); ++i) {
      if (kinds[i] == QuietStretch::cruise) make_cruise(stretches[i], speed_mps, labelled);
      if (kinds[i] == QuietStretch::plateau)
        log_density += make_plateau(stretches[i], run.noise.rest_walk_m2ps5, labelled);
    }
    logs.push_back(log_density + log_evidence(without_middles(labelled), run.noise, run.start));
  }
  const double best = std::ranges::max(logs);
  double sum = 0.0;
  for (const double one : logs) sum += std::exp(one - best);
  return best + std::log(sum / static_cast<double>(logs.size()));
}

constexpr std::size_t most_doubtful = 16;

/// Fraction of the highest speed that remains at the end of each motion, by the interval at which
/// it arrives; 0 if the noise at rest explains it.
std::vector<double> speed_left_over(const std::vector<Closure>& closures,
                                    const std::vector<InertialEpoch>& knots,
                                    const AxisRun& run,
                                    std::size_t stretches) {
  constexpr double far = 5.0;
  InertialNoise white = run.noise;
  white.motion_walk_m2ps5 = white.rest_walk_m2ps5 = 0.0;
  white.motion_jump_m2ps4 = white.motion_lean_m2ps3 = 0.0;
  ConsistencyCheck unused({.channels = {"position", "velocity", "level"}});
  const std::vector<Closure> expected = estimate::closures(knots, white, run.start, unused);
  std::vector<double> left(stretches, 0.0);
  for (std::size_t i = 0; i < closures.size(); ++i) {
    const double speed = std::abs(closures[i].velocity_mps);
    if (speed > far * expected[i].expected_std_mps)
      left[stretches - closures.size() + i] = speed / std::max(speed, closures[i].fastest_mps);
  }
  return left;
}

/// The intervals before and after a motion at whose end speed remains.
std::vector<std::size_t> doubtful(const std::vector<double>& left_over) {
  constexpr double share = 0.25;
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < left_over.size(); ++i)
    if (left_over[i] > share || (i + 1 < left_over.size() && left_over[i + 1] > share))
      found.push_back(i);
  return found;
}

/// A motion between two rests gains speed and loses it. If its highest speed is the one that
/// remains at its end, only a tilt without motion explains it, which is less likely.
double log_prior_of_tilts(const std::vector<QuietStretch>& kinds,
                          const std::vector<double>& left_over) {
  constexpr double all = 0.75, only_tilted = 0.2;
  double log = 0.0;
  for (std::size_t i = 1; i < kinds.size(); ++i)
    if (kinds[i - 1] == QuietStretch::rest && kinds[i] == QuietStretch::rest && left_over[i] > all)
      log += std::log(only_tilted);
  return log;
}

/// A combination: for each candidate 0 for a rest, or which of its other kinds, from 1.
using Choice = std::vector<std::uint8_t>;

/// The doubtful intervals, and what each of all intervals may be besides a rest.
struct Candidates {
  std::vector<std::size_t> at;
  std::vector<std::vector<QuietStretch>> other;

  /// How many kinds there are for each candidate, the rest included.
  [[nodiscard]] std::vector<std::uint8_t> counts() const {
    std::vector<std::uint8_t> counts;
    for (const std::size_t i : at) counts.push_back(static_cast<std::uint8_t>(1 + other[i].size()));
    return counts;
  }
  /// Plateaus wherever possible.
  [[nodiscard]] Choice accelerating() const {
    Choice choice;
    for (const std::size_t i : at)
      choice.push_back(other[i].back() == QuietStretch::plateau
                           ? static_cast<std::uint8_t>(other[i].size())
                           : 0);
    return choice;
  }
  [[nodiscard]] std::vector<QuietStretch> kinds_of(const Choice& choice) const {
    std::vector<QuietStretch> kinds(other.size(), QuietStretch::rest);
    for (std::size_t i = 0; i < at.size(); ++i)
      if (choice[i] > 0) kinds[at[i]] = other[at[i]][choice[i] - 1U];
    return kinds;
  }
};

/// Candidates that are not rests if the closure velocities accumulate, as they do if the sensor
/// never stops: those at more than a quarter of the highest such speed, and all that can only be
/// plateaus.
Choice by_summed_velocities(const std::vector<Closure>& closures,
                            const std::vector<StretchKnots>& stretches,
                            const std::vector<InertialEpoch>& knots,
                            const Candidates& candidates) {
  const auto accelerates = [&](std::size_t i) {
    return candidates.other[i].front() == QuietStretch::plateau;
  };
  std::vector<double> speed_mps(stretches.size(), 0.0);
  double v = 0.0, highest = 0.0;
  for (std::size_t i = 1; i < stretches.size(); ++i) {
    const std::size_t closure = closures.size() + i;
    if (closure >= stretches.size()) v += closures[closure - stretches.size()].velocity_mps;
    speed_mps[i] = std::abs(v);
    highest = std::max(highest, speed_mps[i]);
    if (!accelerates(i)) continue;
    for (std::size_t k = stretches[i].first; k < stretches[i].end; ++k)
      v += stretches[i].level_mps2 * knots[k].dt_s;
  }
  Choice choice;
  for (const std::size_t i : candidates.at)
    choice.push_back(accelerates(i) || speed_mps[i] > 0.25 * highest ? 1 : 0);
  return choice;
}

/// Climbs from each start to a most likely combination, by one or two intervals at a time, and
/// stores all combinations visited, which include the neighbours of the most likely one, and its
/// opposite.
template <class LogPosterior>
class Climb {
 public:
  /// `kinds`: how many there are for each candidate, the rest included.
  Climb(std::vector<std::uint8_t> kinds,
        const std::array<Choice, 3>& starts,
        LogPosterior log_posterior)
      : kinds_(std::move(kinds)), log_posterior_(std::move(log_posterior)) {
    for (const Choice& start : starts) climb_from(start);
  }
  [[nodiscard]] const std::map<Choice, double>& seen() const { return seen_; }

 private:
  void climb_from(Choice best) {
    see(best);
    for (bool climbs = true; climbs;) {
      const Choice from = best;
      for (std::size_t i = 0; i < kinds_.size(); ++i)
        for (const Choice& one : changed_at(i, from)) take_better(one, best);
      for (std::size_t i = 0; best == from && i < kinds_.size(); ++i)
        for (const Choice& one : changed_at(i, from)) change_another(i, one, best);
      if (best == from) take_better(opposite(from), best);
      climbs = best != from;
    }
  }
  /// Changes one of the first `end` intervals.
  void change_another(std::size_t end, const Choice& from, Choice& best) {
    for (std::size_t j = 0; j < end; ++j)
      for (const Choice& changed : changed_at(j, from)) take_better(changed, best);
  }
  [[nodiscard]] std::vector<Choice> changed_at(std::size_t i, const Choice& from) const {
    std::vector<Choice> changed;
    for (std::uint8_t kind = 0; kind < kinds_[i]; ++kind) {
      if (kind == from[i]) continue;
      changed.push_back(from);
      changed.back()[i] = kind;
    }
    return changed;
  }
  [[nodiscard]] static Choice opposite(Choice choice) {
    for (std::uint8_t& kind : choice) kind = kind == 0 ? 1 : 0;
    return choice;
  }
  double see(const Choice& choice) {
    const auto [at, is_new] = seen_.try_emplace(choice, 0.0);
    if (is_new) at->second = log_posterior_(choice);
    return at->second;
  }
  void take_better(const Choice& choice, Choice& best) {
    if (see(choice) > seen_.at(best)) best = choice;
  }

  std::vector<std::uint8_t> kinds_;
  LogPosterior log_posterior_;
  std::map<Choice, double> seen_{};
};

double duration_s(const std::vector<InertialEpoch>& knots, std::size_t first, std::size_t end) {
  double sum = 0.0;
  for (std::size_t k = first; k < end; ++k) sum += knots[k].dt_s;
  return sum;
}

/// Probability that the velocities of plateaus cancel between two rests, if the plateaus are rests
/// on places that are not level. Their velocities then have the size of the tilts times the time on
/// the plateaus; in the motions between, over tilts of the same size, the velocity is uncertain by
/// these times the duration of the motions.
double chance_of_closing(const std::vector<QuietStretch>& kinds,
                         const std::vector<StretchKnots>& stretches,
                         const std::vector<InertialEpoch>& knots) {
  double chance = 1.0, plateaus_s2 = 0.0, motions_s2 = 0.0;
  for (std::size_t i = 1; i < kinds.size(); ++i) {
    const double motion_s = duration_s(knots, stretches[i - 1].end, stretches[i].first);
    motions_s2 += motion_s * motion_s;
    if (kinds[i] == QuietStretch::plateau) {
      const double plateau_s = duration_s(knots, stretches[i].first, stretches[i].end);
      plateaus_s2 += plateau_s * plateau_s;
    }
    if (kinds[i] != QuietStretch::rest) continue;
    if (plateaus_s2 > motions_s2) chance *= std::sqrt(motions_s2 / plateaus_s2);
    plateaus_s2 = motions_s2 = 0.0;
  }
  return chance;
}

/// The hypotheses, given the log posterior of each combination.
std::vector<StopHypothesis> hypotheses_of(const std::map<Choice, double>& log_posterior,
                                          const Candidates& candidates) {
  const auto log_of = [](const auto& one) { return one.second; };
  const double best = std::ranges::max_element(log_posterior, {}, log_of)->second;
  double sum = 0.0;
  for (const auto& [choice, log] : log_posterior) sum += std::exp(log - best);
  std::vector<StopHypothesis> hypotheses;
  for (const auto& [choice, log] : log_posterior)
    hypotheses.push_back({candidates.kinds_of(choice), std::exp(log - best) / sum});
  return hypotheses;
}

/// The same hypothesis with its plateaus as rests.
std::vector<QuietStretch> with_tilts(std::vector<QuietStretch> stretches) {
  std::ranges::replace(stretches, QuietStretch::plateau, QuietStretch::rest);
  return stretches;
}

/// A plateau may be a rest on a place that is not level: the magnitude of gravity does not separate
/// the two (drop_plateaus), and the velocities do by the model of tilt in motion alone, which an
/// uneven floor does not obey. The hypothesis with rests keeps a tenth of the probability of the
/// one with plateaus, times that of velocities that cancel by chance.
void allow_for_tilts(const TrackSignal& signal,
                     const std::vector<StretchKnots>& stretches,
                     const std::vector<InertialEpoch>& knots,
                     std::vector<StopHypothesis>& hypotheses) {
  constexpr double least_of_tilts = 0.1;
  if (signal.axes.size() != 3 || signal.gravity != GravityContent::present) return;
  const std::size_t given = hypotheses.size();
  for (std::size_t h = 0; h < given; ++h) {
    std::vector<QuietStretch> tilted = with_tilts(hypotheses[h].stretches);
    const double least = least_of_tilts * hypotheses[h].probability *
                         chance_of_closing(hypotheses[h].stretches, stretches, knots);
    const auto same = std::ranges::find(hypotheses, tilted, &StopHypothesis::stretches);
    if (same == hypotheses.end())
      hypotheses.push_back({std::move(tilted), least});
    else
      same->probability = std::max(same->probability, least);
  }
  double sum = 0.0;
  for (const StopHypothesis& one : hypotheses) sum += one.probability;
  for (StopHypothesis& one : hypotheses) one.probability /= sum;
}

}  // namespace

void drop_plateaus(TrackSignal& signal) {
  std::vector<signal::Rest>& rests = signal.stops.rests;
  if (signal.axes.size() != 3 || signal.gravity != GravityContent::present || rests.size() < 2)
    return;
  const std::vector<RestLevel> levels = rest_levels(signal);
  const auto agree = [&](const RestLevel& a, const RestLevel& b) {
    // An uncalibrated sensor measures another norm of gravity in another orientation.
    constexpr double bias_mps2 = 0.5, bias_change_mps2 = 0.02;
    const double sine2 = std::max(0.0, 1.0 - std::pow(a.cosine_to(b), 2));
    return std::abs(a.length_mps2 - b.length_mps2) <= 5.0 * std::hypot(a.std_mps2, b.std_mps2) +
                                                          bias_change_mps2 +
                                                          bias_mps2 * std::sqrt(sine2);
  };
  const auto agreeing_s = [&](const RestLevel& level) {
    double sum = 0.0;
    for (const RestLevel& other : levels) sum += agree(level, other) ? other.duration_s : 0.0;
    return sum;
  };
  const auto most = std::ranges::max_element(levels, {}, agreeing_s);
  std::vector<signal::Rest> kept;
  for (std::size_t i = 0; i < rests.size(); ++i) {
    if (agree(*most, levels[i]))
      kept.push_back(rests[i]);
    else
      signal.stops.quiet_s -= levels[i].duration_s;
  }
  signal.stops.plateaus += rests.size() - kept.size();
  rests = std::move(kept);
}

std::vector<StopHypothesis> stop_hypotheses(const TrackSignal& signal,
                                            const AxisRun& run,
                                            const std::vector<Closure>& closures) {
  const std::size_t count = signal.stops.rests.size();
  const std::vector<QuietStretch> all_rests(count, QuietStretch::rest);
  const std::vector<InertialEpoch> knots = join_epochs(run.made.epochs, run.made.knots);
  if (closures.size() >= count) return {{all_rests, 1.0}};
  const std::vector<double> left_over = speed_left_over(closures, knots, run, count);
  const std::vector<StretchKnots> stretches = stretches_in(knots);
  const Candidates candidates{doubtful(left_over), kinds_besides_rest(stretches)};
  if (candidates.at.empty() || stretches.size() != count) return {{all_rests, 1.0}};
  if (candidates.at.size() > most_doubtful) return {};
  const std::vector<double> noise = rest_noises(signal);
  const double quietest = std::ranges::min(noise);
  const std::array<Choice, 3> starts{Choice(candidates.at.size(), 0),
                                     by_summed_velocities(closures, stretches, knots, candidates),
                                     candidates.accelerating()};
  const Climb climb(candidates.counts(), starts, [&](const Choice& choice) {
    const std::vector<QuietStretch> kinds = candidates.kinds_of(choice);
    if (std::ranges::find(kinds, QuietStretch::rest) == kinds.end())
      return -std::numeric_limits<double>::infinity();
    double log = log_evidence_of(kinds, stretches, knots, run) + log_prior(kinds) +
                 log_prior_of_tilts(kinds, left_over);
    for (const std::size_t i : candidates.at)
      log += log_loudness_density(quietest > 0.0 ? std::log(noise[i] / quietest) : 0.0, kinds[i]);
    return log;
  });
  std::vector<StopHypothesis> hypotheses = hypotheses_of(climb.seen(), candidates);
  allow_for_tilts(signal, stretches, knots, hypotheses);
  std::ranges::sort(hypotheses, std::greater{}, &StopHypothesis::probability);
  std::erase_if(hypotheses, [](const StopHypothesis& one) { return one.probability < 1e-3; });
  return hypotheses;
}

}  // namespace proofmass::estimate
