#pragma once

#include <optional>
#include <string>
#include <vector>

#include "proofmass/characterise/drift_analysis.hpp"
#include "proofmass/core/quantity.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/core/view.hpp"

// Several power-ups of one sensor, compared.
namespace proofmass::characterise {

/// One run of one channel.
struct Run {
  std::string name;
  View<double> series;  ///< evenly sampled, NaN where missing
  double rate_hz = 0.0;
};

/// Result of one run.
struct RunLevel {
  std::string name;
  Uncertain turn_on;  ///< mean over the first window_s, std from the coloured noise within the run
  Uncertain mean;     ///< over the whole common length
  Uncertain change;   ///< mean of the last window_s minus that of the first
};

/// Variation between runs beyond the noise within the runs.
struct RunScatter {
  double mean = 0.0;      ///< over the runs
  double mean_std = 0.0;  ///< standard deviation of that mean, from the variation between runs
  double observed_std = 0.0;
  double within_std = 0.0;  ///< root mean square of the runs' own uncertainty
  /// √(observed² − within²), 0 if the noise explains all of it, with its 95 % interval.
  Interval95 between_std;
  double p = 1.0;  ///< p-value of the hypothesis that the runs do not differ
};

struct RunSet {
  std::vector<RunLevel> runs;
  double window_s = 0.0;    ///< averaging time of the turn-on value
  double duration_s = 0.0;  ///< common to all runs
  RunScatter turn_on;       ///< turn-on repeatability
  RunScatter level;         ///< of the runs' means
  RunScatter change;        ///< of the change during a run; its mean is that of the common warm-up
  std::optional<Uncertain> trend_per_run;  ///< of the means against the run number
  double trend_p = 1.0;
  /// Warm-up of the means from run to run, a2 + a1 (1 − e^(−n/T)) with n = 0 for the first: times
  /// in runs. For 12 runs or more.
  std::optional<DriftFit> level_curve;
  DriftAnalysis warm_up;  ///< of the mean over all runs, each minus its own level
  std::vector<std::string> notes;
};

/// Compares three or more runs, in their order, from power-on over the length of the shortest, on a
/// common time grid: their rates may differ. Block b of run i is
///
///     y_ib = m_i + c_b + e_ib,     Σ c_b = 0,
///
/// with the run's level m_i, the common warm-up c_b, and noise e.
///
/// - Noise: one model for all runs, a sum of white noise, flicker, random walk or first-order
///   Markov noise fitted to the residuals of 64 blocks a run; each choice m of these has its Akaike
///   weight w_m.
/// - The uncertainty of a run's mean is the Allan deviation √v of that noise at the length of the
///   run: the difference of two neighbouring runs' means, over √2, if the sensor had stayed on.
/// - The excess variation of the runs is between_std; it includes a trend from run to run.
/// - Turn-on values are means over a sixteenth of the run, 10 s at most.
///
/// With s² the variance of R values, p is P(0) and the 95 % interval of between_std all σ with
/// 0.025 <= P(σ²) <= 0.975 of
///
///     P(σ²) = Σ w_m E P[χ²(R − 1) > (R − 1) s² / (V_m + σ²)],
///
/// with ln V_m normal about ln v_m with the variance from the fit, and E the mean over it. For the
/// upper end s² is at least v: runs that agree better than expected by chance do not prove that
/// they are the same. A random walk or flicker too weak to be detected within the runs can still
/// make their means differ: it then counts as between_std.
///
/// Source: W. G. Cochran, The combination of estimates from different experiments, Biometrics 10
/// (1954) 101, the test; W. Viechtbauer, Confidence intervals for the amount of heterogeneity in
/// meta-analysis, Statistics in Medicine 26 (2007) 37, section 2.3, the interval for known V; S. T.
/// Buckland, K. P. Burnham, N. H. Augustin, Model selection: an integral part of inference,
/// Biometrics 53 (1997) 603, the weights; D. W. Allan, Proc. IEEE 54 (1966) 221, the deviation.
///
/// options.rate_hz is not used: each run has its own. Errors: too_few_samples (fewer than 3 runs; a
/// run of fewer than 256 samples, shorter than a tenth of the median, half missing, or without a
/// sample in its first or last window_s: the message names it), invalid_argument (a rate that is
/// not positive or differs from the median by more than a twentieth), and those of analyse_drift
/// for the warm-up. Cost: O(N) in all samples, and one analyse_drift of up to 2048 samples.
[[nodiscard]] Result<RunSet> compare_runs(View<Run> runs, const DriftOptions& options);

}  // namespace proofmass::characterise
