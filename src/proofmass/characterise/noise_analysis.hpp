#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/characterise/averaging_times.hpp"
#include "proofmass/characterise/deviation.hpp"
#include "proofmass/characterise/noise_model.hpp"
#include "proofmass/characterise/stationarity.hpp"
#include "proofmass/core/progress.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/core/view.hpp"
#include "proofmass/signal/events.hpp"
#include "proofmass/signal/spectral_lines.hpp"
#include "proofmass/signal/spectrum.hpp"

// A sensor at rest: what its noise is made of, and how well the recording says so.
namespace proofmass::characterise {

/// What a series holds.
enum class SeriesKind {
  rate,   ///< the quantity itself: acceleration
  phase,  ///< its integral over time
};

/// From what the limits' noise type at each τ comes.
enum class NoiseTypeSource {
  model,  ///< the fitted terms, each by its share of the variance at that τ
  lag1,   ///< the lag-1 autocorrelation of the phase averaged to τ
  fixed,  ///< NoiseOptions::alpha
};

struct NoiseOptions {
  double rate_hz = 0.0;
  SeriesKind kind = SeriesKind::rate;
  Statistic statistic = Statistic::oadev;
  TauGrid taus = {};
  double confidence = 0.683;  ///< of the deviation's limits
  NoiseTypeSource noise_type = NoiseTypeSource::model;
  int alpha = 0;                   ///< with NoiseTypeSource::fixed: 2 … −4
  bool exclude_events = false;     ///< leave out knocks, and terms that reach across steps
  std::optional<double> lsb = {};  ///< step of the converter, in the series' unit, where known
  std::size_t segment = 4096;      ///< of the spectrum
  Progress progress = {};
};

/// What an equal part of a recording is found to be made of by itself.
struct NoisePart {
  double start_s = 0.0, end_s = 0.0;
  NoiseModelFit model;
};

/// Everything about one channel at rest, in the channel's own unit.
struct NoiseAnalysis {
  double rate_hz = 0.0;
  std::size_t samples = 0;  ///< with those that are missing
  std::size_t missing = 0;  ///< NaN, infinite, absurd, or dropped as events
  double duration_s = 0.0;
  double mean = 0.0;
  DeviationCurve deviation;
  Stationarity stationarity;
  std::vector<NoisePart> parts;  ///< in order; only where the noise is not stationary
  NoiseModelFit model;           ///< without ordinates, where the record is too short for one
  signal::Spectrum spectrum;     ///< without bins, where it is too short for one
  signal::LineReport lines;
  std::vector<signal::Event> events;  ///< found, whether dropped or not
  std::optional<double> lsb;
  std::vector<Note> notes;
};

/// Analyses a series sampled evenly at rate_hz, NaN where a sample is missing.
///
/// The deviation counts only complete terms: those of whose samples at most one in sixteen is
/// missing, which then stand on the line between their neighbours; the degrees of freedom shrink
/// with the share of terms left. Statistics that need the whole record at once are of its longest
/// stretch without a gap of more than eight samples. Beyond a million samples terms start at every
/// sixteenth of τ (difference_variance.hpp). The coefficients come from the spectrum
/// (noise_fit.hpp), in which lines are left out. Where the noise is not stationary, the figures are
/// averages over the recording, and their intervals span those of its parts.
///
/// Errors: invalid_argument (options), too_few_samples (fewer than 3), not_finite (nothing but
/// missing samples), not_observable (the samples do not vary, or vary by less than half a step of
/// the converter, or are clipped, so that no figure would be the sensor's; the message says
/// which).
/// Cost: O(N); memory once more the series, twice for the statistics that need all of it at once.
[[nodiscard]] Result<NoiseAnalysis> analyse_noise(View<double> series, const NoiseOptions& options);

}  // namespace proofmass::characterise
