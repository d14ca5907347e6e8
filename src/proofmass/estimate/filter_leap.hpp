#pragma once

#include <cstddef>

#include "proofmass/estimate/linear_series.hpp"

namespace proofmass::estimate::packed {

/// Many steps of a filter with one reading each, as one: how P goes through all of them, whatever
/// it is, and how an error of the mean does.
///
///     Φ = A (I + P J)⁻¹,   P ← Φ P Aᵀ + C,   Λ₀ = J (I + P J)⁻¹
///
/// J is the information that the measurements hold on the state before the first step, C the
/// covariance after the last where that state is known, A how the mean then depends on it. Λ₀ is
/// Hindsight's Λ before the first step, of these measurements alone. Source: S. Särkkä, Á. F.
/// García-Fernández, IEEE Trans. Automatic Control 66 (2021) 299.
template <int N>
struct FilterLeap {
  Mat<N, N> A, C, J;
};

/// `count` ≥ 1 steps of a model. For N = 1 to 4. Cost: O(N³ log count).
template <int N>
[[nodiscard]] FilterLeap<N> filter_leap(const LinearModel<N, 1>& model, std::size_t count);

/// A leap from a given P. For N = 1 to 4.
template <int N>
struct LeapFrom {
  LeapFrom(const FilterLeap<N>& leap, const Mat<N, N>& before);
  Mat<N, N> Phi, P, Lambda;
};

}  // namespace proofmass::estimate::packed
