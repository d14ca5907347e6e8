#include "proofmass/estimate/tune.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>

#include "proofmass/core/chi_square.hpp"
#include "proofmass/core/contract.hpp"
#include "proofmass/core/linalg.hpp"
#include "proofmass/estimate/tune/interval.hpp"
#include "proofmass/estimate/tune/outliers.hpp"
#include "proofmass/estimate/tune/problem.hpp"
#include "proofmass/estimate/tune/start.hpp"

namespace proofmass::estimate {
namespace {

using Group = std::vector<std::size_t>;

const TuneParameter* find_parameter(TuneModel model, std::string_view name) {
  for (const TuneParameter& parameter : parameters_of(model)) {
    if (parameter.name == name) return &parameter;
  }
  return nullptr;
}

std::size_t index_of(TuneModel model, std::string_view name) {
  return static_cast<std::size_t>(find_parameter(model, name) - parameters_of(model).data());
}

Error no_such(TuneModel model, std::string_view name) {
  std::string names;
  for (const TuneParameter& parameter : parameters_of(model)) {
    names += (names.empty() ? "" : ", ") + std::string(parameter.name);
  }
  return {Errc::invalid_argument, "the model " + std::string(name_of(model)) +
                                      " has no parameter '" + std::string(name) + "': it has " +
                                      names};
}

Status check_options(const TuneOptions& options) {
  for (const std::vector<FixedParameter>* list : {&options.fixed, &options.start}) {
    for (const FixedParameter& given : *list) {
      const TuneParameter* parameter = find_parameter(options.model, given.name);
      if (parameter == nullptr) return no_such(options.model, given.name);
      const bool may_vanish = list == &options.fixed && parameter->role != TuneRole::time_constant;
      if (!std::isfinite(given.value) || given.value < 0.0 || (given.value == 0.0 && !may_vanish))
        return Error{Errc::invalid_argument, given.name + ": expected a positive number"};
    }
  }
  for (const std::string& name : options.shared) {
    if (find_parameter(options.model, name) == nullptr) return no_such(options.model, name);
  }
  return Done{};
}

Status check_series(const TuneSeries& series) {
  constexpr std::size_t fewest = 10;
  if (!(series.rate_hz > 0.0) || !std::isfinite(series.rate_hz))
    return Error{Errc::invalid_argument, "the rate must be positive"}.at(series.name);
  std::size_t count = 0;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const View<double> segment : series.segments) {
    for (const double x : segment) {
      if (std::isinf(x))
        return Error{Errc::not_finite, "a measurement is infinite; use NaN for a missing one"}.at(
            series.name);
      if (std::isnan(x)) continue;
      ++count;
      low = std::min(low, x);
      high = std::max(high, x);
    }
  }
  if (count < fewest)
    return Error{Errc::too_few_samples, std::to_string(count) + " readings, at least " +
                                            std::to_string(fewest) + " are needed"}
        .at(series.name);
  if (low == high)
    return Error{Errc::not_observable, "all measurements are equal: there is no noise to tune by"}
        .at(series.name);
  return Done{};
}

bool holds(const std::vector<FixedParameter>& list, std::string_view name) {
  return std::ranges::any_of(list, [&](const FixedParameter& one) { return one.name == name; });
}

TuneProblem problem_of(const std::vector<TuneSeries>& series, const TuneOptions& options) {
  std::vector<const TuneSeries*> own;
  for (const TuneSeries& one : series) own.push_back(&one);
  TuneProblem problem(options.model, std::move(own));
  const View<TuneParameter> parameters = parameters_of(options.model);
  Group all(series.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    const std::string_view name = parameters[j].name;
    if (holds(options.fixed, name)) continue;
    if (std::ranges::find(options.shared, name) != options.shared.end()) {
      problem.unknowns.push_back({j, all});
    } else {
      for (const std::size_t s : all) problem.unknowns.push_back({j, {s}});
    }
  }
  for (const FixedParameter& fixed : options.fixed) {
    for (std::vector<double>& values : problem.values) {
      values[index_of(options.model, fixed.name)] = fixed.value;
    }
  }
  return problem;
}

// --- what one group comes to ---------------------------------------------------------------------

// Current value of an unknown, and its status.
struct Candidate {
  TuneUnknown unknown;
  TunedParameter found;
};

class Fit {
 public:
  Fit(TuneProblem problem, const TuneOptions& options) : problem_(std::move(problem)) {
    for (const TuneUnknown& unknown : problem_.unknowns) {
      const TuneParameter& parameter = parameters_of(options.model)[unknown.parameter];
      TunedParameter found;
      found.name = parameter.name;
      found.role = parameter.role;
      found.channel_power = parameter.channel_power;
      found.second_power = parameter.second_power;
      candidates_.push_back({unknown, std::move(found)});
    }
  }

  // The maximum with all noises.
  Status begin(const TuneOptions& options, Tuning& into) {
    const Status started = set_start(problem_);
    if (!started) return started;
    for (std::size_t k = 0; k < problem_.unknowns.size(); ++k) {
      for (const FixedParameter& given : options.start) {
        if (given.name == problem_.parameter(k).name) problem_.set(k, given.value);
      }
    }
    each([&](Candidate& candidate, std::size_t k) { candidate.found.start = problem_.value(k); });
    for (int k = 0; k < options.em_steps; ++k) add_em(k, em_step(problem_), into);
    add_em(options.em_steps, problem_.log_likelihood(), into);
    each(
        [&](Candidate& candidate, std::size_t k) { candidate.found.after_em = problem_.value(k); });
    climb(into);
    return Done{};
  }

  // Which noises are distinguishable from zero, and their intervals.
  void finish(Tuning& into) {
    while (drop_one()) climb(into);
    set_intervals();
    into.log_likelihood += problem_.log_likelihood();
    if (!problem_.unknowns.empty()) {
      for (const double g : problem_.slope().gradient) {
        into.gradient = std::max(into.gradient, std::abs(g));
      }
    }
  }

  [[nodiscard]] const TuneProblem& problem() const { return problem_; }
  [[nodiscard]] const std::vector<Candidate>& candidates() const { return candidates_; }

 private:
  // The remaining unknowns, with their index in the problem.
  template <class Work>
  void each(Work&& work) {
    for (std::size_t k = 0; k < problem_.unknowns.size(); ++k) work(candidate_of(k), k);
  }

  Candidate& candidate_of(std::size_t k) {
    const TuneUnknown& unknown = problem_.unknowns[k];
    return *std::ranges::find_if(candidates_, [&](const Candidate& one) {
      return one.unknown.parameter == unknown.parameter && one.unknown.series == unknown.series;
    });
  }

  static void add_em(int step, double log_likelihood, Tuning& into) {
    const auto k = static_cast<std::size_t>(step);
    if (into.em_log_likelihood.size() <= k) into.em_log_likelihood.resize(k + 1, 0.0);
    into.em_log_likelihood[k] += log_likelihood;
  }

  void climb(Tuning& into) {
    const TuneMaximum found = maximise(problem_);
    into.iterations += found.iterations;
    into.converged = into.converged && std::isfinite(found.log_likelihood);
    log_std_.assign(problem_.unknowns.size(), std::numeric_limits<double>::infinity());
    if (problem_.unknowns.empty()) return;
    const Eigen::MatrixXd H = information(problem_);
    const SymmetricEigen eigen = symmetric_eigen(H);
    for (Eigen::Index k = 0; k < H.rows(); ++k) {
      double variance = 0.0;
      for (Eigen::Index i = 0; i < H.rows(); ++i) {
        const double share = eigen.vectors(k, i) * eigen.vectors(k, i);
        variance += share / std::max(eigen.values(i), 1e-300);
      }
      log_std_[static_cast<std::size_t>(k)] = std::sqrt(variance);
    }
  }

  // Whether an unknown may be zero: not a time constant, and not the last noise.
  [[nodiscard]] bool may_vanish(std::size_t k) const {
    const TuneRole role = problem_.parameter(k).role;
    if (role == TuneRole::time_constant) return false;
    TuneProblem rest = without(problem_, k, 0.0);
    return std::isfinite(rest.log_likelihood());
  }

  // Drops the noise whose omission costs least, if the cost is not significant; a Markov bias, two
  // parameters, before any other, because one of infinite correlation time is a random walk too.
  bool drop_one() {
    for (const bool markov : {true, false}) {
      const std::optional<std::size_t> found = weakest(markov);
      if (!found) continue;
      leave_out(*found);
      return true;
    }
    return false;
  }

  // The noise whose omission costs least, if that is not significant.
  std::optional<std::size_t> weakest(bool markov) {
    constexpr double certain = 0.1;
    const double best = problem_.log_likelihood();
    std::optional<std::size_t> weakest;
    double least = chi_square_quantile(0.95, markov ? 2.0 : 1.0);
    for (std::size_t k = 0; k < problem_.unknowns.size(); ++k) {
      if ((problem_.parameter(k).role == TuneRole::markov_std) != markov) continue;
      if ((!markov && log_std_[k] < certain) || !may_vanish(k)) continue;
      TuneProblem rest = without(problem_, k, 0.0);
      drop_time_constants(rest);
      const double cost = 2.0 * (best - maximise(rest, false).log_likelihood);
      if (cost >= least) continue;
      weakest = k;
      least = cost;
    }
    return weakest;
  }

  // A Markov bias of zero variance has no time constant.
  static void drop_time_constants(TuneProblem& problem) {
    const View<TuneParameter> parameters = parameters_of(problem.model());
    for (std::size_t k = problem.unknowns.size(); k-- > 0;) {
      const TuneUnknown& unknown = problem.unknowns[k];
      if (parameters[unknown.parameter].role != TuneRole::time_constant) continue;
      const bool gone = std::ranges::all_of(unknown.series, [&](std::size_t s) {
        return problem.values[s][unknown.parameter - 1] == 0.0;
      });
      if (gone) problem = without(problem, k, problem.value(k));
    }
  }

  void leave_out(std::size_t k) {
    TunedParameter& found = candidate_of(k).found;
    found.verdict = TuneVerdict::not_observable;
    found.reason = "not distinguishable from zero";
    if (found.role == TuneRole::markov_std) {
      found.reason += ": white noise and a random walk explain the data";
    } else {
      // One-sided, hence 90 % two-sided.
      found.upper_95 = profile_limit(problem_, {.unknown = k,
                                                .upwards = true,
                                                .drop = chi_square_quantile(0.90, 1.0),
                                                .log_std = std::min(log_std_[k], 1.0)});
    }
    TuneProblem rest = without(problem_, k, 0.0);
    const std::vector<TuneUnknown> before = rest.unknowns;
    drop_time_constants(rest);
    for (std::size_t j = 0; j < problem_.unknowns.size(); ++j) {
      const bool stays = std::ranges::any_of(rest.unknowns, [&](const TuneUnknown& one) {
        return one.parameter == problem_.unknowns[j].parameter &&
               one.series == problem_.unknowns[j].series;
      });
      if (stays || j == k) continue;
      TunedParameter& gone = candidate_of(j).found;
      gone.verdict = TuneVerdict::not_observable;
      gone.reason = "there is no Markov bias to which it applies";
    }
    problem_ = std::move(rest);
  }

  void set_intervals() {
    each([&](Candidate& candidate, std::size_t k) {
      TunedParameter& found = candidate.found;
      const TuneInterval interval = interval_95(problem_, k, log_std_[k]);
      found.lower_95 = interval.lower;
      found.upper_95 = interval.upper;
      const double value = problem_.value(k);
      if (found.role == TuneRole::time_constant && !(interval.lower && interval.upper)) {
        // Its standard deviation over a record of length T is about τ √(2τ/T).
        constexpr double times = 50.0;
        found.verdict = TuneVerdict::not_observable;
        found.reason = interval.lower ? "the record is too short to bound it from above"
                                      : "the samples are too far apart to bound it from below";
        if (interval.lower) found.record_needed_s = times * value;
      } else if (std::isfinite(log_std_[k])) {
        found.value = Uncertain{value, value * log_std_[k]};
      } else {
        found.verdict = TuneVerdict::not_observable;
        found.reason = "not identifiable: the likelihood does not depend on it";
      }
    });
  }

  TuneProblem problem_;
  std::vector<Candidate> candidates_;
  std::vector<double> log_std_;  // of each unknown's logarithm
};

// --- results -------------------------------------------------------------------------------------

TunedSeries series_result(const TuneProblem& problem, std::size_t s) {
  const TuneSeries& series = *problem.series()[s];
  TunedSeries out;
  out.name = series.name;
  out.values = problem.values[s];
  out.system = problem.system(s);
  out.rate_hz = series.rate_hz;
  std::size_t samples = 0, number = 0;
  for (const View<double> segment : series.segments) {
    const double start_s = number < series.starts_s.size()
                               ? series.starts_s[number]
                               : static_cast<double>(samples) / series.rate_hz;
    ++number;
    for (std::size_t k = 0; k < segment.size(); ++k)
      out.time_s.push_back(start_s + static_cast<double>(k) / series.rate_hz);
    const TuneScore score = log_likelihood(out.system, segment);
    out.log_likelihood += score.log_likelihood;
    out.readings += score.readings;
    samples += segment.size();
    const TuneInnovations found = innovations_of(out.system, segment);
    out.innovation.insert(out.innovation.end(), found.innovation.begin(), found.innovation.end());
    out.variance.insert(out.variance.end(), found.variance.begin(), found.variance.end());
  }
  out.missing = samples - out.readings;
  out.duration_s = static_cast<double>(samples) / series.rate_hz;
  return out;
}

void add_results(const Fit& fit, const Group& group, std::size_t all, Tuning& into) {
  for (const Candidate& candidate : fit.candidates()) {
    TunedParameter found = candidate.found;
    const bool shared =
        candidate.unknown.series.size() == group.size() && all > 1 && group.size() > 1;
    if (!shared) found.series = group[candidate.unknown.series.front()];
    into.parameters.push_back(std::move(found));
  }
  for (std::size_t s = 0; s < group.size(); ++s) {
    into.series[group[s]] = series_result(fit.problem(), s);
  }
}

void set_outliers(TunedSeries& series, const TuneOutliers& outliers) {
  series.outliers = outliers;
  series.missing -= outliers.count;
}

// What the fits of several channels have in common.
void add_course(Tuning& all, const Tuning& more) {
  all.converged = all.converged && more.converged;
  all.log_likelihood += more.log_likelihood;
  all.iterations += more.iterations;
  all.gradient = std::max(all.gradient, more.gradient);
  all.em_log_likelihood.resize(
      std::max(all.em_log_likelihood.size(), more.em_log_likelihood.size()));
  for (std::size_t k = 0; k < more.em_log_likelihood.size(); ++k)
    all.em_log_likelihood[k] += more.em_log_likelihood[k];
}

// In motion, a jolt is as isolated as an outlier, and against a noise that is held anything is.
bool has_outliers(const TuneOptions& options) {
  return is_of_rest(options.model) &&
         std::ranges::none_of(options.fixed, [&](const FixedParameter& fixed) {
           return find_parameter(options.model, fixed.name)->role != TuneRole::time_constant;
         });
}

// The maximum for the measurements without outliers. Many are the tails of the noise, or noise of
// channels that share a parameter and differ: they stay.
Result<Fit> fit_without_outliers(const std::vector<TuneSeries>& series,
                                 const TuneOptions& options,
                                 TuneReadings& readings,
                                 Tuning& course) {
  constexpr int most_rounds = 10;
  constexpr double most_share = 0.02;
  for (int round = has_outliers(options) ? 0 : most_rounds;; ++round) {
    Fit fit(problem_of(readings.series(), options), options);
    course = {};
    course.converged = true;
    if (Status found = fit.begin(options, course); !found) return found.error();
    if (round == most_rounds) return fit;
    if (readings.drop_outliers(fit.problem()) == 0) return fit;
    if (readings.largest_share() < most_share) continue;
    readings = TuneReadings(series);
    round = most_rounds - 1;  // the next is the last
  }
}

void add_fixed(const TuneOptions& options, Tuning& into) {
  for (const FixedParameter& fixed : options.fixed) {
    const TuneParameter& parameter = *find_parameter(options.model, fixed.name);
    TunedParameter found;
    found.name = fixed.name;
    found.role = parameter.role;
    found.channel_power = parameter.channel_power;
    found.second_power = parameter.second_power;
    found.verdict = TuneVerdict::fixed;
    found.value = Uncertain{fixed.value, 0.0};
    found.start = found.after_em = fixed.value;
    into.parameters.push_back(std::move(found));
  }
}

// The channels of a group, fitted together.
Status tune_group(const std::vector<TuneSeries>& series,
                  const Group& group,
                  const TuneOptions& options,
                  Tuning& tuning) {
  std::vector<TuneSeries> own;
  for (const std::size_t s : group) own.push_back(series[s]);
  TuneReadings readings(own);
  Tuning course;
  Result<Fit> found = fit_without_outliers(own, options, readings, course);
  if (!found) return found.error().at(own.front().name);
  Fit fit = std::move(found).value();
  fit.finish(course);
  add_course(tuning, course);
  add_results(fit, group, series.size(), tuning);
  for (std::size_t k = 0; k < group.size(); ++k)
    set_outliers(tuning.series[group[k]], readings.outliers()[k]);
  return Done{};
}

}  // namespace

Result<Tuning> tune(const std::vector<TuneSeries>& series, const TuneOptions& options) {
  if (series.empty()) return Error{Errc::invalid_argument, "no channel to tune by"};
  if (const Status good = check_options(options); !good) return good.error();
  for (const TuneSeries& one : series) {
    if (const Status good = check_series(one); !good) return good.error();
  }
  std::vector<Group> groups;
  if (options.shared.empty()) {
    for (std::size_t s = 0; s < series.size(); ++s) groups.push_back({s});
  } else {
    groups.emplace_back(series.size());
    std::iota(groups.front().begin(), groups.front().end(), std::size_t{0});
  }
  Tuning tuning;
  tuning.model = options.model;
  tuning.converged = true;
  tuning.series.resize(series.size());
  for (std::size_t g = 0; g < groups.size(); ++g) {
    if (options.progress)
      options.progress("tuning", static_cast<double>(g) / static_cast<double>(groups.size()));
    if (Status done = tune_group(series, groups[g], options, tuning); !done) return done.error();
  }
  add_fixed(options, tuning);
  return tuning;
}

Consistency consistency_of(const Tuning& tuning) {
  std::vector<InnovationSeries> channels;
  ConsistencyOptions options;
  for (const TunedSeries& series : tuning.series) {
    channels.push_back({.innovation = series.innovation, .variance = series.variance});
    options.channels.push_back(series.name);
    options.rate_hz = series.rate_hz;
  }
  return check_consistency(channels, options);
}

void append(Tuning& all, Tuning more) {
  PM_EXPECTS(all.series.empty() || all.model == more.model);
  const std::size_t before = all.series.size();
  all.model = more.model;
  if (before == 0) all.converged = true;
  add_course(all, more);
  for (TunedParameter& parameter : more.parameters) {
    const auto same = [&](const TunedParameter& one) {
      return one.verdict == TuneVerdict::fixed && one.name == parameter.name;
    };
    if (parameter.verdict == TuneVerdict::fixed && std::ranges::any_of(all.parameters, same))
      continue;
    if (parameter.series) *parameter.series += before;
    all.parameters.push_back(std::move(parameter));
  }
  for (TunedSeries& series : more.series) all.series.push_back(std::move(series));
}

}  // namespace proofmass::estimate
