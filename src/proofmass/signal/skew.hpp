#pragma once

#include <cstddef>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/core/view.hpp"

namespace proofmass::signal {

/// A series delayed by a fraction of a sample: y_k = x(k − delay), by a windowed sinc
/// (resample/sinc_kernel.hpp). NaN where one of the two adjacent samples is NaN. Within 32 samples
/// of the ends and of NaN the remaining weights are normalised. Frequencies up to 0.84 of half the
/// sample rate are reproduced within 1e-4 of their amplitude. Expects |delay| ≤ 1. Cost: O(N), 64
/// products per sample.
[[nodiscard]] std::vector<double> delayed(View<double> series, double delay);

/// Corrects the skew of a multiplexer, which samples the channels of a row one after another, the
/// first at the row's time and each next one `between_s` later: channel k is moved to the row's
/// time by band-limited interpolation. Reported in a note.
/// Source: A. V. Oppenheim and R. W. Schafer, Discrete-Time Signal Processing, 3rd ed. (2010),
/// section 4.4 (fractional delay).
/// Errors: invalid_argument (no rate; the last channel would be more than a period late).
[[nodiscard]] Result<Recording> without_skew(const Recording& recording, double between_s);

}  // namespace proofmass::signal
