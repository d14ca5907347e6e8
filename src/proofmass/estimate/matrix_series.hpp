#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "proofmass/core/progress.hpp"
#include "proofmass/core/result.hpp"

// Linear Gaussian filter and smoothers of models whose sizes are known only at run time, over
// matrices that lie in the caller's memory, row by row.
//
//   state     x[k] = F x[k−1] + B u[k] + w,   w ~ N(0, Q)
//   readings  z[k] = H x[k] + v,              v ~ N(0, R), NaN where there is none
//
// F, Q and B of instant k belong to the step that ends there; nothing moves on the way to the
// first. Models of fixed size are faster: linear_gaussian.hpp, uniform_smoother.hpp.
namespace proofmass::estimate {

inline constexpr int most_matrix_states = 32;  ///< and channels, and inputs

/// A matrix for each instant: one that stays, or several and which of them each instant has.
struct MatrixSequence {
  std::span<const double> values{};       ///< one matrix behind the other; empty: none
  std::span<const std::int64_t> which{};  ///< of each instant; empty: the first
};

struct MatrixSeries {
  int states = 0, channels = 0, inputs = 0;
  MatrixSequence F{}, Q{}, H{}, R{}, B{};
  std::span<const double> prior_mean{}, prior_cov{};  ///< at the first instant, before its reading
  std::span<const double> z{};                        ///< instants × channels
  std::span<const double> u{};                        ///< instants × inputs

  [[nodiscard]] std::size_t size() const {
    return channels > 0 ? z.size() / static_cast<std::size_t>(channels) : 0;
  }
};

enum class MatrixPass {
  filter,     ///< each state given the readings up to its instant
  smooth,     ///< given all readings
  fixed_lag,  ///< given those up to so many instants later
};

/// Where results go; each as long as its instants ask for.
struct MatrixOutput {
  std::span<double> mean{};            ///< instants × states
  std::span<double> cov{};             ///< instants × states × states
  std::span<double> innovation{};      ///< z − H x⁻, instants × channels; NaN without a reading
  std::span<double> innovation_cov{};  ///< H P⁻ Hᵀ + R, × channels; NaN without a reading
};

struct MatrixSummary {
  double log_likelihood = 0.0;  ///< ln p of the readings, −½ Σ (m ln 2π + ln |S| + yᵀ S⁻¹ y)
  double nis = 0.0;             ///< Σ yᵀ S⁻¹ y: χ² of `readings` degrees
  std::size_t readings = 0;
};

/// Runs a pass. The filter is Kalman's with the covariance's update in Joseph's form; the smoother
/// is the modified one of Bryson and Frazier, which inverts no state covariance: a singular Q and
/// time-varying matrices are as good as any others. `lag` is that of fixed_lag.
/// Errors: invalid_argument (sizes), not_finite (an infinite reading, a matrix or an input that
/// holds what is no number), not_positive_definite (an innovation's covariance that is not, with
/// the number of the instant).
/// Source: S. Särkkä, Bayesian Filtering and Smoothing (2013), theorem 4.2; G. J. Bierman,
/// Automatica 9 (1973) 503.
/// Cost: O(instants · N³), fixed_lag O(instants · lag · N³).
[[nodiscard]] Result<MatrixSummary> run_matrices(const MatrixSeries& series,
                                                 MatrixPass pass,
                                                 std::size_t lag,
                                                 const MatrixOutput& output,
                                                 const Progress& progress = {});

/// Whether run_uniform() knows such a series: one channel, up to four states, matrices that stay.
[[nodiscard]] bool is_uniform(const MatrixSeries& series);

/// Filter or smoother of a series that is_uniform(), by run_uniform(). Results are those of
/// run_matrices() but for rounding. Errors: those of run_uniform(), and as above.
[[nodiscard]] Result<MatrixSummary> run_uniform_matrices(const MatrixSeries& series,
                                                         MatrixPass pass,
                                                         const MatrixOutput& output);

}  // namespace proofmass::estimate
