#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/characterise/drift_model.hpp"
#include "proofmass/core/progress.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/core/view.hpp"
#include "proofmass/signal/events.hpp"
#include "proofmass/signal/whiteness.hpp"

// The static bias test: a sensor at rest from the moment it is switched on, what its bias does, and
// whether the recording can tell.
namespace proofmass::characterise {

struct DriftOptions {
  double rate_hz = 0.0;
  double since_switch_on_s = 0.0;  ///< how long the sensor had been on at the first sample
  Progress progress = {};
};

/// A long series as people can look at it: the least and greatest value in each stretch.
struct Envelope {
  double scale_s = 0.0;  ///< of the means whose extremes these are; one sample or more
  std::vector<double> t_s, lower, upper;
};

/// All about one channel, in its own unit u. Times are since switching on.
struct DriftAnalysis {
  double rate_hz = 0.0;
  std::size_t samples = 0;
  std::size_t missing = 0;  ///< NaN, infinite, absurd, or of knocks, which are left out
  double start_s = 0.0;     ///< of the first sample
  double duration_s = 0.0;
  double block_s = 0.0;            ///< the fit is of means over so long
  std::vector<double> block_mean;  ///< NaN where missing
  /// The bias in each block, white noise filtered off: curve and wander together.
  std::vector<double> block_bias;

  DriftFit fit;
  double residual_rms = 0.0;  ///< of the samples about fit.curve
  /// Of the samples less the curve: at the sampling interval, 1 s, 10 s, 100 s … as far as the
  /// recording reaches. They test what a plain fit takes for granted; the intervals do not need it.
  std::vector<signal::WhitenessTest> whiteness;
  /// Of the block means less curve and noise model: whether the noise is what the fit took it for.
  /// None where there are too few blocks.
  std::optional<signal::WhitenessTest> whitened;
  bool noise_explained = true;  ///< none of its three p is below a thousandth

  /// Since switching on, at the middle of a block.
  [[nodiscard]] double block_time_s(std::size_t block) const {
    return start_s + (static_cast<double>(block) + 0.5) * block_s - 0.5 / rate_hz;
  }

  Envelope data;
  std::vector<Envelope> residuals;  ///< at up to three scales
  std::vector<signal::Event> knocks;
  std::vector<Note> notes;
};

/// Analyses a series sampled evenly at rate_hz, NaN where a sample is missing.
///
/// Errors: invalid_argument (options), too_few_samples (fewer than 12 blocks can be made, or more
/// than half of them are missing), not_finite (nothing but missing samples), not_observable (the
/// samples, or the means over blocks, do not vary), unsupported (means above 1e60, or that vary by
/// less than 1e-60). Cost: O(N), then some hundred passes over up to 2048 blocks.
[[nodiscard]] Result<DriftAnalysis> analyse_drift(View<double> series, const DriftOptions& options);

}  // namespace proofmass::characterise
