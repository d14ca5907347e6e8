#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/estimate/fast/run_length_covariances.hpp"
#include "proofmass/estimate/filter/linear_series.hpp"

// Filter and smoother of long recordings with a constant step and one channel: the results of
// filter_linear() and smooth_linear(), at memory bandwidth.
//
//   x[k] = F x[k−1] + d + w,   z[k] = h x[k] + v,   z[k] NaN where missing
//
// One of three passes is selected for each stretch of the recording:
//
// - one by one: the beginning, stretches with missing measurements, the remainder at the end;
// - side by side: complete stretches, cut into lanes that run in parallel. Covariances at the
//   lanes' beginnings come from the composition of filtering elements, so they are exact;
// - constant gain: complete stretches after the gains have reached their limit
// (fast/steady_state.hpp),
//   if covariances have a limit too or are not requested.
//
// A gap returns to the first pass.
namespace proofmass::estimate {

enum class Covariances {
  none,
  where_they_change,  ///< in UniformRun::covariances, to 1e-11
  everywhere,         ///< in UniformOutput::covariances
};

template <int N>
struct UniformOptions {
  bool smooth = true;  ///< false: filtered states, given the measurements so far
  Covariances covariances = Covariances::where_they_change;
  bool innovations = false;
  Mat<N> input = Mat<N>::Zero();  ///< d: B u of a constant input
};

/// Output arrays, each as long as the recording or empty. Memory that has been written to before is
/// faster than new memory.
template <int N>
struct UniformOutput {
  std::span<Mat<N>> means = {};
  std::span<Symmetric<N>> covariances = {};
  std::span<double> innovation = {};  ///< NaN where missing
  std::span<double> innovation_variance = {};
};

/// Summary of a run.
template <int N>
struct UniformSummary {
  RunLengthCovariances<N> covariances;  ///< for Covariances::where_they_change
  double log_likelihood = 0.0;          ///< of the measurements, as in LinearRun
  double nis = 0.0;                     ///< Σ y² / S: χ² with `readings` degrees of freedom
  std::size_t readings = 0;
  // Epochs processed by each pass, in the smoother. While the requested covariances still change,
  // it processes a stretch side by side that the filter processed at constant gain.
  std::size_t one_by_one = 0, side_by_side = 0, constant_gain = 0;

  [[nodiscard]] std::string passes() const {
    return std::to_string(one_by_one) + " epochs one by one, " + std::to_string(side_by_side) +
           " side by side, " + std::to_string(constant_gain) + " at constant gain";
  }
};

/// Runs over `z` into the caller's memory. `prior` describes the state at the first epoch, before
/// its measurement. For N = 1 to 4. The output's means are required, its covariances if they are
/// requested everywhere. Additional memory: O(1), plus O(N²) for each 4000 epochs, plus the stored
/// covariances. Errors: not_finite (an infinite measurement or a model with a NaN or infinity),
/// not_positive_definite (R not positive). Source: Särkkä (2013), theorem 4.2, and Bierman (1973)
/// as in filter/smoother.hpp; S. Särkkä, Á. F. García-Fernández, IEEE Trans. Automatic Control 66
/// (2021) 299, for the composition. Cost: O(N³) an epoch.
template <int N, int U>
[[nodiscard]] Result<UniformSummary<N>> run_uniform(const LinearModel<N, 1, U>& model,
                                                    const Gaussian<N>& prior,
                                                    std::span<const double> z,
                                                    const UniformOptions<N>& options,
                                                    const UniformOutput<N>& output);

/// Results with their own memory.
template <int N>
struct UniformRun {
  std::vector<Mat<N>> means;
  std::vector<Symmetric<N>> covariances;  ///< for Covariances::everywhere
  std::vector<double> innovation, innovation_variance;
  UniformSummary<N> summary;

  /// Covariance at epoch k, wherever it is stored.
  [[nodiscard]] const Symmetric<N>& covariance(std::size_t k) const {
    return covariances.empty() ? summary.covariances.at(k) : covariances[k];
  }
};

/// run_uniform() into newly allocated memory.
template <int N, int U>
[[nodiscard]] Result<UniformRun<N>> smooth_uniform(const LinearModel<N, 1, U>& model,
                                                   const Gaussian<N>& prior,
                                                   std::span<const double> z,
                                                   const UniformOptions<N>& options = {}) {
  UniformRun<N> run;
  run.means.resize(z.size());
  if (options.covariances == Covariances::everywhere) run.covariances.resize(z.size());
  if (options.innovations) {
    run.innovation.resize(z.size());
    run.innovation_variance.resize(z.size());
  }
  auto summary = run_uniform(model, prior, z, options,
                             {run.means, run.covariances, run.innovation, run.innovation_variance});
  if (!summary) return summary.error();
  run.summary = std::move(summary).value();
  return run;
}

}  // namespace proofmass::estimate
