#pragma once

#include <string>

#include "proofmass/calibrate/tumble/coefficients.hpp"

// Sentences on a tumble.
namespace proofmass::calibrate {

/// Why a column is not in the fit: a sentence without its subject.
[[nodiscard]] std::string why_missing(const TumbleDesign& design, TumbleTerm term, int plane);

/// Why no coefficient has a standard deviation.
[[nodiscard]] std::string no_std_words(const TumbleDesign& design);

/// Why a coefficient whose uncertainty is mostly scatter has no standard deviation.
[[nodiscard]] std::string unseen_scatter_words();

/// Exact definition of the coefficient in this test.
[[nodiscard]] std::string meaning_words(const TumbleCoefficient& coefficient,
                                        const TumbleDesign& design);

[[nodiscard]] std::string unit_words(TumbleQuantity quantity, const TumbleSolution& solution);

/// Effect of the table's angle errors, or their size.
[[nodiscard]] TumbleIndexing indexing_words(const TumbleSolution& solution, const TumbleFit& fit);

/// Notes the assumptions on the table's angles and on the drift, if nothing is stated.
void add_assumptions(const TumbleSolution& solution, TumbleFit& fit);

}  // namespace proofmass::calibrate
