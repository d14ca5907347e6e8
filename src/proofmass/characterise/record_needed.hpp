#pragma once

#include "proofmass/characterise/noise_model.hpp"

namespace proofmass::characterise {

/// For each coefficient, the length of recording at which one of that size (of upper_95, where it
/// is not observable) would be identified with 95 % probability, all else being as the model says:
/// the shortest T with c²/std(c²) ≥ 1.960 + 1.645, where the information on the strengths is
///
///     J_ab(T) = T ∫ X_a X_b / S² df  from 1/(2T) to half the rate,
///
/// and that on the slope of a ramp 8 T³/π⁴ Σ 1/(k⁴ S(k/2T)) over odd k. None beyond ten thousand
/// times the recording. Source: P. Whittle (1953), the likelihood's information.
void set_records_needed(NoiseModelFit& model);

}  // namespace proofmass::characterise
