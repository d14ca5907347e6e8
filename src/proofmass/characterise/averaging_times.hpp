#pragma once

#include <cstddef>
#include <vector>

#include "proofmass/characterise/statistic.hpp"

namespace proofmass::characterise {

/// Which averaging times a curve has.
struct TauGrid {
  enum class Kind {
    octave,      ///< m = 1, 2, 4, 8 …
    decade,      ///< m = 1, 2, 4, 10, 20, 40, 100 …
    per_decade,  ///< so many evenly in log τ
    all,         ///< every m
    given,       ///< the times listed
  };
  Kind kind = Kind::per_decade;
  int per_decade = 16;
  std::vector<double> times_s = {};  ///< with Kind::given
  double stop_ratio = 0.0;           ///< longest τ is the record over this; 0: the statistic's own
};

/// Record over longest τ where nothing else is asked: 4, for the total statistics 2 (3 where the
/// statistic ends there), for Theo1 1, its τ being 0.75 of it.
/// Source: W. J. Riley, Stable32 manual, "stop ratio"; SP1065, section 5.
[[nodiscard]] double default_stop_ratio(Statistic statistic);

/// Averaging factors m for a record of so many rate samples at tau0_s, ascending, distinct, each
/// with at least one term. Those of a grid per decade are multiples of a power of two above 32, so
/// that a decimating pyramid can serve them: within 1/32 of the even spacing. Even for Theo1.
[[nodiscard]] std::vector<std::size_t> averaging_factors(const TauGrid& grid,
                                                         Statistic statistic,
                                                         std::size_t samples,
                                                         double tau0_s);

}  // namespace proofmass::characterise
