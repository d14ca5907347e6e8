#pragma once

#include <cstddef>

#include "proofmass/report/page/figure.hpp"
#include "proofmass/report/tune/report.hpp"

namespace proofmass::report {

/// Normalised innovations of a channel against time, with where 95 % of them should lie.
[[nodiscard]] Figure innovations_figure(const TuneReport& report, std::size_t channel);

/// Whether the innovations of a channel were tested for whiteness.
[[nodiscard]] bool has_whiteness(const TuneReport& report, std::size_t channel);

/// Autocorrelation of a channel's innovations at the sample. Precondition: has_whiteness().
[[nodiscard]] Figure autocorrelation_figure(const TuneReport& report, std::size_t channel);

/// Gain of the acceleration against time, each case with where it has settled.
[[nodiscard]] Figure gain_figure(const estimate::TuneStudy& study);
/// Standard deviations of position, velocity and acceleration against time, as tuned.
[[nodiscard]] Figure covariance_figure(const estimate::TuneStudy& study);
/// Standard deviation of the acceleration against the step.
[[nodiscard]] Figure step_figure(const estimate::TuneStudy& study);

}  // namespace proofmass::report
