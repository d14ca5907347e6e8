#pragma once

#include <initializer_list>

#include "proofmass/estimate/gaussian.hpp"

namespace proofmass::estimate {

/// What is known of the state at the first epoch, before its readings:
///
///     x[0] ~ N(mean, cov + κ A Aᵀ),   κ → ∞, exactly.
///
/// The first `directions` columns of A are those in which nothing at all is known; the readings
/// determine them, one direction a reading. No large number stands in for κ, so no digit is lost to
/// one. A Gaussian is a start with no such direction.
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
  Mat<N, N> basis = Mat<N, N>::Zero();  ///< A; columns from `directions` on are not read
  int directions = 0;                   ///< in which nothing is known, 0 … N

  // A Gaussian is meant to be taken wherever a start is.
  Start(const Gaussian<N>& known) : proper(known) {}  // NOLINT(google-explicit-constructor)
  Start() = default;

  /// Nothing known of any state.
  [[nodiscard]] static Start diffuse() {
    Start start;
    start.basis.setIdentity();
    start.directions = N;
    return start;
  }

  /// Nothing known of these states (each named once); of the others what `known` says. Rows and
  /// columns of known.cov that belong to these states are not read; known.mean is where their
  /// numbers start.
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
