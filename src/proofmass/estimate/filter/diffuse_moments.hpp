#pragma once

#include <cmath>
#include <limits>

#include "proofmass/estimate/filter/diffuse.hpp"
#include "proofmass/estimate/filter/symmetric.hpp"

// Output means and covariances after a diffuse start: finite where the measurements determine them,
// infinite where they do not.
namespace proofmass::estimate::detail {

/// Dependence of a state x̂ + X δ on δ.
template <int N>
struct DiffusePart {
  Mat<N, N> root;  ///< X T L⁻¹; its square is what the determined part of δ adds to the covariance
  Mat<N> mean;     ///< what the determined part of δ adds to the mean
  Mat<N, N> open;  ///< X T of the undetermined directions, in the first columns
};

/// `moved` is X. Entries of `open` at rounding level are set to 0. The rounding level comes from X
/// before smoothing (`filtered`), since the smoother's adjoint of an undetermined direction is 0.
template <int N>
[[nodiscard]] DiffusePart<N> diffuse_part(const Mat<N, N>& moved,
                                          const Mat<N, N>& filtered,
                                          const DiffuseKnowledge<N>& known) {
  constexpr double rounding = 1e-10;
  DiffusePart<N> part{Mat<N, N>::Zero(), Mat<N>::Zero(), Mat<N, N>::Zero()};
  const Mat<N, N> turned = moved * known.turn;
  for (int j = known.found; j-- > 0;) {
    part.root.col(j) = turned.col(j);
    for (int i = j + 1; i < known.found; ++i)
      part.root.col(j) -= part.root.col(i) * known.root(i, j);
    part.root.col(j) /= known.root(j, j);
  }
  part.mean = part.root * known.right;
  for (int j = known.found; j < known.directions; ++j) {
    const Mat<N> seen = filtered * known.turn.col(j);
    const Mat<N> made_of = filtered.cwiseAbs() * known.turn.col(j).cwiseAbs();
    for (int i = 0; i < N; ++i)
      if (std::abs(seen(i)) > rounding * made_of(i)) part.open(i, j - known.found) = seen(i);
  }
  return part;
}

/// finite + κ a bᵀ, κ → ∞, entry by entry.
template <int N>
[[nodiscard]] Mat<N, N> limit(const Mat<N, N>& finite, const Mat<N, N>& a, const Mat<N, N>& b) {
  constexpr double rounding = 1e-10;
  const Mat<N, N> infinite = a * b.transpose();
  const Mat<N, N> made_of = a.cwiseAbs() * b.cwiseAbs().transpose();
  Mat<N, N> out = finite;
  for (int j = 0; j < N; ++j)
    for (int i = 0; i < N; ++i)
      if (std::abs(infinite(i, j)) > rounding * made_of(i, j))
        out(i, j) = std::copysign(std::numeric_limits<double>::infinity(), infinite(i, j));
  return out;
}

/// x̂ + X δ̂, with covariance P + X cov(δ) Xᵀ.
template <int N>
[[nodiscard]] PackedGaussian<N> with_diffuse(const Gaussian<N>& given_zero,
                                             const DiffusePart<N>& part) {
  const Mat<N, N> cov = given_zero.cov + part.root * part.root.transpose();
  return {given_zero.mean + part.mean, Symmetric<N>::of(limit<N>(cov, part.open, part.open))};
}

}  // namespace proofmass::estimate::detail
