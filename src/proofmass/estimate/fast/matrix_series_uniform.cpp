#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <new>
#include <span>
#include <vector>

#include "proofmass/estimate/fast/matrix_series.hpp"
#include "proofmass/estimate/fast/uniform_smoother.hpp"

namespace proofmass::estimate {
namespace {

template <int N>
LinearModel<N, 1> model_of(const MatrixSeries& series) {
  using Rows = Eigen::Matrix<double, N, N, N == 1 ? Eigen::ColMajor : Eigen::RowMajor>;
  LinearModel<N, 1> model;
  model.F = Eigen::Map<const Rows>(series.F.values.data());
  model.Q = Eigen::Map<const Rows>(series.Q.values.data());
  model.H = Eigen::Map<const Mat<N>>(series.H.values.data()).transpose();
  model.R(0) = series.R.values.front();
  return model;
}

/// The packed covariances are stored at the end of the memory of the whole ones: new memory is the
/// larger part of the cost of a long run.
template <int N>
std::span<Symmetric<N>> packed_part(std::span<double> whole, std::size_t size) {
  double* const first = whole.data() + whole.size() - size * Symmetric<N>::entries;
  return {::new (static_cast<void*>(first)) Symmetric<N>[size], size};
}

/// From the first epoch on: the whole covariances up to k never reach the packed one of k + 1.
template <int N>
void spread(std::span<const Symmetric<N>> packed, double* whole) {
  for (std::size_t k = 0; k < packed.size(); ++k, whole += N * N) {
    const Symmetric<N> cov = packed[k];
    for (int i = 0; i < N; ++i)
      for (int j = 0; j < N; ++j) whole[i * N + j] = cov(i, j);
  }
}

template <int N>
Result<MatrixSummary> run(const MatrixSeries& series, MatrixPass pass, const MatrixOutput& output) {
  constexpr std::size_t states = N;
  const std::size_t size = series.size();
  if (output.mean.size() != size * states || output.cov.size() != size * states * states ||
      output.innovation.size() != size || output.innovation_cov.size() != size)
    return Error{Errc::invalid_argument, "the output's size does not fit the model"};
  Gaussian<N> prior;
  std::copy_n(series.prior_mean.data(), states, prior.mean.data());
  std::copy_n(series.prior_cov.data(), states * states, prior.cov.data());
  std::vector<Mat<N>> means(size);
  const std::span<Symmetric<N>> packed = packed_part<N>(output.cov, size);
  const UniformOptions<N> options{.smooth = pass == MatrixPass::smooth,
                                  .covariances = Covariances::everywhere,
                                  .innovations = true};
  const auto found = run_uniform<N, 0>(model_of<N>(series), prior, series.z, options,
                                       {means, packed, output.innovation, output.innovation_cov});
  if (!found) return found.error();
  for (std::size_t k = 0; k < size; ++k)
    std::copy_n(means[k].data(), states, output.mean.data() + k * states);
  spread<N>(packed, output.cov.data());
  for (std::size_t k = 0; k < size; ++k)
    if (std::isnan(series.z[k]))
      output.innovation_cov[k] = std::numeric_limits<double>::quiet_NaN();
  return MatrixSummary{found->log_likelihood, found->nis, found->readings};
}

}  // namespace

bool is_uniform(const MatrixSeries& series) {
  const auto stays = [](const MatrixSequence& sequence) { return sequence.which.empty(); };
  const auto finite = [](const MatrixSequence& sequence) {
    return std::ranges::all_of(sequence.values, [](double x) { return std::isfinite(x); });
  };
  const std::size_t n = static_cast<std::size_t>(series.states);
  return series.channels == 1 && series.inputs == 0 && n >= 1 && n <= 4 &&
         series.F.values.size() == n * n && series.Q.values.size() == n * n &&
         series.H.values.size() == n && series.R.values.size() == 1 &&
         series.prior_mean.size() == n && series.prior_cov.size() == n * n && stays(series.F) &&
         stays(series.Q) && stays(series.H) && stays(series.R) && finite(series.F) &&
         !series.z.empty() && series.R.values.front() > 0.0;
}

Result<MatrixSummary> run_uniform_matrices(const MatrixSeries& series,
                                           MatrixPass pass,
                                           const MatrixOutput& output) {
  switch (is_uniform(series) && pass != MatrixPass::fixed_lag ? series.states : 0) {
    case 1:
      return run<1>(series, pass, output);
    case 2:
      return run<2>(series, pass, output);
    case 3:
      return run<3>(series, pass, output);
    case 4:
      return run<4>(series, pass, output);
    default:
      return Error{Errc::invalid_argument, "the series is not uniform"};
  }
}

}  // namespace proofmass::estimate
