#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/characterise/drift_analysis.hpp"
#include "proofmass/characterise/noise_analysis.hpp"
#include "proofmass/core/progress.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/sensor/warm_up.hpp"
#include "proofmass/signal/whiteness.hpp"
#include "proofmass/thesis/item.hpp"

// Sections 4.3 and 5.1.1: two hours at rest, and the bias during them.
namespace proofmass::thesis {

/// One axis at rest, decimated by means over `StaticRecord::decimation` samples.
struct StaticAxis {
  std::string name;                ///< "x1", or the channel's
  std::vector<double> accel_mps2;  ///< NaN where missing
  /// One sample of each mean, as the thesis down-samples; empty without decimation.
  std::vector<double> picked_mps2 = {};
  std::vector<double> true_bias_mps2 = {};  ///< for each mean; empty: unknown
  std::optional<sensor::WarmUp> true_warm_up = {};
};

struct StaticRecord {
  std::string source;  ///< the file, or "simulated"
  bool simulated = false;
  double rate_hz = 0.0;            ///< of the values kept
  std::size_t decimation = 1;      ///< samples in each value
  double since_switch_on_s = 0.0;  ///< time from power-on to the first of them
  std::vector<StaticAxis> axes;    ///< in the plane of the wheel, sensor by sensor
};

/// Channels as sampled (`accel_mps2` alone), averaged down to 40 Hz or a little more, or until 500
/// 000 values are left. A mean is NaN if half of its samples or more are not finite, else that of
/// the others; an incomplete block at the end is omitted. rate_hz > 0.
[[nodiscard]] StaticRecord static_record(std::string source,
                                         double rate_hz,
                                         double since_switch_on_s,
                                         std::vector<StaticAxis> raw);

/// The rig at rest from power-on: 1 kHz, two ADXL335 with 50 Hz filters, their x and y axes level,
/// the warm-up of table 4.1 in each, means over 25 samples. The same seed gives the same numbers.
/// Cost: two hours take some 5 s of one processor, and memory for the means alone.
[[nodiscard]] Result<StaticRecord> simulate_static(std::uint64_t seed,
                                                   const Progress& progress,
                                                   double duration_s = 7200.0);

/// a1, a2 and T as in the thesis: least squares by Levenberg and Marquardt on the picked samples,
/// with the standard deviations that this method states.
struct PlainFit {
  Uncertain a1_mps2 = {}, a2_mps2 = {}, time_constant_s = {};
  /// Tests of all picked samples, and of some 2000 of them, as many as a plot shows; absent if they
  /// are too few.
  std::optional<signal::WhitenessTest> residuals = {}, few_residuals = {};
};

/// A bias followed through the record.
struct BiasTrack {
  std::vector<double> t_s = {}, value_mps2 = {};  ///< thinned for display
  std::vector<double> std_mps2 = {};              ///< as stated by the filter; for each value
  double mean_nis = 0.0;                      ///< of the innovations: 1 if the model fits the data
  Uncertain last_mps2 = {};                   ///< at the end of the record
  std::optional<double> rms_error_mps2 = {};  ///< against the truth, if known
  std::optional<double> inside_95 = {};       ///< share of the truth within ±1.96 std
};

/// Figure 5.3 for one axis.
struct BiasTracks {
  BiasTrack thesis = {};    ///< its filter, with its errors corrected; empty if it has no curve
  BiasTrack filtered = {};  ///< ours, as it would be online
  BiasTrack smoothed = {};
  BiasTrack raw = {};  ///< the means themselves, against the same truth; no NIS, no std
};

/// Result for one axis, or the reason for its absence.
struct AxisTest {
  std::optional<characterise::DriftAnalysis> drift = {};
  std::optional<Error> refused = {};   ///< why there is no analysis
  std::optional<PlainFit> plain = {};  ///< absent if the descent finds no minimum
  std::optional<BiasTracks> tracks = {};
};

/// The noise about its curve, of the first axis that could be analysed. Use the coefficients of
/// `slow`, means over 1 s if the record is long enough: means of a few samples do not have the
/// spectrum of a one-pole filter.
struct DecimationNoise {
  std::optional<characterise::NoiseAnalysis> means = {}, picked = {}, slow = {};
};

struct StaticTest {
  StaticRecord record;
  std::vector<AxisTest> axes;  ///< for each axis of the record
  DecimationNoise noise;
};

/// Errors: if no axis can be analysed, that of the first; too_few_samples (no axis).
[[nodiscard]] Result<StaticTest> analyse_static(StaticRecord record, const Progress& progress);

/// Figures 4.5 and 4.6, table 4.1, figures 5.2 and 5.3.
[[nodiscard]] std::vector<Item> static_items(const StaticTest& test);

}  // namespace proofmass::thesis
