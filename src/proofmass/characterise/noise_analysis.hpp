#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/characterise/allan/averaging_times.hpp"
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

// Noise of a sensor at rest: its components and their uncertainties.
namespace proofmass::characterise {

/// Content of a series.
enum class SeriesKind {
  rate,   ///< the quantity itself: acceleration
  phase,  ///< its integral over time
};

/// Source of the noise type used for the limits at each τ.
enum class NoiseTypeSource {
  model,  ///< the fitted terms, each weighted by its share of the variance at that τ
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
  bool exclude_events = false;     ///< exclude shocks, and terms that span steps
  std::optional<double> lsb = {};  ///< quantisation step, in the series' unit, if known
  std::size_t segment = 4096;      ///< of the spectrum
  Progress progress = {};
};

/// Noise of one of several equal parts of a recording.
struct NoisePart {
  double start_s = 0.0, end_s = 0.0;
  NoiseModelFit model;
};

/// Results for one channel at rest, in the channel's own unit.
struct NoiseAnalysis {
  double rate_hz = 0.0;
  std::size_t samples = 0;  ///< including missing ones
  std::size_t missing = 0;  ///< NaN, infinite, implausible, or dropped as events
  double duration_s = 0.0;
  double mean = 0.0;
  DeviationCurve deviation;
  Stationarity stationarity;
  std::vector<NoisePart> parts;  ///< in order; only if the noise is not stationary
  NoiseModelFit model;           ///< without ordinates if the record is too short
  signal::Spectrum spectrum;     ///< without bins if the record is too short
  signal::LineReport lines;
  std::vector<signal::Event> events;  ///< detected, whether dropped or not
  std::optional<double> lsb;
  std::vector<Note> notes;
};

/// Analyses a series sampled evenly at rate_hz, NaN where a sample is missing.
///
/// - The deviation counts only complete terms, with at most one in sixteen samples missing; these
///   are interpolated linearly. The degrees of freedom shrink with the share of remaining terms.
/// - Statistics that need the whole record use its longest stretch without a gap of more than eight
///   samples.
/// - Beyond a million samples terms start at every sixteenth of τ (allan/difference_variance.hpp).
/// - The coefficients come from the spectrum (noise_fit.hpp), without its lines.
/// - If the noise is not stationary, the results are averages over the recording, and their
///   intervals span those of its parts.
///
/// Errors: invalid_argument (options), too_few_samples (fewer than 3), not_finite (only missing
/// samples), not_observable (the samples are constant, vary by less than half a quantisation step,
/// or are clipped, so that no result would describe the sensor; the message states which). Cost:
/// O(N); additional memory equal to the series, twice that for the statistics that need all of it
/// at once.
[[nodiscard]] Result<NoiseAnalysis> analyse_noise(View<double> series, const NoiseOptions& options);

}  // namespace proofmass::characterise
