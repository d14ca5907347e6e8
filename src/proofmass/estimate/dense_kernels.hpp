#pragma once

// The inner loops that a filter's and a smoother's time goes into, compiled for the vector units of
// several processors and chosen when the program starts. No fused multiply-add: every processor
// gets the same digits.
namespace proofmass::estimate {

/// The first n rows and columns of a symmetric matrix whose columns stand `stride` doubles apart.
struct SquareExtent {
  int n;
  int stride;
};

/// y = A x, the first n entries. Cost: n² multiplications.
void symmetric_times(const double* A, const double* x, double* y, SquareExtent extent);

/// A ← A − w wᵀ, all n² entries, so that A stays symmetric to the last bit.
void subtract_square(double* A, const double* w, SquareExtent extent);

/// A ← A − (a bᵀ + b aᵀ), all n² entries, so that A stays symmetric to the last bit.
void subtract_symmetric_pair(double* A, const double* a, const double* b, SquareExtent extent);

}  // namespace proofmass::estimate
