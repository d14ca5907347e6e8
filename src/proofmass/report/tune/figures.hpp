#pragma once

#include <cstddef>

#include "proofmass/report/page/figure.hpp"
#include "proofmass/report/tune/report.hpp"

namespace proofmass::report {

/// Normalised innovations of a channel against time, with the expected 95 % limits.
[[nodiscard]] Figure innovations_figure(const TuneReport& report, std::size_t channel);

/// True if the innovations of a channel were tested for whiteness.
[[nodiscard]] bool has_whiteness(const TuneReport& report, std::size_t channel);

/// Autocorrelation of a channel's innovations at single samples. Precondition: has_whiteness().
[[nodiscard]] Figure autocorrelation_figure(const TuneReport& report, std::size_t channel);

/// Gain of the acceleration against time, with the settling time of each case.
[[nodiscard]] Figure gain_figure(const estimate::TuneStudy& study);
/// Standard deviations of position, velocity and acceleration against time, as tuned.
[[nodiscard]] Figure covariance_figure(const estimate::TuneStudy& study);
/// Standard deviation of the acceleration against the time step.
[[nodiscard]] Figure step_figure(const estimate::TuneStudy& study);

}  // namespace proofmass::report
