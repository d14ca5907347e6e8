#include "proofmass/estimate/fast/uniform_smoother.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "proofmass/core/contract.hpp"
#include "proofmass/estimate/fast/uniform_pass.hpp"

namespace proofmass::estimate {
namespace packed {

template <int N>
bool lay_out(Work<N>& work, const Chunk<N>& chunk, std::size_t t) {
  work.lane_z.resize(chunk_length);
  Pair none{};  // 0 as long as all are finite
  for (int lane = 0; lane < lanes; lane += 2) {
    const double* z = work.z.data() + epoch(chunk.first, lane, t);
    double* out = work.lane_z.data() + t * lanes + static_cast<std::size_t>(lane);
    __builtin_prefetch(z + 2 * together);
    __builtin_prefetch(z + 2 * together + lane_length);
    for (std::size_t u = 0; u < together; u += 2) {
      const Pair a = pair_at(z + u), b = pair_at(z + u + lane_length);
      none += 0.0 * a + 0.0 * b;
      write_pair<Write::cached>(__builtin_shufflevector(a, b, 0, 2), out + u * lanes);
      write_pair<Write::cached>(__builtin_shufflevector(a, b, 1, 3), out + (u + 1) * lanes);
    }
  }
  return none[0] + none[1] == 0.0;
}

template bool lay_out(Work<1>&, const Chunk<1>&, std::size_t);
template bool lay_out(Work<2>&, const Chunk<2>&, std::size_t);
template bool lay_out(Work<3>&, const Chunk<3>&, std::size_t);
template bool lay_out(Work<4>&, const Chunk<4>&, std::size_t);

namespace {

template <int N>
Pass pass_of(const Work<N>& work, const Chunk<N>& chunk) {
  if (chunk.first == 0 || chunk.count < chunk_length) return Pass::one_by_one;
  if (!work.steady) return Pass::side_by_side;
  const Mat<N, N> P = dense<N>(chunk.start.P);
  const bool whole = work.options.covariances != Covariances::none;
  const bool constant = whole ? work.steady->limit.all_have_limits &&
                                    settled(work.steady->limit.filtered, P, work.steady->tolerance)
                              : gains_settled(*work.steady, P);
  return constant ? Pass::constant_gain : Pass::side_by_side;
}

template <int N>
Status check_readings(const Work<N>& work, const Chunk<N>& chunk) {
  const auto z = work.z.subspan(chunk.first, chunk.count);
  const auto infinite = std::ranges::find_if(z, [](double reading) { return std::isinf(reading); });
  if (infinite == z.end()) return Done{};
  return Error{Errc::not_finite, "the measurement is infinite; use NaN for a missing one"}.at(
      "epoch " + std::to_string(chunk.first + static_cast<std::size_t>(infinite - z.begin())));
}

/// Filters a chunk by the fastest applicable pass, and records it.
template <int N>
Status filter_chunk(Work<N>& work, Chunk<N>& chunk, State<N>& state) {
  chunk.pass = pass_of(work, chunk);
  if (chunk.pass == Pass::constant_gain && filter_constant_gain(work, chunk, state)) return Done{};
  if (chunk.pass == Pass::side_by_side && filter_side_by_side(work, chunk, state)) return Done{};
  // Infinite measurements end up here: they are no more complete than missing ones.
  chunk.pass = Pass::one_by_one;
  const Status fine = check_readings(work, chunk);
  if (fine) filter_one_by_one(work, chunk, state);
  return fine;
}

template <int N>
Result<std::vector<Chunk<N>>> filter_all(Work<N>& work, State<N> state) {
  std::vector<Chunk<N>> chunks;
  chunks.reserve(work.z.size() / chunk_length + 2);
  for (std::size_t first = 0; first < work.z.size(); first += chunks.back().count) {
    const std::size_t most = first == 0 ? head_length : chunk_length;
    const std::size_t count = std::min(most, work.z.size() - first);
    chunks.push_back({first, count, state, Pass::one_by_one});
    if (const Status fine = filter_chunk(work, chunks.back(), state); !fine) return fine.error();
  }
  return chunks;
}

template <int N>
void smooth_all(Work<N>& work, std::vector<Chunk<N>>& chunks) {
  Later<N> later{};
  for (std::size_t c = chunks.size(); c-- > 0;) {
    Chunk<N>& chunk = chunks[c];
    if (work.options.covariances != Covariances::none) {
      if (chunk.pass == Pass::constant_gain &&
          !settled(work.steady->limit.Lambda, dense<N>(later.L), work.steady->tolerance))
        chunk.pass = Pass::side_by_side;
      if (later.wide) chunk.pass = Pass::one_by_one;
    }
    if (chunk.pass == Pass::one_by_one) smooth_one_by_one(work, chunk, later);
    if (chunk.pass == Pass::side_by_side) smooth_side_by_side(work, chunk, later);
    if (chunk.pass == Pass::constant_gain) smooth_constant_gain(work, chunk, later);
  }
  work.covariances.reverse();
}

template <int N>
UniformSummary<N> summarise(Work<N>& work, const std::vector<Chunk<N>>& chunks) {
  UniformSummary<N> summary;
  summary.covariances = std::move(work.covariances);
  summary.nis = work.score.nis;
  summary.readings = work.score.readings;
  summary.log_likelihood = 0.5 * (work.score.R_S.value() - work.score.nis -
                                  static_cast<double>(summary.readings) *
                                      std::log(2.0 * std::numbers::pi * work.model.R));
  for (const Chunk<N>& chunk : chunks) {
    if (chunk.pass == Pass::one_by_one) summary.one_by_one += chunk.count;
    if (chunk.pass == Pass::side_by_side) summary.side_by_side += chunk.count;
    if (chunk.pass == Pass::constant_gain) summary.constant_gain += chunk.count;
  }
  return summary;
}

template <int N>
Status check(const LinearModel<N, 1>& model, const Gaussian<N>& prior) {
  if (!model.F.allFinite() || !model.Q.allFinite() || !model.H.allFinite() ||
      !prior.mean.allFinite() || !prior.cov.allFinite())
    return Error{Errc::not_finite, "the model or the prior is not finite"};
  if (!(model.R(0) > 0.0) || std::isinf(model.R(0)))
    return Error{Errc::not_positive_definite, "the variance of a measurement is not positive"};
  return Done{};
}

template <int N>
Result<UniformSummary<N>> run(const LinearModel<N, 1>& model,
                              const Gaussian<N>& prior,
                              std::span<const double> z,
                              const UniformOptions<N>& options,
                              const UniformOutput<N>& output) {
  if (const Status fine = check(model, prior); !fine) return fine.error();
  Work<N> work;
  work.model = step_model(model, options.input);
  work.z = z;
  work.options = options;
  work.output = output;
  work.plain = &plain_kernels(work.model);
  if (z.size() > chunk_length) {
    work.side_by_side = &lane_kernels(work.model);
    work.constant_gain = &constant_gain_kernels(work.model);
    work.lane_leap = composed_filter(model, lane_length);
    work.steady = settle(model);
  }
  State<N> state{};
  for (int i = 0; i < N; ++i) {
    state.x[i] = prior.mean(i);
    for (int j = 0; j <= i; ++j) state.P[Symmetric<N>::index(i, j)] = prior.cov(i, j);
  }
  Result<std::vector<Chunk<N>>> filtered = filter_all(work, state);
  if (!filtered) return filtered.error();
  std::vector<Chunk<N>> chunks = std::move(filtered).value();
  if (options.smooth) smooth_all(work, chunks);
  finish_streaming();
  return summarise(work, chunks);
}

}  // namespace
}  // namespace packed

template <int N, int U>
Result<UniformSummary<N>> run_uniform(const LinearModel<N, 1, U>& model,
                                      const Gaussian<N>& prior,
                                      std::span<const double> z,
                                      const UniformOptions<N>& options,
                                      const UniformOutput<N>& output) {
  const auto fits = [&](std::size_t size) { return size == z.size(); };
  const auto fits_or_none = [&](std::size_t size) { return size == 0 || fits(size); };
  PM_EXPECTS(fits(output.means.size()) && fits_or_none(output.covariances.size()) &&
             fits_or_none(output.innovation.size()) &&
             fits_or_none(output.innovation_variance.size()));
  PM_EXPECTS((options.covariances == Covariances::everywhere) == !output.covariances.empty() ||
             z.empty());
  return packed::run<N>({model.F, model.Q, model.H, model.R}, prior, z, options, output);
}

template Result<UniformSummary<1>> run_uniform(const LinearModel<1, 1, 0>&,
                                               const Gaussian<1>&,
                                               std::span<const double>,
                                               const UniformOptions<1>&,
                                               const UniformOutput<1>&);
template Result<UniformSummary<1>> run_uniform(const LinearModel<1, 1, 1>&,
                                               const Gaussian<1>&,
                                               std::span<const double>,
                                               const UniformOptions<1>&,
                                               const UniformOutput<1>&);
template Result<UniformSummary<2>> run_uniform(const LinearModel<2, 1, 0>&,
                                               const Gaussian<2>&,
                                               std::span<const double>,
                                               const UniformOptions<2>&,
                                               const UniformOutput<2>&);
template Result<UniformSummary<2>> run_uniform(const LinearModel<2, 1, 1>&,
                                               const Gaussian<2>&,
                                               std::span<const double>,
                                               const UniformOptions<2>&,
                                               const UniformOutput<2>&);
template Result<UniformSummary<3>> run_uniform(const LinearModel<3, 1, 0>&,
                                               const Gaussian<3>&,
                                               std::span<const double>,
                                               const UniformOptions<3>&,
                                               const UniformOutput<3>&);
template Result<UniformSummary<3>> run_uniform(const LinearModel<3, 1, 1>&,
                                               const Gaussian<3>&,
                                               std::span<const double>,
                                               const UniformOptions<3>&,
                                               const UniformOutput<3>&);
template Result<UniformSummary<4>> run_uniform(const LinearModel<4, 1, 0>&,
                                               const Gaussian<4>&,
                                               std::span<const double>,
                                               const UniformOptions<4>&,
                                               const UniformOutput<4>&);
template Result<UniformSummary<4>> run_uniform(const LinearModel<4, 1, 1>&,
                                               const Gaussian<4>&,
                                               std::span<const double>,
                                               const UniformOptions<4>&,
                                               const UniformOutput<4>&);

}  // namespace proofmass::estimate
