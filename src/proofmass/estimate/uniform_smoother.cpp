#include "proofmass/estimate/uniform_smoother.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>

#include "proofmass/core/contract.hpp"
#include "proofmass/estimate/uniform_pass.hpp"

namespace proofmass::estimate {
namespace packed {

template <int N>
bool lay_out(Work<N>& work, const Chunk<N>& chunk, std::size_t t) {
  work.lane_z.resize(chunk_length);
  Pair none{};  // 0 as long as all are finite
  for (int lane = 0; lane < lanes; lane += 2) {
    const double* z = work.z.data() + instant(chunk.first, lane, t);
    double* out = work.lane_z.data() + t * lanes + static_cast<std::size_t>(lane);
    __builtin_prefetch(z + 2 * together);
    __builtin_prefetch(z + 2 * together + lane_length);
    for (std::size_t u = 0; u < together; u += 2) {
      Pair a, b;
      std::memcpy(&a, z + u, sizeof a);
      std::memcpy(&b, z + u + lane_length, sizeof b);
      none += 0.0 * a + 0.0 * b;
      const Pair now = __builtin_shufflevector(a, b, 0, 2);
      const Pair next = __builtin_shufflevector(a, b, 1, 3);
      std::memcpy(out + u * lanes, &now, sizeof now);
      std::memcpy(out + (u + 1) * lanes, &next, sizeof next);
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
std::optional<Steady<N>> settle(const LinearModel<N, 1>& model) {
  const Result<SteadyState<N, 1>> limit = steady_state(model);
  if (!limit) return std::nullopt;
  Steady<N> steady{*limit, {}, Mat<N, N>::Identity(), 0.0};
  steady.gain.per_S = 1.0 / limit->innovation_variance(0);
  for (int i = 0; i < N; ++i) {
    steady.gain.K[i] = limit->gain(i);
    for (int j = 0; j < N; ++j) steady.gain.seen[i][j] = limit->seen(i, j);
  }
  Mat<N, N> decay = model.F - limit->gain * (model.H * model.F);
  for (std::size_t left = lane_length; left > 0; left /= 2, decay = (decay * decay).eval())
    if (left % 2 == 1) steady.lane_decay = (steady.lane_decay * decay).eval();
  // Rounding of a step, and what is left of it after so many.
  steady.tolerance = std::clamp(
      8.0 * std::numeric_limits<double>::epsilon() * limit->slowest_steps, 1e-12, 1e-10);
  return steady;
}

/// Whether what the readings see of P, and so every gain from here on, has come to its limit. Each
/// entry is judged by itself and relatively; steps from one instant to the next would say nothing,
/// since a slow mode's are always small.
template <int N>
bool gains_settled(const Steady<N>& steady, const Mat<N, N>& P) {
  const Mat<N, N>& seen = steady.limit.seen;
  for (int j = 0; j < N; ++j) {
    if (seen(j, j) == 0.0) continue;
    for (int i = 0; i < N; ++i) {
      const double size = std::max(std::abs(seen(i, j)), 1e-6 * std::sqrt(P(i, i) * seen(j, j)));
      if (!(std::abs(P(i, j) - seen(i, j)) <= steady.tolerance * size)) return false;
    }
  }
  return true;
}

/// Whether all of P has.
template <int N>
bool settled(const Symmetric<N>& limit, const Mat<N, N>& P, double tolerance) {
  for (int i = 0; i < N; ++i)
    for (int j = 0; j <= i; ++j)
      if (!(std::abs(P(i, j) - limit(i, j)) <= tolerance * std::sqrt(limit(i, i) * limit(j, j))))
        return false;
  return true;
}

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
  return Error{Errc::not_finite, "the reading is infinite; NaN says there is none"}.at(
      "instant " + std::to_string(chunk.first + static_cast<std::size_t>(infinite - z.begin())));
}

/// Filters a chunk by the fastest pass that it allows, and notes which.
template <int N>
Status filter_chunk(Work<N>& work, Chunk<N>& chunk, State<N>& state) {
  chunk.pass = pass_of(work, chunk);
  if (chunk.pass == Pass::constant_gain && filter_constant_gain(work, chunk, state)) return Done{};
  if (chunk.pass == Pass::side_by_side && filter_side_by_side(work, chunk, state)) return Done{};
  // Infinite readings end up here: they are no more complete than missing ones.
  chunk.pass = Pass::one_by_one;
  const Status fine = check_readings(work, chunk);
  if (fine) filter_one_by_one(work, chunk, state);
  return fine;
}

template <int N>
Result<std::vector<Chunk<N>>> filter_all(Work<N>& work, State<N> state) {
  std::vector<Chunk<N>> chunks;
  chunks.reserve(work.z.size() / chunk_length + 1);
  for (std::size_t first = 0; first < work.z.size(); first += chunk_length) {
    const std::size_t count = std::min(chunk_length, work.z.size() - first);
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
  summary.log_likelihood =
      0.5 * (work.score.R_S.value() - work.score.nis -
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
    return Error{Errc::not_finite, "the model or the prior holds what is no number"};
  if (!(model.R(0) > 0.0) || std::isinf(model.R(0)))
    return Error{Errc::not_positive_definite, "the variance of a reading is not positive"};
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
    work.lane_leap = filter_leap(model, lane_length);
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
