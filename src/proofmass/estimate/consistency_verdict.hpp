#pragma once

#include <cstddef>
#include <optional>

#include "proofmass/estimate/consistency.hpp"

// From the figures of innovations to a verdict. Private to the module's consistency*.cpp.
namespace proofmass::estimate {

/// The standard deviation s of normal innovations of which those beyond the gate c were left out,
/// from the mean square of the rest:
///
///     ⟨ν²⟩ = s² m(c/s),   m(x) = 1 − 2 x φ(x) / (2 Φ(x) − 1).
///
/// Absent where ⟨ν²⟩ comes near c²/3, what an even spread over the gate has.
/// Source: A. C. Cohen, Truncated and Censored Samples (1991), section 2.4.
[[nodiscard]] std::optional<double> ungated_std(double mean_square, double gate);

/// Sets verdict and remedy by the other figures; a departure counts where chance would bring it in
/// fewer than 5 % / judged of cases and it is large enough to matter: see docs/methods.
void decide(ChannelConsistency& figures, double gate, std::size_t judged);

}  // namespace proofmass::estimate
