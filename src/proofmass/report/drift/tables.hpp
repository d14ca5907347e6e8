#pragma once

#include <array>
#include <string>
#include <vector>

#include "proofmass/report/drift/report.hpp"
#include "proofmass/report/page/page.hpp"
#include "proofmass/signal/whiteness.hpp"

// The tables of `drift`. Preconditions: channels have an analysis, runs have a set.
namespace proofmass::report {

[[nodiscard]] Table parameters_table(const ChannelDrift& channel);
[[nodiscard]] Table steps_table(const ChannelDrift& channel);
[[nodiscard]] Table whiteness_table(const characterise::DriftAnalysis& analysis);
/// A row of that table; `name` labels the series.
[[nodiscard]] std::vector<std::string> whiteness_row(const std::string& name,
                                                     const signal::WhitenessTest& test);
[[nodiscard]] Table candidates_table(const characterise::DriftFit& fit);

/// Times for which the position error due to a bias is given.
inline constexpr std::array integration_times_s{1.0, 10.0, 60.0};

/// Position error due to the bias. Precondition: the series is in m/s².
[[nodiscard]] Table position_table(const characterise::DriftForecast& forecast);

/// Precondition: the channel has a temperature model.
[[nodiscard]] Table temperature_table(const ChannelDrift& channel);

[[nodiscard]] Table runs_table(const ChannelRuns& runs);

}  // namespace proofmass::report
