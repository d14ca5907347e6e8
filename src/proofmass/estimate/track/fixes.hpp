#pragma once

#include <cstddef>
#include <vector>

#include "proofmass/estimate/track/solve.hpp"

// What position fixes show beside the position.
namespace proofmass::estimate {

/// Compares solutions by the log density of the fixes as the forward filter predicts them (A. P.
/// Dawid, J. R. Statist. Soc. A 147 (1984) 278):
///
/// - rests without which it is clearly higher are none, and are removed from `signal`;
/// - a delay of all fixes, for which it is clearly higher, is subtracted from their times;
/// - a fix far from the smoothed position without it is wrong, and is removed, as are the
///   repetitions of one position.
///
/// `options.fixes` and `solved` are adapted. Nothing is done with fewer than three fixes.
[[nodiscard]] FixReview review_fixes(TrackSignal& signal,
                                     TrackOptions& options,
                                     bool rests_in_doubt,
                                     AlongAxis& solved);

}  // namespace proofmass::estimate
