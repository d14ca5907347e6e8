#pragma once

#include "proofmass/characterise/noise_model.hpp"

namespace proofmass::characterise {

/// For each coefficient, the record length that would identify its value (or upper_95, if it is not
/// observable) with 95 % probability, with all else as in the model.
///
/// Strengths: the shortest T at which c²/std(c²) reaches 4.09 for quantisation and white noise (√6,
/// the threshold of the fit, + 1.645) and 3.60 for slow terms, by the information
///
///     J_ab(T) = T ∫ X_a X_b / S² df  from 1/(2T) to half the rate.
///
/// Ramp: the shortest T at which the fit is expected to lose (3 + margin)² in twice the
/// log-likelihood without it, with all strengths free to explain it as in the fit. None beyond ten
/// thousand times the recording. Probabilities by simulation: noise/record_needed_slow_test.cpp.
/// Source: P. Whittle (1953), the likelihood's information; A. Wald, Trans. Amer. Math. Soc. 54
/// (1943) 426, for the ratio away from the hypothesis.
void set_records_needed(NoiseModelFit& model);

}  // namespace proofmass::characterise
