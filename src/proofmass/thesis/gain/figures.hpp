#pragma once

#include "proofmass/report/page/figure.hpp"
#include "proofmass/thesis/gain/readings.hpp"

// Our versions of figures 4.3 and 5.7 to 5.10 of the thesis.
namespace proofmass::thesis {

/// The simulation of section 5.2 with the Q and R of figures 5.7 and 5.8.
inline constexpr estimate::GainStudyOptions quick_filter{.jerk_psd_m2ps5 = 4.0,
                                                         .accel_variance_m2ps4 = 1.0};
/// The same with those of figures 5.9 and 5.10.
inline constexpr estimate::GainStudyOptions slow_filter{.jerk_psd_m2ps5 = 1.0,
                                                        .accel_variance_m2ps4 = 4.0};

/// Variance of the acceleration after each of the first 40 measurements; `slowest_r` is the R for
/// which it falls below 10 after 20.
[[nodiscard]] report::Figure covariance_figure(double slowest_r_m2ps4);

/// Effect of the step length on the final variance.
[[nodiscard]] report::Figure step_figure();

/// Variances of position, velocity and acceleration against time.
[[nodiscard]] report::Figure growth_figure(const estimate::GainStudy& study);

/// Truth, measurements, filter and smoother over the first half minute.
[[nodiscard]] report::Figure readings_figure(const SimulatedReadings& readings, SimulatedAxis axis);

/// The three gains over the first ten seconds.
[[nodiscard]] report::Figure gain_figure(const estimate::GainStudy& study);

/// Settling time against the settling tolerance.
[[nodiscard]] report::Figure tolerance_figure();

}  // namespace proofmass::thesis
