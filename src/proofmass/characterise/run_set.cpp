#include "proofmass/characterise/run_set.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/characterise/drift/evidence.hpp"
#include "proofmass/characterise/drift/fit.hpp"
#include "proofmass/characterise/runs/blocks.hpp"
#include "proofmass/characterise/runs/noise.hpp"
#include "proofmass/characterise/runs/scatter.hpp"
#include "proofmass/core/chi_square.hpp"
#include "proofmass/core/statistics.hpp"

namespace proofmass::characterise {
namespace {

using Eigen::Index;

constexpr double longest_window_s = 10.0, window_share = 1.0 / 16.0;

Result<std::vector<RunLevel>> levels_of(View<Run> runs, const RunBlocks& blocks, double window_s) {
  std::vector<RunLevel> levels;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    RunLevel level;
    level.name = runs[i].name;
    level.turn_on.value = mean_between(runs[i], 0.0, window_s);
    level.mean.value = blocks.level(static_cast<Index>(i));
    level.change.value = mean_between(runs[i], blocks.duration_s - window_s, blocks.duration_s) -
                         level.turn_on.value;
    if (!std::isfinite(level.change.value)) {
      return Error{Errc::too_few_samples,
                   fmt::format("{}: no sample in its first or last {:.3g} s: leave this run out",
                               runs[i].name, window_s)};
    }
    levels.push_back(std::move(level));
  }
  return levels;
}

// One of the three values of each run, with the uncertainty from the common noise.
RunScatter scatter_of(std::vector<RunLevel>& runs,
                      Uncertain RunLevel::* figure,
                      View<VarianceEstimate> within) {
  std::vector<double> values;
  for (RunLevel& run : runs) {
    (run.*figure).std = std::sqrt(mean_variance(within));
    values.push_back((run.*figure).value);
  }
  return run_scatter(values, within);
}

void add_lengths(RunSet& set, View<Run> runs) {
  const auto duration = [](const Run& run) {
    return static_cast<double>(run.series.size()) / run.rate_hz;
  };
  const auto [shortest, longest] = std::ranges::minmax_element(runs, {}, duration);
  if (duration(*longest) < 1.05 * duration(*shortest)) return;
  set.notes.push_back(fmt::format("compared over {:.4g} s, the length of {}: {} has {:.4g} s",
                                  set.duration_s, shortest->name, longest->name,
                                  duration(*longest)));
}

// More than a hundredth of a run.
void add_missing(RunSet& set, View<Run> runs) {
  for (const Run& run : runs) {
    const auto end = std::min(run.series.size(),
                              static_cast<std::size_t>(std::ceil(set.duration_s * run.rate_hz)));
    const Moments m = moments(run.series.first(end));
    if (100 * m.nonfinite <= end) continue;
    set.notes.push_back(
        fmt::format("{}: {} of {} samples are missing", run.name, m.nonfinite, end));
  }
}

std::vector<double> means_of(const RunSet& set) {
  std::vector<double> values(set.runs.size());
  std::ranges::transform(set.runs, values.begin(),
                         [](const RunLevel& run) { return run.mean.value; });
  return values;
}

// Beyond five robust standard deviations; not defined for fewer than six runs.
void add_outliers(RunSet& set) {
  if (set.runs.size() < 6) return;
  const std::vector<double> values = means_of(set);
  const double centre = *median(values), spread = *robust_std(values);
  if (!(spread > 0.0)) return;
  for (const RunLevel& run : set.runs) {
    const double off = (run.mean.value - centre) / spread;
    if (std::abs(off) <= 5.0) continue;
    set.notes.push_back(fmt::format(
        "{} is {:.1f} robust standard deviations {} the median of the runs; it is included in "
        "all figures",
        run.name, std::abs(off), off > 0.0 ? "above" : "below"));
  }
}

// A run whose residuals are larger than the noise of all runs together allows.
void add_noisy(RunSet& set, const Eigen::MatrixXd& left, const RunNoise& noise) {
  if (noise.models.empty()) return;
  const Eigen::VectorXd expected = noise.ordinates(left.rows());
  const Eigen::MatrixXd z = cosine_coefficients(left);
  const auto count = static_cast<double>(left.cols()), degrees = static_cast<double>(z.rows());
  for (Index i = 0; i < left.cols(); ++i) {
    // The subtracted mean over the runs contains a part of each.
    const double statistic =
        (z.col(i).array().square() / expected.array()).sum() * count / (count - 1.0);
    if (chi_square_p(statistic, degrees) > 0.001 / count || statistic < 2.0 * degrees) continue;
    set.notes.push_back(fmt::format(
        "{} is noisier or drifts more than the others: {:.1f} times the variance of all "
        "about what they share; its own uncertainty is larger than given",
        set.runs[static_cast<std::size_t>(i)].name, statistic / degrees));
  }
}

void add_trend(RunSet& set) {
  const RunTrend trend = run_trend(means_of(set));
  set.trend_per_run = trend.per_run;
  set.trend_p = trend.p;
  if (trend.p < 0.01) {
    set.notes.push_back(
        fmt::format("the level {} from run to run (p = {:.2g}): the scatter between the runs is "
                    "partly this trend",
                    trend.per_run.value > 0.0 ? "rises" : "falls", trend.p));
  }
}

// The means as a record of their own, one value a run.
void add_level_curve(RunSet& set) {
  const std::vector<double> means = means_of(set);
  const Moments m = moments(means);
  if (means.size() < DriftEvidence::fewest_blocks || !(m.std() > 0.0)) return;
  constexpr double first_run = -0.5;  // a mean stands in the middle of its block
  const auto evidence = DriftEvidence::make(means, {.rate_hz = 1.0, .block = 1}, first_run);
  if (evidence) set.level_curve = fit_drift(*evidence).fit;
}

Result<DriftAnalysis> common_warm_up(const RunBlocks& blocks, const DriftOptions& options) {
  DriftOptions of_mean = options;
  of_mean.rate_hz = 1.0 / blocks.block_s;
  of_mean.since_switch_on_s += 0.5 * blocks.block_s;  // the middle of the first block
  const std::vector<double> series(blocks.common.begin(), blocks.common.end());
  Result<DriftAnalysis> found = analyse_drift(series, of_mean);
  if (!found) return found.error().at("mean of the runs");
  DriftAnalysis analysis = std::move(found).value();
  analysis.notes.push_back(
      {Severity::info, fmt::format("the mean of {} runs, each less its own level, over blocks of "
                                   "{:.3g} s",
                                   blocks.level.size(), blocks.block_s)});
  return analysis;
}

}  // namespace

Result<RunSet> compare_runs(View<Run> runs, const DriftOptions& options) {
  const Result<RunBlocks> blocks = run_blocks(runs);
  if (!blocks) return blocks.error();
  RunSet set;
  set.duration_s = blocks->duration_s;
  set.window_s = std::min(longest_window_s, window_share * set.duration_s);
  Result<std::vector<RunLevel>> levels = levels_of(runs, *blocks, set.window_s);
  if (!levels) return levels.error();
  set.runs = std::move(levels).value();

  const Eigen::MatrixXd left = residuals(*blocks);
  const RunNoise noise = fit_run_noise(left, set.duration_s);
  set.turn_on = scatter_of(set.runs, &RunLevel::turn_on, noise.allan_variance(set.window_s));
  set.level = scatter_of(set.runs, &RunLevel::mean, noise.allan_variance(set.duration_s));
  set.change = scatter_of(set.runs, &RunLevel::change, noise.change_variance(set.window_s));
  add_trend(set);
  add_level_curve(set);
  add_lengths(set, runs);
  add_missing(set, runs);
  add_outliers(set);
  add_noisy(set, left, noise);

  Result<DriftAnalysis> warm_up = common_warm_up(*blocks, options);
  if (!warm_up) return warm_up.error();
  set.warm_up = std::move(warm_up).value();
  return set;
}

}  // namespace proofmass::characterise
