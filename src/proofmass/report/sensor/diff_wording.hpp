#pragma once

#include <string>
#include <vector>

#include "proofmass/report/sensor/report.hpp"
#include "proofmass/sensor/sensor_comparison.hpp"

// Wording of `sensor diff`.
namespace proofmass::report {

/// The comparison in sentences: the conclusion, then its consequences.
[[nodiscard]] std::vector<std::string> sensor_diff_findings(const SensorDiff& report);

/// "2.31 ± 0.08 mg"
[[nodiscard]] std::string milli_g_words(const sensor::LargestError& force_mps2);

/// "0.12 ± 0.01°"
[[nodiscard]] std::string angle_words(const sensor::LargestError& angle_rad);

/// "0.25 mg and 0.014°": difference that uncertainty alone explains in 95 % of cases.
[[nodiscard]] std::string chance_words(const sensor::CalibrationEffect& effect);

/// "(0.00, −0.71, 0.71)"
[[nodiscard]] std::string direction_words(const sensor::LargestError& error);

/// "0.013", "below 1e-6"
[[nodiscard]] std::string probability_words(double p);

/// "undetermined: no uncertainty in OLD"
[[nodiscard]] std::string verdict_words(const sensor::FigureComparison& figure);

}  // namespace proofmass::report
