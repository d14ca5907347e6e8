#pragma once

#include <cstddef>

#include "proofmass/core/statistics.hpp"
#include "proofmass/core/view.hpp"

// The loops in which the time of an audit goes, compiled for the vector units of several
// processors; a fixed order of summation gives every one of them the same digits.
namespace proofmass::signal {

/// What one look at a chunk of values tells.
struct ChunkFigures {
  bool plausible = true;  ///< all of them; if not, the others mean nothing
  double sum = 0.0;
  double min = 0.0, max = 0.0;
};

/// Of one value or more.
[[nodiscard]] ChunkFigures chunk_figures(View<double> values);

/// Σ (x − mean)²
[[nodiscard]] double squares_about(View<double> values, double mean);

/// Whether any value is that before it once more.
[[nodiscard]] bool has_repeats(View<double> values);

/// Values for which sign · x is below the bound.
[[nodiscard]] std::size_t count_below(View<double> values, double sign, double bound);

/// How the steps between stamps depart from the nominal one.
struct StepFigures {
  bool regular = true;   ///< all of them within half a nominal step of it
  double squares = 0.0;  ///< Σ (step − nominal)², if so
};

/// Of the steps between neighbours.
[[nodiscard]] StepFigures step_figures(View<double> stamps_s, double nominal_s);

/// Adds a chunk's figures to those of all before it, by the formula for two samples of any size.
/// Source: T. F. Chan, G. H. Golub, R. J. LeVeque, Updating formulae and a pairwise algorithm for
/// computing sample variances, Stanford STAN-CS-79-773 (1979), equation 2.1.
void add_chunk(Moments& moments, const ChunkFigures& figures, View<double> values);

}  // namespace proofmass::signal
