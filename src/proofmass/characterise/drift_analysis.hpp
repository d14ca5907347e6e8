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

// The static bias test: the bias of a sensor at rest from power-on, and what the recording
// determines of it.
namespace proofmass::characterise {

struct DriftOptions {
  double rate_hz = 0.0;
  double since_switch_on_s = 0.0;  ///< time from power-on to the first sample
  Progress progress = {};
};

/// A long series reduced for display: minimum and maximum in each stretch.
struct Envelope {
  double scale_s = 0.0;  ///< averaging time of the values; one sample or more
  std::vector<double> t_s, lower, upper;
};

/// Results for one channel, in its own unit u. Times are since power-on.
struct DriftAnalysis {
  double rate_hz = 0.0;
  std::size_t samples = 0;
  std::size_t missing = 0;  ///< NaN, infinite, implausible, or excluded shocks
  double start_s = 0.0;     ///< time of the first sample
  double duration_s = 0.0;
  double block_s = 0.0;            ///< averaging time of the fitted means
  std::vector<double> block_mean;  ///< NaN where missing
  /// The bias in each block, without white noise: curve plus drift.
  std::vector<double> block_bias;

  DriftFit fit;
  double residual_rms = 0.0;  ///< of the samples about fit.curve
  /// Tests of the samples minus the curve: at the sampling interval, 1 s, 10 s, 100 s … as far as
  /// the recording reaches. They test the assumptions of a plain fit; the intervals do not depend
  /// on them.
  std::vector<signal::WhitenessTest> whiteness;
  /// Test of the block means minus curve and noise model: whether the noise model is adequate.
  /// Absent if there are too few blocks.
  std::optional<signal::WhitenessTest> whitened;
  bool noise_explained = true;  ///< none of its three p is below a thousandth

  /// Time since power-on at the middle of a block.
  [[nodiscard]] double block_time_s(std::size_t block) const {
    return start_s + (static_cast<double>(block) + 0.5) * block_s - 0.5 / rate_hz;
  }

  Envelope data;
  std::vector<Envelope> residuals;  ///< at up to three scales
  std::vector<signal::Event> outliers;
  std::vector<Note> notes;
};

/// Analyses a series sampled evenly at rate_hz, NaN where a sample is missing.
///
/// Errors: invalid_argument (options), too_few_samples (fewer than 12 blocks can be made, or more
/// than half of them are missing), not_finite (only missing samples), not_observable (the samples,
/// or the means over blocks, are constant), unsupported (means above 1e60, or a variation of less
/// than 1e-60). Cost: O(N), then some hundred passes over up to 2048 blocks.
[[nodiscard]] Result<DriftAnalysis> analyse_drift(View<double> series, const DriftOptions& options);

}  // namespace proofmass::characterise
