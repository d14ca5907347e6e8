#pragma once

#include "proofmass/thesis/static_bias.hpp"

namespace proofmass::thesis {

/// The bias of one axis by the thesis's filter and by ours. Both take the fitted curve for a known
/// input; the thesis's is given the means, z = ε + v, ours means over 1 s.
///
///     thesis:  ε[k] = φ ε[k−1] + (1 − φ)(a1 + a2) + w,   φ = e^(−Δt/T),   w ~ N(0, W σ²),  W = 1
///     ours:    ε[k] = ε[k−1] + c(t[k]) − c(t[k−1]) + w,                   w ~ N(0, q Δt)
///
/// σ² the variance of the means about the thesis's own curve, which is its R too; c the curve of
/// the drift analysis, q what all that drifts beside it does in a short time, K² and that of
/// flicker or Markov noise where there is some: on the safe side over a long one. Our R is N²/Δt.
/// Source: M. A. Lele (2010), equations 4.53 to 4.55 and 4.62 with the mistakes of docs/errata.md
/// mended; W = 1 in section 4.3.
[[nodiscard]] BiasTracks bias_tracks(const StaticRecord& record,
                                     const StaticAxis& axis,
                                     const characterise::DriftAnalysis& drift,
                                     const std::optional<PlainFit>& plain);

}  // namespace proofmass::thesis
