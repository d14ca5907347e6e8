#pragma once

#include <string>
#include <vector>

#include "proofmass/report/consistency_report.hpp"
#include "proofmass/report/page/page.hpp"
#include "proofmass/report/tune/report.hpp"

// Units, names and sentences for the results of a tuning.
namespace proofmass::report {

/// "m^2/s^5": unit (u)^channel_power s^second_power of a parameter.
[[nodiscard]] std::string tune_unit(const Unit& unit, int channel_power, double second_power);

/// Unit of a parameter; for one shared by channels, from the unit of the first.
[[nodiscard]] std::string parameter_unit(const TuneReport& report,
                                         const estimate::TunedParameter& parameter);

/// "acc_x"; "all" for one that is shared or fixed.
[[nodiscard]] std::string parameter_channel(const TuneReport& report,
                                            const estimate::TunedParameter& parameter);

/// "(1.31 ± 0.02)e-04 m²/s⁵", "below 3e-05 m/s²/√s (95 %)", "none: …".
[[nodiscard]] std::string value_words(const TuneReport& report,
                                      const estimate::TunedParameter& parameter);

/// "1.2e-05 … 1.4e-05"; empty if there is none.
[[nodiscard]] std::string interval_words(const estimate::TunedParameter& parameter);

/// Reason for an absent value, with its limits: a sentence.
[[nodiscard]] std::string reason_words(const TuneReport& report,
                                       const estimate::TunedParameter& parameter);

/// Content of the channel according to the model.
[[nodiscard]] std::string model_words(estimate::TuneModel model);

/// Reason for the choice of the model, and the samples used for tuning: one or two sentences.
[[nodiscard]] std::string choice_words(const estimate::TuneChoice& choice);

/// "as tuned", "Q four times"
[[nodiscard]] std::string case_words(const estimate::GainCase& one);

/// The model's names for the noise parameters to which a remedy refers.
[[nodiscard]] NoiseNames noise_names(estimate::TuneModel model);

/// Parameters, one per row.
[[nodiscard]] Table parameters_table(const TuneReport& report);
/// Settling time of each case, and the result for each time step.
[[nodiscard]] Table settling_table(const estimate::TuneStudy& study);
[[nodiscard]] Table step_table(const estimate::TuneStudy& study);

}  // namespace proofmass::report
