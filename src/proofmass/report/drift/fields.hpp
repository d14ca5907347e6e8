#pragma once

#include <optional>
#include <string>

#include "proofmass/report/drift/report.hpp"

// Entries of the document of `drift`.
namespace proofmass::report {

/// The figure with its standard deviation, without its interval.
[[nodiscard]] std::optional<Uncertain> uncertain(
    const std::optional<characterise::Interval95>& figure);

/// A figure of a fit; null with the reason in `about` if it is absent or has no finite standard
/// deviation.
[[nodiscard]] Field interval_estimate(const char* key,
                                      const std::optional<characterise::Interval95>& figure,
                                      const std::string& unit,
                                      About about);

/// [lower, upper]; null with the reason `why` if not defined.
[[nodiscard]] Field interval_ends(const char* key,
                                  const std::optional<characterise::Interval95>& figure,
                                  const std::string& why,
                                  std::string meaning = {});

[[nodiscard]] Field shape_field(characterise::DriftShape shape, std::string meaning = {});
[[nodiscard]] Field verdict_field(bool identified);
[[nodiscard]] Field reason_field(std::string_view code);

/// The entries of a channel: fit, whiteness, temperature and forecast.
[[nodiscard]] Fields drift_fields(const ChannelDrift& channel);

[[nodiscard]] Field temperature_field(const DriftTemperature& found, const Unit& unit);

/// The entries of a channel over several runs.
[[nodiscard]] Fields runs_fields(const ChannelRuns& runs);

/// The warm-up common to all runs, in the form of a channel. Precondition: the runs have a set.
[[nodiscard]] ChannelDrift common_warm_up(const ChannelRuns& runs);

}  // namespace proofmass::report
