#pragma once

#include <string>
#include <vector>

#include "proofmass/fleet/summary.hpp"
#include "proofmass/report/page.hpp"

// What the text for a terminal and the page have in common.
namespace proofmass::fleet {

/// "acc_x: white".
[[nodiscard]] std::string figure_title(const FigureSummary& figure);

/// One row an outlier: sensor, figure, mean, the family's, distance, p adjusted.
[[nodiscard]] std::vector<std::vector<std::string>> outlier_rows(const Summary& summary);
/// One row a figure: mean of the type, scatter between and within.
[[nodiscard]] std::vector<std::vector<std::string>> type_rows(const Summary& summary);
/// One row for each trend that is significant over all of them.
[[nodiscard]] std::vector<std::vector<std::string>> trend_rows(const Summary& summary);
[[nodiscard]] std::vector<std::vector<std::string>> yield_rows(const Summary& summary);

/// "1 000 recordings of 20 sensors; 5 failed. Out of family: S03, S11."
[[nodiscard]] std::string conclusion_of(const Summary& summary);

}  // namespace proofmass::fleet
