#pragma once

#include <vector>

#include "proofmass/characterise/deviation.hpp"
#include "proofmass/characterise/noise_analysis.hpp"
#include "proofmass/characterise/phase_variance.hpp"

namespace proofmass::characterise {

/// The variances of one statistic at each factor, as estimated, and what their limits need.
struct CurveVariances {
  std::vector<std::size_t> factors;
  std::vector<PhaseVariance> variances;
  std::size_t phase_points = 0;   ///< of the stretch that was used
  std::size_t least_overlap = 0;  ///< of the difference statistics
  std::size_t left_out = 0;       ///< samples outside that stretch
};

/// Of a rate series with NaN where a sample is missing, by a statistic that is no difference and
/// needs it all at once: that of its longest stretch without a gap of more than eight samples.
[[nodiscard]] CurveVariances whole_record_variances(View<double> series,
                                                    const NoiseOptions& options);

/// The curve with bias corrections and limits. `model` decides the noise types unless
/// options.noise_type says otherwise; `series` is only read for the lag-1 types.
[[nodiscard]] DeviationCurve deviation_curve(const CurveVariances& variances,
                                             const NoiseModelFit& model,
                                             View<double> series,
                                             const NoiseOptions& options);

}  // namespace proofmass::characterise
