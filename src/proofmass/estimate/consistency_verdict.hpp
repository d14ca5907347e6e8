#pragma once

#include <cstddef>
#include <optional>

#include "proofmass/estimate/consistency.hpp"

// Verdict from the innovation statistics.
namespace proofmass::estimate {

/// Standard deviation s of normal innovations truncated at the gate c, from the mean square of the
/// accepted ones:
///
///     ⟨ν²⟩ = s² m(c/s),   m(x) = 1 − 2 x φ(x) / (2 Φ(x) − 1).
///
/// Absent if ⟨ν²⟩ approaches c²/3, the value of a uniform distribution over the gate. Source: A. C.
/// Cohen, Truncated and Censored Samples (1991), section 2.4.
[[nodiscard]] std::optional<double> ungated_std(double mean_square, double gate);

/// Sets verdict and remedy from the other statistics; a departure counts if it is significant at 5
/// % / judged and large enough to matter: see docs/methods.
void decide(ChannelConsistency& figures, double gate, std::size_t judged);

}  // namespace proofmass::estimate
