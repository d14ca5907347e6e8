#pragma once

#include <initializer_list>

#include "proofmass/estimate/filter/gaussian.hpp"

namespace proofmass::estimate {

/// Distribution of the state at the first epoch, before its measurements:
///
///     x[0] ~ N(mean, cov + κ A Aᵀ),   κ → ∞, exactly.
///
/// The first `directions` columns of A are the diffuse directions; the measurements determine them,
/// one direction per measurement. No large number approximates κ, so no digit is lost. A Gaussian
/// is a start without diffuse directions.
///
///     Start<2> nothing_known = Start<2>::diffuse();      // level and slope of a trend
///     Start<3> at_rest = Start<3>::diffuse({0}, {.mean = …, .cov = …});  // position alone
///
/// Source: S. J. Koopman, Exact initial Kalman filtering and smoothing for nonstationary time
/// series models, JASA 92 (1997) 1630; J. Durbin, S. J. Koopman, Time Series Analysis by State
/// Space Methods (2012), chapter 5, with P∞ = A Aᵀ.
template <int N>
struct Start {
  Gaussian<N> proper;                   ///< all but the diffuse part
  Mat<N, N> basis = Mat<N, N>::Zero();  ///< A; columns from `directions` on are not used
  int directions = 0;                   ///< number of diffuse directions, 0 … N

  // Implicit: a Gaussian is accepted wherever a start is.
  Start(const Gaussian<N>& known) : proper(known) {}  // NOLINT(google-explicit-constructor)
  Start() = default;

  /// All states diffuse.
  [[nodiscard]] static Start diffuse() {
    Start start;
    start.basis.setIdentity();
    start.directions = N;
    return start;
  }

  /// The listed states (each once) are diffuse; the others are distributed as `known`. Rows and
  /// columns of known.cov that belong to the listed states are not used; known.mean is their
  /// numerical origin.
  [[nodiscard]] static Start diffuse(std::initializer_list<int> states,
                                     const Gaussian<N>& known = {}) {
    Start start(known);
    for (const int i : states) {
      start.proper.cov.row(i).setZero();
      start.proper.cov.col(i).setZero();
      start.basis(i, start.directions++) = 1.0;
    }
    return start;
  }
};

}  // namespace proofmass::estimate
