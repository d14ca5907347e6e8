#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/report/tumble/report.hpp"

// Coefficients and sentences of `tumble`, in the notation of the standard.
namespace proofmass::report {

/// Unit of a coefficient in the standard: g instead of m/s².
struct InG {
  double factor = 1.0;  ///< from SI
  std::string unit;     ///< "mg", "ug/g^2", "V/g"
};
[[nodiscard]] InG in_g(const calibrate::TumbleCoefficient& coefficient, const Unit& output);

/// The unit with its superscripts: "µg/g²"; empty for 1.
[[nodiscard]] std::string printed(const InG& unit);

/// "K2 − Kpp", "δo (mounted at 180°)".
[[nodiscard]] std::string symbol_words(const calibrate::TumbleCoefficient& coefficient);

/// "12.1 ± 0.3 mg"; the value alone if it has no std; "not determined".
[[nodiscard]] std::string coefficient_words(const calibrate::TumbleCoefficient& coefficient,
                                            const Unit& output);

/// "x: misalignment_rad (mounted at 180°)".
[[nodiscard]] std::string key_words(const calibrate::TumbleCoefficient& coefficient);

/// True if the coefficient is listed: it has a value, or it is one of the standard's.
[[nodiscard]] bool is_shown(const calibrate::TumbleCoefficient& coefficient);

/// Rows of symbol, figure, 95 % interval, and meaning or reason for absence.
[[nodiscard]] std::vector<std::vector<std::string>> coefficient_rows(const ChannelTumble& channel);

/// "x: scale factor 0.3301 ± 0.0002 V/g, bias 12.1 ± 0.3 mg at 0 g."
[[nodiscard]] std::string tumble_conclusion(const TumbleReport& report);

/// Findings about the fit of one channel, a sentence each.
[[nodiscard]] std::vector<std::string> tumble_sentences(const ChannelTumble& channel);

/// Effect of the table's indexing errors on the coefficients, or their size; from the main channel.
[[nodiscard]] std::vector<std::string> table_sentences(const TumbleReport& report);

}  // namespace proofmass::report
