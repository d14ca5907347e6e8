#pragma once

#include <string>
#include <vector>

#include "proofmass/fleet/summary.hpp"
#include "proofmass/report/page/page.hpp"

// Parts of the description of a summary.
namespace proofmass::fleet {

/// "acc_x: white".
[[nodiscard]] std::string figure_title(const FigureSummary& figure);

[[nodiscard]] bool is_out_of_family(const FigureSummary& figure, std::size_t sensor);

/// One row an outlier: sensor, figure, mean, the type's mean, distance, p adjusted.
[[nodiscard]] report::Table outlier_table(const Summary& summary);
/// One row for each recording of an outlier, with a link to its report or document and the figures
/// in which the sensor is out of family.
[[nodiscard]] report::Table outlier_recordings_table(const Summary& summary,
                                                     const std::string& links);
/// One row a figure: mean of the type, scatter between and within.
[[nodiscard]] report::Table type_table(const Summary& summary);
/// One row for each trend that is significant over all of them.
[[nodiscard]] report::Table trend_table(const Summary& summary);
[[nodiscard]] report::Table yield_table(const Summary& summary);
[[nodiscard]] report::Table quantiles_table(const Summary& summary);

/// Every recording's value by sensor, and over date and temperature where they are known.
[[nodiscard]] std::vector<report::Plot> figures_of(const FigureSummary& figure);

}  // namespace proofmass::fleet
