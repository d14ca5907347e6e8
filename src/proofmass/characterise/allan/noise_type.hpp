#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "proofmass/characterise/allan/statistic.hpp"
#include "proofmass/core/view.hpp"

namespace proofmass::characterise {

/// The dominant power law of the rate, S_y(f) ∝ f^α, at a given τ.
struct NoiseType {
  int alpha = 0;          ///< 2 … lowest
  double exponent = 0.0;  ///< before rounding and clipping: between two laws it indicates a mixture
};

/// Noise type at τ = m τ0 by the lag-1 autocorrelation r1 of the phase, decimated to τ, with a
/// parabola removed:
///
///     δ = r1 / (1 + r1);  while δ ≥ 1/4 and d < d_max: difference once more, d = d + 1
///     α = 2 − 2 (δ + d),
///
/// d_max = 2, or 3 if α may be below −2 (`lowest` −4). Source: W. J. Riley, C. A. Greenhall, Power
/// law noise identification using the lag 1 autocorrelation, Proc. 18th EFTF (2004). nullopt for
/// fewer than 30 decimated points, or if they are constant. The phase must not contain NaN. Cost:
/// O(N/m).
[[nodiscard]] std::optional<NoiseType> lag1_noise_type(View<double> phase,
                                                       std::size_t m,
                                                       int lowest = -2);

/// Noise type for short records, by ratios of variances: B1, the ratio of the sample variance of
/// the n averages over τ to their Allan variance, compared with the geometric means of the
/// expectations for neighbouring laws,
///
///     B1 = n (1 − n^μ) / (2 (n − 1) (1 − 2^μ)),  μ = −2 (α = 1, 2), −1, 0, 1, 2, 3;
///
/// and between α = 1 and 2, R(m), the ratio of the modified to the Allan variance: 3.37 / (1.04 + 3
/// ln π m) and 1/m. Source: D. A. Howe, R. L. Beard, C. A. Greenhall, F. Vernotte, W. J. Riley, A
/// total estimator of the Hadamard function used for GPS operations, Proc. 32nd PTTI (2000), tables
/// 3 and 4; D. B. Sullivan, D. W. Allan, D. A. Howe, F. L. Walls (editors), NIST TN 1337 (1990).
/// nullopt for n < 7, where the ratio is not informative, and if the averages are constant. Cost:
/// O(N).
[[nodiscard]] std::optional<int> ratio_noise_type(View<double> phase,
                                                  std::size_t m,
                                                  int lowest = -2);

/// The noise type at each of the ascending averaging factors: by lag 1, else by ratios, else that
/// of the previous factor (0 at first). Within the statistic's lowest_alpha and 2; for theo1 at its
/// effective τ.
[[nodiscard]] std::vector<int> identify_noise_types(View<double> phase,
                                                    View<std::size_t> factors,
                                                    Statistic statistic);

}  // namespace proofmass::characterise
