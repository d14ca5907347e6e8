#pragma once

#include <string>

#include "proofmass/sensor/sensor_comparison.hpp"

// Wording that text and page of `sensor diff` share.
namespace proofmass::report {

/// "2.31 ± 0.08 mg"
[[nodiscard]] std::string milli_g_words(const sensor::LargestError& force_mps2);

/// "0.12 ± 0.01°"
[[nodiscard]] std::string angle_words(const sensor::LargestError& angle_rad);

/// "0.25 mg and 0.014°": what uncertainty alone explains in 95 % of cases, where that is known.
[[nodiscard]] std::string chance_words(const sensor::CalibrationEffect& effect);

/// "(0.00, −0.71, 0.71)"
[[nodiscard]] std::string direction_words(const sensor::LargestError& error);

/// "0.013", "below 1e-6"
[[nodiscard]] std::string probability_words(double p);

/// "cannot be told: no uncertainty in OLD"
[[nodiscard]] std::string verdict_words(const sensor::FigureComparison& figure);

}  // namespace proofmass::report
