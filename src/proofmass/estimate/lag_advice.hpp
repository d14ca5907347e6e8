#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/estimate/fast/steady_state.hpp"

// Benefit of a fixed lag, computed from the model: the reduction of each state's steady-state
// variance by waiting for further measurements.
namespace proofmass::estimate {

/// Reduction of the variance by a lag. With A = F (I − K H),
///
///     P⁺ − P[k|k+L] = P⁺ Λ_L P⁺,   Λ_L = Fᵀ (Σ Aᵀⁱ Hᵀ S⁻¹ H Aⁱ, i = 0 … L−1) F.
///
/// Source: B. D. O. Anderson, J. B. Moore, Optimal Filtering (1979), section 7.3.
class LagGain {
 public:
  template <int N, int M, int U>
  LagGain(const LinearModel<N, M, U>& model, const SteadyState<N, M>& steady)
      : LagGain(Parts{model.F, model.H, steady.gain, steady.innovation_variance, steady.seen}) {}

  /// Reduction for each state with `lag` later measurements. Cost: O(N³ ln lag).
  [[nodiscard]] Eigen::VectorXd variance_reduction(std::size_t lag) const;
  /// Reduction for each state with all future measurements.
  [[nodiscard]] Eigen::VectorXd variance_reduction() const;
  /// The shortest lag that achieves `share` of the total reduction, in (0, 1), for one state.
  [[nodiscard]] std::size_t shortest(int state, double share) const;

 private:
  struct Parts {
    Eigen::MatrixXd F, H, gain, innovation_variance, seen;
  };
  explicit LagGain(const Parts& parts);
  [[nodiscard]] Eigen::VectorXd reduction(const Eigen::MatrixXd& sum) const;

  /// By doubling: sums_[j] is the sum of the first 2ʲ terms, powers_[j] is A to the power 2ʲ.
  std::vector<Eigen::MatrixXd> sums_, powers_;
  Eigen::MatrixXd effect_;  ///< P⁺ Fᵀ on the observable subspace
};

/// Benefit of a lag for one state.
struct StateLag {
  double filter_variance = 0.0;        ///< without lag
  double interval_variance = 0.0;      ///< given all future measurements
  std::size_t lag_95 = 0, lag_99 = 0;  ///< measurements to wait for 95 % and 99 % of the total gain
};

struct StateLagAdvice {
  std::optional<StateLag> lag;
  std::string why_not;  ///< in words, if there is no advice
};

/// Lag advice for each state. Absent if a state's variance has no limit (the state is not
/// observable), or if later measurements reduce it by less than 1e-6. Cost: O(N³) for some dozens
/// of steps.
template <int N, int M, int U>
[[nodiscard]] std::vector<StateLagAdvice> advise_lag(const LinearModel<N, M, U>& model,
                                                     const SteadyState<N, M>& steady);

namespace detail {
[[nodiscard]] StateLagAdvice state_advice(const LagGain& gain,
                                          int state,
                                          std::optional<double> filter_variance);
}

template <int N, int M, int U>
std::vector<StateLagAdvice> advise_lag(const LinearModel<N, M, U>& model,
                                       const SteadyState<N, M>& steady) {
  const LagGain gain(model, steady);
  std::vector<StateLagAdvice> advice;
  for (int i = 0; i < N; ++i)
    advice.push_back(detail::state_advice(gain, i, steady.filtered_variance(i)));
  return advice;
}

/// One line of text, with a step of dt_s: "position: a lag of 9 readings (0.09 s) gets 95 %, 14
/// (0.14 s) 99 % of what all later readings give; the standard deviation falls by 33 %".
[[nodiscard]] std::string lag_words(const StateLagAdvice& advice,
                                    const std::string& state,
                                    double dt_s);

}  // namespace proofmass::estimate
