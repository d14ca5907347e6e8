#pragma once

#include <array>
#include <string>
#include <vector>

#include "proofmass/report/drift_report.hpp"

// What a drift document may have to leave open, and why it does.
namespace proofmass::report {

// Keys that are null together, without an analysis, and those of a set of runs.
inline constexpr std::array drift_keys{"model",
                                       "a1",
                                       "a2",
                                       "time_constant_s",
                                       "bears_gravity",
                                       "possible_models",
                                       "interval_95",
                                       "residual_rms",
                                       "tests",
                                       "noise",
                                       "whitened",
                                       "rate_hz",
                                       "samples",
                                       "missing",
                                       "start_s",
                                       "duration_s",
                                       "block_s",
                                       "undetected_below",
                                       "best_time_constant_s"};
inline constexpr std::array run_set_keys{"window_s",      "duration_s", "turn_on",     "level",
                                         "trend_per_run", "trend_p",    "level_curve", "warm_up"};

/// A sentence, with the channel's name, for each group of nulls in its part of the document.
[[nodiscard]] std::vector<std::string> null_reasons(const DriftReport& report,
                                                    const ChannelDrift& channel);
[[nodiscard]] std::vector<std::string> null_reasons(const ChannelRuns& runs);

}  // namespace proofmass::report
