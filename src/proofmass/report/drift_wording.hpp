#pragma once

#include <string>
#include <vector>

#include "proofmass/report/drift_report.hpp"
#include "proofmass/report/noise_wording.hpp"

// How the results of `drift` read: figures, intervals, sentences.
namespace proofmass::report {

/// "x", or of several files "run 3.csv: x".
[[nodiscard]] std::string channel_label(const DriftReport& report, const ChannelDrift& channel);

/// Unit in which a bias of about some size is read: mg from 1 mg on, since drift is a matter of mg
/// where noise is one of µg.
[[nodiscard]] ShownUnit bias_unit(const Unit& unit, double size);

/// "4.80 … 5.21 mg", "above 4.80 mg", "not bounded": as many decimals as its width means.
[[nodiscard]] std::string bias_interval_words(const characterise::Interval95& interval,
                                              const Unit& unit);

/// The same of a time: "862 … 941 s".
[[nodiscard]] std::string time_interval_words(const characterise::Interval95& interval);

/// The same of a number of runs: "4.5 … 6.1 runs".
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

/// "exponential and line", as people call a shape.
[[nodiscard]] std::string shape_words(characterise::DriftShape shape);

/// Document word of a reason: "hidden_by_noise".
[[nodiscard]] std::string reason_code(characterise::DriftReason reason);

/// "warm-up of 5.00 ± 0.10 mg with time constant 900 ± 20 s", "no warm-up can be told: steps
/// instead of an exponential: 3 steps of up to 4.1 mg", "not analysed: …"; no full stop.
[[nodiscard]] std::string drift_verdict(const ChannelDrift& channel);

/// "Residuals at 1 s white, at 100 s not: …": what the tests say of a plain fit, and of this one.
[[nodiscard]] std::string whiteness_sentence(const characterise::DriftAnalysis& analysis);

/// What the analysis comes to, sentence by sentence, the most important first; of a refused channel
/// why.
[[nodiscard]] std::vector<std::string> drift_findings(const ChannelDrift& channel);

/// The same of several runs.
[[nodiscard]] std::vector<std::string> run_findings(const ChannelRuns& runs);

/// "turn-on repeatability 2.10 ± 0.30 mg"; no full stop.
[[nodiscard]] std::string scatter_words(const characterise::RunScatter& scatter, const Unit& unit);

/// "Bias at switching on a2", or of an axis that bears gravity "Level at switching on a2".
[[nodiscard]] std::string level_words(const ChannelDrift& channel);

/// Whether ½ b t² of this series is a position, in metres.
[[nodiscard]] bool costs_position(const Unit& unit);

/// Whether a bias is so large that the series holds gravity, so that leaving it in is no choice.
[[nodiscard]] bool holds_gravity(const characterise::Interval95& bias_mps2);

}  // namespace proofmass::report
