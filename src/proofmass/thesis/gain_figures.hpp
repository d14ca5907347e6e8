#pragma once

#include "proofmass/report/figure.hpp"
#include "proofmass/thesis/gain_readings.hpp"

// Figures 4.3 and 5.7 to 5.10 of the thesis, as we draw them.
namespace proofmass::thesis {

/// The simulation of section 5.2 with the Q and R of figures 5.7 and 5.8.
inline constexpr estimate::GainStudyOptions quick_filter{.jerk_psd_m2ps5 = 4.0,
                                                         .accel_variance_m2ps4 = 1.0};
/// And with those of figures 5.9 and 5.10.
inline constexpr estimate::GainStudyOptions slow_filter{.jerk_psd_m2ps5 = 1.0,
                                                        .accel_variance_m2ps4 = 4.0};

/// Variance of the acceleration after each of the first 40 readings; `slowest_r` is the R by which
/// it takes 20 of them to come below 10.
[[nodiscard]] report::Figure covariance_figure(double slowest_r_m2ps4);

/// What the length of the step does to the variance in the end.
[[nodiscard]] report::Figure step_figure();

/// Variances of position, velocity and acceleration against time.
[[nodiscard]] report::Figure growth_figure(const estimate::GainStudy& study);

/// Truth, readings, filter and smoother over the first half minute.
[[nodiscard]] report::Figure readings_figure(const SimulatedReadings& readings, SimulatedAxis axis);

/// The three gains over the first ten seconds.
[[nodiscard]] report::Figure gain_figure(const estimate::GainStudy& study);

/// Time of settling against what is called settled.
[[nodiscard]] report::Figure tolerance_figure();

}  // namespace proofmass::thesis
