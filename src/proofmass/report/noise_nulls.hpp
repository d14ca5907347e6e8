#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/report/noise_report.hpp"

// What a noise document may have to leave open, and why it does.
namespace proofmass::report {

// Keys that are null together: without coefficients, without a spectrum, without an analysis.
inline constexpr std::array coefficient_keys{"parameters", "slow_change", "bandwidth_hz", "misfit",
                                             "filter"};
inline constexpr std::array spectrum_keys{"spectrum_floor", "spectrum_floor_two_sided", "spectrum"};
inline constexpr std::array record_keys{"samples",    "missing", "rate_hz",
                                        "duration_s", "mean",    "lsb"};

[[nodiscard]] inline bool is_identified(const characterise::Coefficient& coefficient) {
  return coefficient.verdict == characterise::Verdict::identified;
}

/// The spectrum's floor in unit/√Hz; nullopt where no stretch of it is flat.
[[nodiscard]] std::optional<Uncertain> one_sided_floor(const characterise::NoiseAnalysis& analysis);

/// Whether noise types by lag-1 autocorrelation were asked for.
[[nodiscard]] bool knows_lag1(const characterise::DeviationCurve& curve);

/// A sentence, with the channel's name, for each group of nulls in its part of the document.
[[nodiscard]] std::vector<std::string> null_reasons(const ChannelNoise& channel);

}  // namespace proofmass::report
