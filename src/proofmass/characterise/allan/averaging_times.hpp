#pragma once

#include <cstddef>
#include <vector>

#include "proofmass/characterise/allan/statistic.hpp"

namespace proofmass::characterise {

/// Averaging times of a curve.
struct TauGrid {
  enum class Kind {
    octave,      ///< m = 1, 2, 4, 8 …
    decade,      ///< m = 1, 2, 4, 10, 20, 40, 100 …
    per_decade,  ///< a number evenly spaced in log τ
    all,         ///< every m
    given,       ///< the times listed
  };
  Kind kind = Kind::per_decade;
  int per_decade = 16;
  std::vector<double> times_s = {};  ///< with Kind::given
  double stop_ratio = 0.0;           ///< record length over longest τ; 0: the statistic's default
};

/// Default record length over longest τ: 4; for the total statistics 2 (3 where the statistic ends
/// there); for Theo1 1, its τ being 0.75 of it. Source: W. J. Riley, Stable32 manual, "stop ratio";
/// SP1065, section 5.
[[nodiscard]] double default_stop_ratio(Statistic statistic);

/// Averaging factors m for a record with this number of rate samples at tau0_s: ascending,
/// distinct, each with at least one term. In a grid per decade those above 32 are multiples of a
/// power of two, so that a decimating pyramid can be used: within 1/32 of the even spacing. Even
/// for Theo1.
[[nodiscard]] std::vector<std::size_t> averaging_factors(const TauGrid& grid,
                                                         Statistic statistic,
                                                         std::size_t samples,
                                                         double tau0_s);

}  // namespace proofmass::characterise
