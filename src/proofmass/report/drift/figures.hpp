#pragma once

#include <cstddef>
#include <string>

#include "proofmass/report/drift/report.hpp"
#include "proofmass/report/page/figure.hpp"

// The plots of `drift`. Preconditions: channels have an analysis, runs have a set.
namespace proofmass::report {

/// Block means with the fitted curve and its 95 % band; dashed if no warm-up is identified. Extends
/// to the time of the forecast, if any.
[[nodiscard]] Figure drift_figure(const ChannelDrift& channel, const std::string& label);

/// Minima and maxima of the samples, with the same curve.
[[nodiscard]] Figure samples_figure(const ChannelDrift& channel, const std::string& label);

/// Samples minus the curve, at one of the three averaging scales.
[[nodiscard]] Figure residual_figure(const ChannelDrift& channel,
                                     std::size_t scale,
                                     const std::string& label);

/// Autocorrelation of the residuals, with the bounds for white noise.
[[nodiscard]] Figure autocorrelation_figure(const signal::WhitenessTest& test,
                                            const std::string& label);

/// Profile likelihood of the time constant.
[[nodiscard]] Figure profile_figure(const ChannelDrift& channel, const std::string& label);

/// Bias against temperature. Precondition: the channel has a temperature model.
[[nodiscard]] Figure temperature_figure(const ChannelDrift& channel, const std::string& label);

/// Turn-on value and mean of each run.
[[nodiscard]] Figure levels_figure(const ChannelRuns& runs);

}  // namespace proofmass::report
