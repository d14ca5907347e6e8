#pragma once

#include <vector>

#include "proofmass/characterise/allan/phase_variance.hpp"
#include "proofmass/characterise/deviation.hpp"
#include "proofmass/characterise/noise_analysis.hpp"

namespace proofmass::characterise {

/// Estimated variances of one statistic at each factor, and the data for their limits.
struct CurveVariances {
  std::vector<std::size_t> factors;
  std::vector<PhaseVariance> variances;
  std::size_t phase_points = 0;   ///< of the stretch used
  std::size_t least_overlap = 0;  ///< terms per τ of the difference statistics
  std::size_t left_out = 0;       ///< samples outside that stretch
};

/// Variances of a statistic that is not a difference and needs the whole rate series (NaN where a
/// sample is missing): computed on its longest stretch without a gap of more than eight samples.
[[nodiscard]] CurveVariances whole_record_variances(View<double> series,
                                                    const NoiseOptions& options);

/// The curve with bias corrections and limits. `model` determines the noise types unless
/// options.noise_type states otherwise; `series` is used only for the lag-1 types.
[[nodiscard]] DeviationCurve deviation_curve(const CurveVariances& variances,
                                             const NoiseModelFit& model,
                                             View<double> series,
                                             const NoiseOptions& options);

}  // namespace proofmass::characterise
