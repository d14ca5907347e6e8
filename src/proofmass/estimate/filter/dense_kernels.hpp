#pragma once

// Inner loops of filter and smoother, compiled for the vector units of several processors and
// selected at program start. No fused multiply-add: results are identical on every processor.
namespace proofmass::estimate {

/// The first n rows and columns of a symmetric matrix with a column stride of `stride` doubles.
struct SquareExtent {
  int n;
  int stride;
};

/// to ← from. Faster than memcpy() for some kilobytes where that uses `rep movsb`, which is slow on
/// virtual machines.
void copy_entries(const double* from, double* to, int count);

/// y = A x, the first n entries. Cost: n² multiplications.
void symmetric_times(const double* A, const double* x, double* y, SquareExtent extent);

/// Y = F A, of the first four rows and n columns of A; F and Y have columns of four.
void four_by_four_times(const double* F, const double* A, double* Y, SquareExtent extent);

/// A ← A − w wᵀ, all n² entries, so that A stays exactly symmetric.
void subtract_square(double* A, const double* w, SquareExtent extent);

/// A ← A − (a bᵀ + b aᵀ), all n² entries, so that A stays exactly symmetric.
void subtract_symmetric_pair(double* A, const double* a, const double* b, SquareExtent extent);

/// P ← (I − K hᵀ) P (I − K hᵀ)ᵀ + R K Kᵀ: Joseph form of a scalar update with I − K hᵀ formed
/// explicitly, for a prior so much wider than the measurement that differences of P's entries have
/// no correct digit. n ≤ most_states. Cost: 4 n³ multiplications.
inline constexpr int most_states = 64;
void joseph_update(double* P, const double* h, const double* K, double R, SquareExtent extent);

}  // namespace proofmass::estimate
