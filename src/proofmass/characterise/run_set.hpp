#pragma once

#include <optional>
#include <string>
#include <vector>

#include "proofmass/characterise/drift_analysis.hpp"
#include "proofmass/core/quantity.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/core/view.hpp"

// Several power-ups of one sensor as a set.
namespace proofmass::characterise {

/// One run of one channel.
struct Run {
  std::string name;
  View<double> series;  ///< evenly sampled, NaN where missing
  double rate_hz = 0.0;
};

/// What one run says.
struct RunLevel {
  std::string name;
  Uncertain turn_on;  ///< mean over the first window_s, std by the coloured noise within the run
  Uncertain mean;     ///< over the whole common length
  Uncertain change;   ///< mean of the last window_s less that of the first
};

/// A scatter from run to run beyond what noise within the runs explains.
struct RunScatter {
  double mean = 0.0;      ///< over the runs
  double mean_std = 0.0;  ///< of that mean, by the scatter
  double observed_std = 0.0;
  double within_std = 0.0;  ///< root mean square of the runs' own uncertainty
  /// √(observed² − within²), 0 where the noise explains it all, with its 95 % interval.
  Interval95 between_std;
  double p = 1.0;  ///< probability of so much scatter if the runs did not differ
};

struct RunSet {
  std::vector<RunLevel> runs;
  double window_s = 0.0;    ///< of the turn-on value
  double duration_s = 0.0;  ///< common to all runs
  RunScatter turn_on;       ///< turn-on repeatability
  RunScatter level;         ///< of the runs' means
  RunScatter change;        ///< of how far the runs went; its mean is that of the common warm-up
  std::optional<Uncertain> trend_per_run;  ///< of the means against the number of the run
  double trend_p = 1.0;
  /// Warm-up of the means from run to run, a2 + a1 (1 − e^(−n/T)) with n = 0 for the first: times
  /// in runs. Of 12 runs or more.
  std::optional<DriftFit> level_curve;
  DriftAnalysis warm_up;  ///< of the mean over all runs, each less its own level
  std::vector<std::string> notes;
};

/// Compares three or more runs, in their order, from switch-on over the length of the shortest, on
/// a time grid that they share: their rates may differ. Block b of run i is
///
///     y_ib = m_i + c_b + e_ib,     Σ c_b = 0,
///
/// with the run's level m_i, the warm-up c_b that all share, and noise e. The noise is one for all
/// runs, a sum of white noise, flicker, random walk or first-order Markov noise fitted to the
/// residuals of 64 blocks a run; each choice m of these has its Akaike weight w_m. The uncertainty
/// of a run's mean is the Allan deviation √v of that noise at the length of the run: by what the
/// means of two neighbouring runs would differ, over √2, if the sensor had stayed on. What the runs
/// scatter beyond that is between_std; a trend from run to run is in it. Turn-on values are means
/// over a sixteenth of the run, 10 s at most.
///
/// With s² the variance of R values, p is P(0) and the 95 % interval of between_std all σ with
/// 0.025 <= P(σ²) <= 0.975 of
///
///     P(σ²) = Σ w_m E P[χ²(R − 1) > (R − 1) s² / (V_m + σ²)],
///
/// ln V_m being normal about ln v_m as widely as the fit leaves it, and E the mean over it. For the
/// upper end s² is taken to be v at the least: runs that by chance agree better than they can do
/// not prove that they are the same. A random walk or flicker too weak to show within the runs can
/// still make their means differ: it then counts as between_std.
///
/// Source: W. G. Cochran, The combination of estimates from different experiments, Biometrics 10
/// (1954) 101, the test; W. Viechtbauer, Confidence intervals for the amount of heterogeneity in
/// meta-analysis, Statistics in Medicine 26 (2007) 37, section 2.3, the interval for known V; S. T.
/// Buckland, K. P. Burnham, N. H. Augustin, Model selection: an integral part of inference,
/// Biometrics 53 (1997) 603, the weights; D. W. Allan, Proc. IEEE 54 (1966) 221, the deviation.
///
/// options.rate_hz is not used: each run has its own.
/// Errors: too_few_samples (fewer than 3 runs; a run of fewer than 256 samples, shorter than a
/// tenth of the median, half missing, or without a sample in its first or last window_s: the
/// message names it), invalid_argument (a rate that is not positive or is off the median by more
/// than a twentieth), and those of analyse_drift for the warm-up. Cost: O(N) in all samples, and
/// one analyse_drift of up to 2048 samples.
[[nodiscard]] Result<RunSet> compare_runs(View<Run> runs, const DriftOptions& options);

}  // namespace proofmass::characterise
