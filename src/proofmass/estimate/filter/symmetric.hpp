#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "proofmass/estimate/filter/gaussian.hpp"

namespace proofmass::estimate {

/// A symmetric matrix in packed form: its lower triangle row by row, (0,0) (1,0) (1,1) (2,0) …
template <int N>
struct Symmetric {
  static constexpr int entries = N * (N + 1) / 2;
  std::array<double, static_cast<std::size_t>(entries)> lower{};

  /// Position of (i, j) and (j, i) in `lower`.
  [[nodiscard]] static constexpr std::size_t index(int i, int j) {
    return static_cast<std::size_t>(i >= j ? i * (i + 1) / 2 + j : j * (j + 1) / 2 + i);
  }

  [[nodiscard]] constexpr double operator()(int i, int j) const { return lower[index(i, j)]; }
  [[nodiscard]] constexpr double& operator()(int i, int j) { return lower[index(i, j)]; }

  /// Reads the lower triangle of `full`.
  [[nodiscard]] static Symmetric of(const Mat<N, N>& full) {
    Symmetric out;
    for (int i = 0; i < N; ++i)
      for (int j = 0; j <= i; ++j) out(i, j) = full(i, j);
    return out;
  }

  [[nodiscard]] Mat<N, N> dense() const {
    Mat<N, N> out;
    for (int j = 0; j < N; ++j)
      for (int i = 0; i < N; ++i) out(i, j) = (*this)(i, j);
    return out;
  }

  [[nodiscard]] Mat<N> diagonal() const {
    Mat<N> out;
    for (int i = 0; i < N; ++i) out(i) = (*this)(i, i);
    return out;
  }

  bool operator==(const Symmetric&) const = default;
};

/// A Gaussian in packed form: (N + 3) N / 2 numbers instead of N² + N.
template <int N>
struct PackedGaussian {
  Mat<N> mean = Mat<N>::Zero();
  Symmetric<N> cov;  ///< infinite where not determined by the measurements (see Start)

  /// Whether the measurements determine state i; if not, its mean has no meaning.
  [[nodiscard]] bool determined(int i) const { return std::isfinite(cov(i, i)); }

  [[nodiscard]] static PackedGaussian of(const Gaussian<N>& full) {
    return {full.mean, Symmetric<N>::of(full.cov)};
  }
  [[nodiscard]] Gaussian<N> dense() const { return {mean, cov.dense()}; }
  // Implicit conversion.
  operator Gaussian<N>() const { return dense(); }  // NOLINT(google-explicit-constructor)
};

}  // namespace proofmass::estimate
