#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/progress.hpp"
#include "proofmass/core/quantity.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/core/view.hpp"
#include "proofmass/estimate/consistency.hpp"
#include "proofmass/estimate/tune/model.hpp"

// Noise parameters of a filter's model, estimated from the recording to be filtered.
namespace proofmass::estimate {

/// One channel. Each segment has a diffuse start: for example the rests of a recording.
struct TuneSeries {
  std::string name;
  double rate_hz = 1.0;
  std::vector<View<double>> segments;  ///< evenly sampled, NaN where missing
  std::vector<double> starts_s = {};   ///< of each segment; empty: consecutive
};

/// A parameter held at a value in all channels.
struct FixedParameter {
  std::string name;
  double value = 0.0;
};

struct TuneOptions {
  TuneModel model = TuneModel::rest;
  std::vector<FixedParameter> fixed = {};
  std::vector<std::string> shared = {};  ///< names of parameters common to all channels
  /// Initial values by name, for all channels, instead of the Allan deviation.
  std::vector<FixedParameter> start = {};
  int em_steps = 4;
  Progress progress = {};
};

enum class TuneVerdict {
  identified,
  not_observable,  ///< the data are consistent with zero, or with any value: see `reason`
  fixed,
};

struct TunedParameter {
  std::string name;
  TuneRole role = TuneRole::reading;
  int channel_power = 1;  ///< exponent of the channel's unit, see TuneParameter
  double second_power = 0.0;
  std::optional<std::size_t> series;  ///< absent: shared by all
  TuneVerdict verdict = TuneVerdict::identified;
  std::optional<Uncertain> value;  ///< std 0 if fixed
  std::optional<double> lower_95, upper_95;
  std::string reason;  ///< if there is no value
  /// Approximate length of a record that would determine it.
  std::optional<double> record_needed_s;
  double start = 0.0, after_em = 0.0;  ///< initial and intermediate values
};

/// Isolated measurements that no noise of the model explains.
struct TuneOutliers {
  std::size_t count = 0;
  double largest = 0.0;  ///< distance from what the others predict, in the channel's unit
};

/// Result of one channel.
struct TunedSeries {
  std::string name;
  std::vector<double> values;  ///< the model's parameters as used; one that is not observable is 0
  TuneSystem system;           ///< with these values
  double log_likelihood = 0.0;
  std::size_t readings = 0, missing = 0;  ///< without the outliers
  TuneOutliers outliers;
  double rate_hz = 0.0, duration_s = 0.0;
  /// All segments; NaN where missing, of outliers, and at the start of each.
  std::vector<double> time_s, innovation, variance;
};

struct Tuning {
  TuneModel model = TuneModel::rest;
  std::vector<TunedParameter> parameters;
  std::vector<TunedSeries> series;
  double log_likelihood = 0.0;            ///< sum of all channels
  std::vector<double> em_log_likelihood;  ///< before each step and after the last
  int iterations = 0;                     ///< iterations of the maximisation
  double gradient = 0.0;                  ///< largest |∂L/∂ ln θ| at the end
  bool converged = false;
};

/// Finds the parameters of the model by maximum likelihood: a start from the Allan variance (or, if
/// that is not conclusive, from a grid), steps of expectation–maximisation, a quasi-Newton search
/// with the exact gradient, final Newton steps.
///
///     std = θ √(H⁻¹)ⱼⱼ,   H = −∂²L/∂ln θ²  by differences of the gradient;
///     interval_95: θ e^(±1.96 √(H⁻¹)ⱼⱼ), or if that is wider than ±20 %, where twice the loss
///     in log-likelihood, with all others refitted, stays below 3.84.
///
/// A noise whose omission costs less than 3.84 in twice the log-likelihood is not distinguishable
/// from zero: it has no value but an upper 95 % limit (2.71), and the others are fitted without it.
/// Channels are fitted separately unless they share a parameter. Outliers of a sensor at rest
/// (tune/outliers.hpp) are found with the parameters of a fit, which is then repeated without them.
///
/// Source: J. Durbin, S. J. Koopman (2012), chapter 7; EM: R. H. Shumway, D. S. Stoffer, J. Time
/// Series Anal. 3 (1982) 253. Errors: invalid_argument (a name that the model does not have, an
/// impossible value), too_few_samples (fewer than 10 measurements of a channel), not_observable (a
/// channel whose measurements are all equal), not_finite (an infinite measurement). Cost: 20 to 80
/// passes over the data.
[[nodiscard]] Result<Tuning> tune(const std::vector<TuneSeries>& series,
                                  const TuneOptions& options);

/// Consistency check of the filter with the estimated parameters.
[[nodiscard]] Consistency consistency_of(const Tuning& tuning);

/// Appends the channels of another tuning of the same model to `all`.
void append(Tuning& all, Tuning more);

}  // namespace proofmass::estimate
