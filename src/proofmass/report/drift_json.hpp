#pragma once

#include "proofmass/report/drift_report.hpp"
#include "proofmass/report/json.hpp"

// Parts of the document of `drift`.
namespace proofmass::report {

/// A channel with its fit, whiteness, temperature and forecast.
[[nodiscard]] Object drift_object(const ChannelDrift& channel);

[[nodiscard]] Object runs_object(const ChannelRuns& runs);

/// Null where there is no model.
[[nodiscard]] Value temperature_value(const DriftTemperature& found, const Unit& unit);

/// Null where there is no forecast.
[[nodiscard]] Value forecast_value(const DriftOutlook& outlook, const Unit& unit);

/// [lower, upper], an open end null; null where there is no figure.
[[nodiscard]] Value interval_value(const std::optional<characterise::Interval95>& figure);

/// {"value", "std", "unit"}
[[nodiscard]] Value interval_quantity(const std::optional<characterise::Interval95>& figure,
                                      std::string_view unit);

}  // namespace proofmass::report
