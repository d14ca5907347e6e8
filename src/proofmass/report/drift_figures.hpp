#pragma once

#include <vector>

#include "proofmass/report/drift_report.hpp"
#include "proofmass/report/figure.hpp"

// The plots of `drift`. The channels must have an analysis, the runs a set.
namespace proofmass::report {

/// The block means with what was fitted to them and its 95 % band; dashed where no warm-up is
/// identified. With a forecast, on to its time.
[[nodiscard]] Figure drift_figure(const ChannelDrift& channel, const std::string& label);

/// The readings, least and greatest, with the same curve.
[[nodiscard]] Figure readings_figure(const ChannelDrift& channel, const std::string& label);

/// Readings less the curve, one figure a scale.
[[nodiscard]] std::vector<Figure> residual_figures(const ChannelDrift& channel,
                                                   const std::string& label);

/// Autocorrelation of the residuals with the bounds of white noise, one figure a scale.
[[nodiscard]] std::vector<Figure> autocorrelation_figures(const ChannelDrift& channel,
                                                          const std::string& label);

/// How likely each time constant is.
[[nodiscard]] Figure profile_figure(const ChannelDrift& channel, const std::string& label);

/// Bias against temperature; the channel must have a model of it.
[[nodiscard]] Figure temperature_figure(const ChannelDrift& channel, const std::string& label);

/// Turn-on value and mean of each run.
[[nodiscard]] Figure levels_figure(const ChannelRuns& runs);

}  // namespace proofmass::report
