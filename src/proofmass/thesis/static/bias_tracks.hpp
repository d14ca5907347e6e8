#pragma once

#include "proofmass/thesis/static_bias.hpp"

namespace proofmass::thesis {

/// The bias of one axis by the thesis's filter and by ours. Both use the fitted curve as known
/// input; the thesis's measures the means, z = ε + v, ours means over 1 s.
///
///     thesis:  ε[k] = φ ε[k−1] + (1 − φ)(a1 + a2) + w,   φ = e^(−Δt/T),   w ~ N(0, W σ²),  W = 1
///     ours:    ε[k] = ε[k−1] + c(t[k]) − c(t[k−1]) + w,                   w ~ N(0, q Δt)
///
/// with σ² the variance of the means about the thesis's own curve, which is also its R; c the curve
/// of the drift analysis; q the short-time density of all additional drift, K² plus that of flicker
/// or Markov noise, if any: conservative over a long time. Our R is N²/Δt. Source: M. A. Lele
/// (2010), equations 4.53 to 4.55 and 4.62 with the errors of docs/errata.md corrected; W = 1 in
/// section 4.3.
[[nodiscard]] BiasTracks bias_tracks(const StaticRecord& record,
                                     const StaticAxis& axis,
                                     const characterise::DriftAnalysis& drift,
                                     const std::optional<PlainFit>& plain);

}  // namespace proofmass::thesis
