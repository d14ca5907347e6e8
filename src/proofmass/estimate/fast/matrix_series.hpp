#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "proofmass/core/progress.hpp"
#include "proofmass/core/result.hpp"

// Linear Gaussian filter and smoothers of models with run-time sizes, over row-major matrices in
// the caller's memory.
//
//   state         x[k] = F x[k−1] + B u[k] + w,   w ~ N(0, Q)
//   measurements  z[k] = H x[k] + v,              v ~ N(0, R), NaN where missing
//
// F, Q and B of epoch k belong to the step that ends there; the first epoch has no transition.
// Models of fixed size are faster: filter/linear_gaussian.hpp, fast/uniform_smoother.hpp.
namespace proofmass::estimate {

inline constexpr int most_matrix_states = 32;  ///< also the maximum of channels and inputs

/// A matrix for each epoch: one constant matrix, or several and an index for each epoch.
struct MatrixSequence {
  std::span<const double> values{};       ///< consecutive matrices; empty: none
  std::span<const std::int64_t> which{};  ///< index for each epoch; empty: the first
};

struct MatrixSeries {
  int states = 0, channels = 0, inputs = 0;
  MatrixSequence F{}, Q{}, H{}, R{}, B{};
  std::span<const double> prior_mean{}, prior_cov{};  ///< before the first measurement
  std::span<const double> z{};                        ///< epochs × channels
  std::span<const double> u{};                        ///< epochs × inputs

  [[nodiscard]] std::size_t size() const {
    return channels > 0 ? z.size() / static_cast<std::size_t>(channels) : 0;
  }
};

enum class MatrixPass {
  filter,     ///< each state given the measurements up to its epoch
  smooth,     ///< given all measurements
  fixed_lag,  ///< given those up to `lag` epochs later
};

/// Output arrays; the length of each follows from the number of epochs.
struct MatrixOutput {
  std::span<double> mean{};            ///< epochs × states
  std::span<double> cov{};             ///< epochs × states × states
  std::span<double> innovation{};      ///< z − H x⁻, epochs × channels; NaN without a measurement
  std::span<double> innovation_cov{};  ///< H P⁻ Hᵀ + R, × channels; NaN without a measurement
};

struct MatrixSummary {
  double log_likelihood = 0.0;  ///< ln p of the measurements, −½ Σ (m ln 2π + ln |S| + yᵀ S⁻¹ y)
  double nis = 0.0;             ///< Σ yᵀ S⁻¹ y: χ² with `readings` degrees of freedom
  std::size_t readings = 0;
};

/// Runs filter or smoother. The filter updates the covariance in Joseph form; the smoother is the
/// modified Bryson–Frazier smoother, which inverts no state covariance: a singular Q and
/// time-varying matrices need no special treatment. `lag` is used by fixed_lag. Errors:
/// invalid_argument (sizes), not_finite (an infinite measurement, a matrix or input with a NaN or
/// infinity), not_positive_definite (a non-positive innovation covariance, with the number of the
/// epoch). Source: S. Särkkä, Bayesian Filtering and Smoothing (2013), theorem 4.2; G. J. Bierman,
/// Automatica 9 (1973) 503. Cost: O(epochs · N³), fixed_lag O(epochs · lag · N³).
[[nodiscard]] Result<MatrixSummary> run_matrices(const MatrixSeries& series,
                                                 MatrixPass pass,
                                                 std::size_t lag,
                                                 const MatrixOutput& output,
                                                 const Progress& progress = {});

/// Whether run_uniform() supports a series: one channel, up to four states, constant matrices.
[[nodiscard]] bool is_uniform(const MatrixSeries& series);

/// Filter or smoother of a series that is_uniform(), by run_uniform(). Results are those of
/// run_matrices() but for rounding. Errors: those of run_uniform(), and as above.
[[nodiscard]] Result<MatrixSummary> run_uniform_matrices(const MatrixSeries& series,
                                                         MatrixPass pass,
                                                         const MatrixOutput& output);

}  // namespace proofmass::estimate
