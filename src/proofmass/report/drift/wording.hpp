#pragma once

#include <string>
#include <vector>

#include "proofmass/report/drift/report.hpp"
#include "proofmass/report/noise/wording.hpp"

// Figures, intervals and sentences of `drift`.
namespace proofmass::report {

/// "x", or with several files "run 3.csv: x".
[[nodiscard]] std::string channel_label(const DriftReport& report, const ChannelDrift& channel);

/// Unit of the series, in the notation of the documents.
[[nodiscard]] std::string level_unit(const Unit& unit);

/// "m/s^2/K^2": unit per power of a kelvin.
[[nodiscard]] std::string per_kelvin(const std::string& unit, std::size_t power);

/// Display unit for a bias of about `size`: mg from 1 mg on.
[[nodiscard]] ShownUnit bias_unit(const Unit& unit, double size);

/// "4.80 … 5.21 mg", "above 4.80 mg", "not bounded"; decimals from the interval's width.
[[nodiscard]] std::string bias_interval_words(const characterise::Interval95& interval,
                                              const Unit& unit);

/// "862 … 941 s": the same for a time.
[[nodiscard]] std::string time_interval_words(const characterise::Interval95& interval);

/// "4.5 … 6.1 runs": the same for a number of runs.
[[nodiscard]] std::string runs_interval_words(const characterise::Interval95& interval);

/// "5.00 ± 0.10 mg"
[[nodiscard]] std::string bias_words(const Uncertain& figure, const Unit& unit);
[[nodiscard]] std::string bias_words(const characterise::Interval95& figure, const Unit& unit);
/// "5.00 mg"
[[nodiscard]] std::string bias_words(double value, const Unit& unit);

/// "2.1 ± 0.1 µg/s"
[[nodiscard]] std::string slope_words(const characterise::Interval95& figure, const Unit& unit);

/// "1.2e-05", "0.34", "<1e-16".
[[nodiscard]] std::string p_words(double p);

/// "exponential and line".
[[nodiscard]] std::string shape_words(characterise::DriftShape shape);

/// "hidden_by_noise": the reason as in the document.
[[nodiscard]] std::string reason_code(characterise::DriftReason reason);

/// "warm-up of 5.00 ± 0.10 mg with time constant 900 ± 20 s", "no warm-up identified: steps rather
/// than an exponential: 3 steps of up to 4.1 mg", "not analysed: …"; without a full stop.
[[nodiscard]] std::string drift_verdict(const ChannelDrift& channel);

/// "Residuals at 1 s white, at 100 s not: …".
[[nodiscard]] std::string whiteness_sentence(const characterise::DriftAnalysis& analysis);

/// The result in sentences, the most important first; for a refused channel the reason.
[[nodiscard]] std::vector<std::string> drift_findings(const ChannelDrift& channel);

/// The same for several runs.
[[nodiscard]] std::vector<std::string> run_findings(const ChannelRuns& runs);

/// "turn-on repeatability 2.10 ± 0.30 mg"; without a full stop.
[[nodiscard]] std::string scatter_words(const characterise::RunScatter& scatter, const Unit& unit);

/// "Bias at power-on a2", or for an axis under gravity "Level at power-on a2".
[[nodiscard]] std::string level_words(const ChannelDrift& channel);

/// True if ½ b t² of this series is a position in metres.
[[nodiscard]] bool costs_position(const Unit& unit);

/// True if a bias is too large not to contain gravity.
[[nodiscard]] bool holds_gravity(const characterise::Interval95& bias_mps2);

}  // namespace proofmass::report
