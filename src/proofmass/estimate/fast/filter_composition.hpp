#pragma once

#include <cstddef>

#include "proofmass/estimate/filter/linear_series.hpp"

namespace proofmass::estimate::packed {

/// Composition of many filter steps with one measurement each into one: how any P, and an error of
/// the mean, pass through all of them.
///
///     Φ = A (I + P J)⁻¹,   P ← Φ P Aᵀ + C,   Λ₀ = J (I + P J)⁻¹
///
/// J is the information of the measurements on the state before the first step, C the covariance
/// after the last if that state is known, A the dependence of the mean on it. Λ₀ is
/// BackwardInformation's Λ before the first step, from these measurements alone. Source: S. Särkkä,
/// Á. F. García-Fernández, IEEE Trans. Automatic Control 66 (2021) 299.
template <int N>
struct ComposedFilter {
  Mat<N, N> A, C, J;
};

/// `count` ≥ 1 steps of a model. For N = 1 to 4. Cost: O(N³ log count).
template <int N>
[[nodiscard]] ComposedFilter<N> composed_filter(const LinearModel<N, 1>& model, std::size_t count);

/// The composition applied to a given P. For N = 1 to 4.
template <int N>
struct CompositionStart {
  CompositionStart(const ComposedFilter<N>& leap, const Mat<N, N>& before);
  Mat<N, N> Phi, P, Lambda;
};

}  // namespace proofmass::estimate::packed
