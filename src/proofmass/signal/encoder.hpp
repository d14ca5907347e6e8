#pragma once

#include <cstddef>
#include <numbers>
#include <optional>
#include <vector>

#include "proofmass/core/view.hpp"

// Incremental encoders: from counts or edges to an angle, and the whole counts that were missed.
namespace proofmass::signal {

/// Counts or an angle as recorded, unwrapped, in radians. A glitch is a single value that both its
/// neighbours contradict; it becomes NaN.
struct UnwrappedAngle {
  std::vector<double> angle_rad;
  std::size_t glitches = 0;
};

/// Unwraps values that repeat every `modulus` (0: they do not wrap) and multiplies them by
/// rad_per_unit. NaN where the recording has no number.
[[nodiscard]] UnwrappedAngle unwrap_angle(View<double> values, double modulus, double rad_per_unit);

/// Angles at times, each with its standard deviation. Between them the encoder shows nothing new.
struct AngleFixes {
  std::vector<double> time_s, angle_rad, std_rad;
};

/// What sampled counts show of the angle, for a count of step_rad:
///
/// - a change by one count between two samples: the boundary between the counts, at the middle of
///   the interval, with the standard deviation ω Δt/√12 of the unknown moment;
/// - a change by more: the mean of both counts' middles, at the middle of the interval, step/√12.
///   (The angle at a sample is not uniform in its count: at one and a half counts a sample, after a
///   change by two it is in the first half.)
/// - no change: nothing. If nothing changes for half a second: the middle of the count once, since
///   later samples repeat that error.
///
/// A step of 0 is an angle without visible steps: every sample, std_rad each.
[[nodiscard]] AngleFixes fixes_of_samples(View<double> time_s,
                                          View<double> angle_rad,
                                          double step_rad,
                                          double std_rad);

/// The same from stamped edges: `angle_rad` is the count after each edge times the step, and each
/// edge is at the boundary that it crosses. A change by more than one count contains missed edges,
/// and is the boundary reached last. `stamp_std_s`: of the stamps.
[[nodiscard]] AngleFixes fixes_of_edges(View<double> time_s,
                                        View<double> angle_rad,
                                        double step_rad,
                                        double stamp_std_s);

/// Angle, speed and acceleration at given times.
struct AngleMotion {
  std::vector<double> angle_rad, speed_radps, accel_radps2;
};

inline constexpr double twelfth_of_turn_rad = std::numbers::pi / 6.0;

/// Local polynomials of fourth degree over `half_rad` to either side (at most 1 s, at least five
/// fixes), evaluated at bins of a 256th of a turn (at most 0.1 s) and interpolated between them.
/// NaN outside the fixes. Over a twelfth of a turn to either side, the angle has all but 4e-5 of a
/// ripple twice a turn, speed and acceleration all but 0.25 %; parabolas over half of that, whose
/// noise is larger, attenuate both by 2 to 3 %. Source: A. Savitzky, M. J. E. Golay, Analytical
/// Chemistry 36 (1964) 1627. Cost: O(fixes + bins + times).
[[nodiscard]] AngleMotion motion_at(const AngleFixes& fixes,
                                    View<double> time_s,
                                    double half_rad = twelfth_of_turn_rad);

/// A lasting difference by whole counts between an encoder and a reference.
struct CountSlip {
  double time_s = 0.0;
  double start_s = 0.0, end_s = 0.0;  ///< 95 % interval of the time
  int counts = 0;                     ///< added to the encoder's count: −3 if three were missed
};

/// Finds steps of whole counts in `offset_rad`, the encoder less a reference in bins of equal
/// weight, NaN where missing.
///
/// For each width w of 4, 8, 16 … bins the difference of the means before and after every boundary
/// is compared with the scatter of these differences over the recording (median absolute
/// deviation), which contains the reference's noise of any colour. A step is accepted if a
/// difference exceeds the maximum that chance gives in a thousandth of such recordings, and is a
/// whole number of counts within its uncertainty. Greedy: the most significant step is removed, and
/// the search repeated.
///
/// Source: D. M. Hawkins, Testing a sequence of observations for a shift in location, J. Am. Stat.
/// Assoc. 72 (1977) 180 (the statistic; several widths and the robust scatter are added). Cost:
/// O(bins log bins) a step.
[[nodiscard]] std::vector<CountSlip> find_count_slips(View<double> time_s,
                                                      View<double> offset_rad,
                                                      double step_rad);

/// Moves slips that have been removed to the boundaries, within 24 bins, at which the residual
/// leaves the least squares, and sets their intervals: the boundaries whose sum of squares is
/// larger by up to 4 variances. A fit made while a step was still there bends to it and moves it by
/// some bins. `residual_rad`: the offset less its fit, in bins, NaN where missing. Returns whether
/// any moved.
[[nodiscard]] bool relocate_slips(View<double> time_s,
                                  View<double> residual_rad,
                                  double step_rad,
                                  std::vector<CountSlip>& slips);

/// Smallest whole number of counts that find_count_slips() would detect in such data with a
/// probability of one half, anywhere but near the ends; nullopt for too few bins.
[[nodiscard]] std::optional<int> detectable_counts(View<double> offset_rad, double step_rad);

/// Subtracts the slips from everything after them.
void remove_slips(View<CountSlip> slips, double step_rad, AngleFixes& fixes);

}  // namespace proofmass::signal
