#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/core/view.hpp"

namespace proofmass::signal {

/// An interval in which the sensor was static. It may contain single outliers, implausible samples,
/// and a shock of up to one window that left level and position unchanged.
struct Rest {
  std::size_t first, last;  ///< samples, inclusive
};

struct RestOptions {
  double rate_hz = 0.0;  ///< 0: unknown
  /// Absent: 0.5 s. If the rate is unknown, 100 samples count as 1 s.
  std::optional<double> shortest_s = std::nullopt;
};

struct RestSearch {
  std::vector<Rest> rests;        ///< ascending, not overlapping
  std::vector<double> noise_std;  ///< std of one static sample about its window's mean, per axis
  std::size_t window = 0;         ///< samples per variance window: 0.5 s or `shortest_s`
  std::string why_none;           ///< the reason, if there is no rest
};

/// Finds the intervals in which a sensor of one to three axes was static, from its noise where the
/// recording is quietest. In blocks of an eighth of a window:
///
/// 1. The noise is that of the quietest well-filled set of windows (see rests/noise.hpp). If the
///    means of its windows vary as much as the samples, as in a hand, on a pendulum or on a turning
///    wheel, there is no rest. An oscillation shorter than two blocks counts as vibration.
/// 2. A rest is at most three times as noisy, which allows for other positions (see
/// rests/runs.hpp).
/// 3. Means of adjacent intervals of 1, 2, 4, … blocks up to 16 windows agree within the Allan
///    deviation of the rests: a slow rotation is excluded, drift is not.
/// 4. Ends that are noisier than the rest or deviate from it are removed (rests/ends.hpp). At least
///    one block is lost next to motion, so a rest has to last four blocks more than shortest_s.
///
/// Neither offsets nor the unit matter. Settling over seconds, if it is as slow as in most of the
/// rests, counts as drift.
///
/// Source: the noise of the static sensor as a scale for the variance of windows: D. Tedaldi, A.
/// Pretto, E. Menegatti, A robust and easy to implement method for IMU calibration without external
/// equipments, ICRA (2014), whose static detector is given a first rest of known length.
///
/// NaN, infinities and implausible values (is_plausible) on one axis count as missing on all; more
/// than a window of them ends a rest, as does a value that is stuck for half a window.
/// Errors: none; see `why_none`. Expects axes of equal length, rate_hz ≥ 0, shortest_s > 0.
/// Cost: O(N log N), 6 ms for 51 175 samples of three axes; allocates about four doubles per
/// sample.
[[nodiscard]] RestSearch find_rests(View<View<double>> axes, const RestOptions& options);

/// Intervals of a quarter of a second and more in which no axis changes, although the sensor has
/// noise beyond its quantisation step where it rests otherwise: it was stuck, or its logger
/// repeated the last sample. None if they are a third of the recording: the sensor may have no
/// noise then. Expects what find_rests() does.
[[nodiscard]] std::vector<Rest> stuck_intervals(View<View<double>> axes,
                                                const RestOptions& options);

}  // namespace proofmass::signal
