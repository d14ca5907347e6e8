#pragma once

#include <string>

#include "proofmass/calibrate/tumble_coefficients.hpp"

// What is said of a tumble in words.
namespace proofmass::calibrate {

/// Why a column is not in the fit: a sentence without its subject.
[[nodiscard]] std::string why_missing(const TumbleDesign& design, TumbleTerm term, int plane);

/// Why no coefficient has a standard deviation.
[[nodiscard]] std::string no_std_words(const TumbleDesign& design);

/// Why one whose uncertainty is mostly scatter has none.
[[nodiscard]] std::string unseen_scatter_words();

/// What the coefficient is in this test, exactly.
[[nodiscard]] std::string meaning_words(const TumbleCoefficient& coefficient,
                                        const TumbleDesign& design);

[[nodiscard]] std::string unit_words(TumbleQuantity quantity, const TumbleSolution& solution);

/// What errors of the table's angle look like, or how large they are.
[[nodiscard]] TumbleIndexing indexing_words(const TumbleSolution& solution, const TumbleFit& fit);

/// Notes what was assumed of the table's angles and of the drift, where nothing is stated.
void add_assumptions(const TumbleSolution& solution, TumbleFit& fit);

}  // namespace proofmass::calibrate
