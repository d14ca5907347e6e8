#pragma once

#include <string>
#include <vector>

#include "proofmass/report/consistency_report.hpp"
#include "proofmass/report/page/page.hpp"
#include "proofmass/report/tune/report.hpp"

// How the results of a tuning read: units, names, sentences.
namespace proofmass::report {

/// "m^2/s^5": of a parameter whose unit is (u)^channel_power s^second_power.
[[nodiscard]] std::string tune_unit(const Unit& unit, int channel_power, double second_power);

/// The same of a parameter; of one that channels share, by the unit of the first.
[[nodiscard]] std::string parameter_unit(const TuneReport& report,
                                         const estimate::TunedParameter& parameter);

/// "acc_x", "all" of one that is shared or fixed.
[[nodiscard]] std::string parameter_channel(const TuneReport& report,
                                            const estimate::TunedParameter& parameter);

/// "(1.31 ± 0.02)e-04 m²/s⁵", "below 3e-05 m/s²/√s (95 %)", "none: …".
[[nodiscard]] std::string value_words(const TuneReport& report,
                                      const estimate::TunedParameter& parameter);

/// "1.2e-05 … 1.4e-05"; empty where there is none.
[[nodiscard]] std::string interval_words(const estimate::TunedParameter& parameter);

/// Why a parameter has no value, with its limits: a sentence.
[[nodiscard]] std::string reason_words(const TuneReport& report,
                                       const estimate::TunedParameter& parameter);

/// What the model takes the channel to hold.
[[nodiscard]] std::string model_words(estimate::TuneModel model);

/// Why this model was chosen, and which samples it was tuned on: one or two sentences.
[[nodiscard]] std::string choice_words(const estimate::TuneChoice& choice);

/// "as tuned", "Q four times"
[[nodiscard]] std::string case_words(const estimate::GainCase& one);

/// What a user of the model calls the figures that a verdict would move.
[[nodiscard]] NoiseNames noise_names(estimate::TuneModel model);

/// Parameters, one a row.
[[nodiscard]] Table parameters_table(const TuneReport& report);
/// Settling of each case, and what each step comes to.
[[nodiscard]] Table settling_table(const estimate::TuneStudy& study);
[[nodiscard]] Table step_table(const estimate::TuneStudy& study);

}  // namespace proofmass::report
