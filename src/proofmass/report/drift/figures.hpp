#pragma once

#include <cstddef>
#include <string>

#include "proofmass/report/drift/report.hpp"
#include "proofmass/report/page/figure.hpp"

// The plots of `drift`. The channels must have an analysis, the runs a set.
namespace proofmass::report {

/// The block means with the fitted curve and its 95 % band, dashed where no warm-up is identified;
/// with a forecast up to its time.
[[nodiscard]] Figure drift_figure(const ChannelDrift& channel, const std::string& label);

/// Least and greatest samples, with the same curve.
[[nodiscard]] Figure samples_figure(const ChannelDrift& channel, const std::string& label);

/// Samples less the curve, at one of the scales of residuals.
[[nodiscard]] Figure residual_figure(const ChannelDrift& channel,
                                     std::size_t scale,
                                     const std::string& label);

/// Autocorrelation of the residuals with the bounds of white noise.
[[nodiscard]] Figure autocorrelation_figure(const signal::WhitenessTest& test,
                                            const std::string& label);

/// Profile likelihood of the time constant.
[[nodiscard]] Figure profile_figure(const ChannelDrift& channel, const std::string& label);

/// Bias against temperature; the channel must have a model of it.
[[nodiscard]] Figure temperature_figure(const ChannelDrift& channel, const std::string& label);

/// Turn-on value and mean of each run.
[[nodiscard]] Figure levels_figure(const ChannelRuns& runs);

}  // namespace proofmass::report
