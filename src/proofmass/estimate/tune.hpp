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
#include "proofmass/estimate/tune_model.hpp"

// Noise figures of a filter's model from the recording that it is to run on.
namespace proofmass::estimate {

/// One channel. Each segment starts anew, knowing nothing: the rests of a recording, say.
struct TuneSeries {
  std::string name;
  double rate_hz = 1.0;
  std::vector<View<double>> segments;  ///< evenly sampled, NaN where a reading is missing
  std::vector<double> starts_s = {};   ///< of each segment; empty: one behind the other
};

/// A parameter held at a value: of all channels.
struct FixedParameter {
  std::string name;
  double value = 0.0;
};

struct TuneOptions {
  TuneModel model = TuneModel::rest;
  std::vector<FixedParameter> fixed = {};
  std::vector<std::string> shared = {};  ///< names of parameters that all channels have in common
  /// Where to start instead of at the Allan deviation: by name, of all channels.
  std::vector<FixedParameter> start = {};
  int em_steps = 4;
  Progress progress = {};
};

enum class TuneVerdict {
  identified,
  not_observable,  ///< the data go with zero, or with any value: see `reason`
  fixed,
};

struct TunedParameter {
  std::string name;
  TuneRole role = TuneRole::reading;
  int channel_power = 1;  ///< of the unit, see TuneParameter
  double second_power = 0.0;
  std::optional<std::size_t> series;  ///< absent: shared by all
  TuneVerdict verdict = TuneVerdict::identified;
  std::optional<Uncertain> value;  ///< std 0 of a fixed one
  std::optional<double> lower_95, upper_95;
  std::string reason;                     ///< where there is no value
  std::optional<double> record_needed_s;  ///< about how long a record would tell it
  double start = 0.0, after_em = 0.0;     ///< on the way
};

/// What one channel comes to.
struct TunedSeries {
  std::string name;
  std::vector<double> values;  ///< of the model's parameters as used, one not observable being 0
  TuneSystem system;           ///< with them
  double log_likelihood = 0.0;
  std::size_t readings = 0, missing = 0;
  double rate_hz = 0.0, duration_s = 0.0;
  /// Of all segments; NaN where there is no reading, and at the start of each.
  std::vector<double> time_s, innovation, variance;
};

struct Tuning {
  TuneModel model = TuneModel::rest;
  std::vector<TunedParameter> parameters;
  std::vector<TunedSeries> series;
  double log_likelihood = 0.0;            ///< of all channels
  std::vector<double> em_log_likelihood;  ///< before each step and behind the last
  int iterations = 0;                     ///< of the maximisation
  double gradient = 0.0;                  ///< largest |∂L/∂ ln θ| at the end
  bool converged = false;
};

/// Finds the parameters of the model by maximum likelihood: a start from the Allan variance (and
/// where that cannot tell, from a grid), steps of expectation–maximisation, a quasi-Newton search
/// with the exact gradient, Newton's last steps.
///
///     std = θ √(H⁻¹)ⱼⱼ,   H = −∂²L/∂ln θ²  by differences of the gradient;
///     interval_95: θ e^(±1.96 √(H⁻¹)ⱼⱼ), or where that is wider than ±20 %, where twice the loss
///     in log-likelihood, all else fitted anew, stays below 3.84.
///
/// A noise whose absence costs less than 3.84 in twice the log-likelihood is not told from zero: it
/// has no value but an upper 95 % limit (2.71), and the others are fitted without it. Channels are
/// fitted each by itself unless they share a parameter.
///
/// Source: J. Durbin, S. J. Koopman (2012), chapter 7; EM: R. H. Shumway, D. S. Stoffer, J. Time
/// Series Anal. 3 (1982) 253. Errors: invalid_argument (a name that the model does not have, a
/// value that cannot be), too_few_samples (fewer than 10 readings of a channel), not_observable (a
/// channel whose readings are all equal), not_finite (an infinite reading). Cost: 20 to 80 passes
/// over the data.
[[nodiscard]] Result<Tuning> tune(const std::vector<TuneSeries>& series,
                                  const TuneOptions& options);

/// Whether the filter, with the figures found, errs as far as it says.
[[nodiscard]] Consistency consistency_of(const Tuning& tuning);

/// Puts the channels of a tuning of its own behind those of `all`, both of one model.
void append(Tuning& all, Tuning more);

}  // namespace proofmass::estimate
