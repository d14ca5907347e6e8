#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/core/view.hpp"

namespace proofmass::signal {

/// A stretch in which the sensor lay still. It may hold single outliers, samples that are no
/// measurement, and a knock of up to a window that left level and place as they were.
struct Rest {
  std::size_t first, last;  ///< samples, inclusive
};

struct RestOptions {
  double rate_hz = 0.0;  ///< 0: unknown
  /// Absent: 0.5 s. Where the rate is unknown, 100 samples are 1 s.
  std::optional<double> shortest_s = std::nullopt;
};

struct RestSearch {
  std::vector<Rest> rests;        ///< ascending, not overlapping
  std::vector<double> noise_std;  ///< of one resting sample about its window's mean, one an axis
  std::size_t window = 0;         ///< samples over which a variance is taken: 0.5 s or `shortest_s`
  std::string why_none;           ///< in words, where there is no rest
};

/// Finds the stretches in which a sensor of one to three axes lay still, by the noise that it has
/// where the recording is quietest. In blocks of an eighth of a window:
///
/// 1. The noise is that of the quietest well-filled set of windows (see rest_noise.hpp). If the
///    means of its windows swing as far as samples scatter, as in a hand, on a pendulum or on a
///    turning wheel, there is no rest. A swing shorter than two blocks counts as vibration.
/// 2. A rest is at most three times as noisy, which leaves room for other positions (see
///    rest_runs.hpp).
/// 3. Means of neighbouring stretches of 1, 2, 4, … blocks up to 16 windows agree within what the
///    Allan deviation of the rests allows, so that a slow turn is no rest, but drift is.
/// 4. Ends that are louder than the rest or depart from it are taken off (rest_ends.hpp). At least
///    a block is lost next to motion, so that a rest has to last four blocks more than shortest_s.
///
/// Neither offsets nor the unit count. What settles as slowly as in most of the rests, over
/// seconds, is taken for drift.
///
/// Source: the noise of the resting sensor as a scale for the variance of windows: D. Tedaldi,
/// A. Pretto, E. Menegatti, A robust and easy to implement method for IMU calibration without
/// external equipments, ICRA (2014), whose static detector is given a first rest of known length.
///
/// NaN, infinities and what is no measurement on one axis (is_plausible) count as missing on all;
/// more than a window of them ends a rest, as does a reading that is stuck for a window.
/// Errors: none; `why_none`. Expects axes of the same length, rate_hz ≥ 0, shortest_s > 0.
/// Cost: O(N log N), 6 ms for 51 175 samples of three axes; allocates about four doubles a sample.
[[nodiscard]] RestSearch find_rests(View<View<double>> axes, const RestOptions& options);

}  // namespace proofmass::signal
