#include <algorithm>
#include <cmath>

#include "proofmass/estimate/fast/uniform_pass.hpp"

namespace proofmass::estimate::packed {
namespace {

/// The filter over the chunk, from `x` before it, storing only its end. Returns whether all
/// measurements are present.
template <int N>
bool filter_ends(Work<N>& work, const Chunk<N>& chunk, LaneNumbers* x) {
  LaneNumbers unused{};
  for (std::size_t t = 0; t < lane_length; t += together) {
    if (!lay_out(work, chunk, t)) return false;
    work.constant_gain->filter(work.model, work.steady->gain, work.lane_z.data() + t * lanes,
                               together, x, nullptr, unused);
  }
  return true;
}

/// The filter from the correct initial means: the means of each epoch, and the likelihood of the
/// measurements.
template <int N>
void filter_means(Work<N>& work, const Chunk<N>& chunk, bool laid_out, LaneNumbers* x) {
  LaneNumbers squares{};
  work.lane_means.resize(lane_length);
  for (std::size_t t = 0; t < lane_length; t += together) {
    if (!laid_out) (void)lay_out(work, chunk, t);
    work.constant_gain->filter(work.model, work.steady->gain, work.lane_z.data() + t * lanes,
                               together, x, work.lane_means.data() + t, squares);
  }
  const double per_S = work.steady->gain.per_S;
  for (const double sum : squares) work.score.nis += sum / per_S;
  work.score.R_S.multiply(work.model.R * per_S, chunk_length);
  work.score.readings += chunk_length;
}

template <int N>
void write_constant_gain(Work<N>& work, const Chunk<N>& chunk) {
  const UniformOutput<N>& out = work.output;
  const Steady<N>& steady = *work.steady;
  write_lanes<N>(chunk.first, out.means, [&](std::size_t t) { return work.lane_means[t].x; });
  const Symmetric<N>& cov = work.options.smooth ? steady.limit.smoothed : steady.limit.filtered;
  if (!out.covariances.empty())
    std::ranges::fill(out.covariances.subspan(chunk.first, chunk.count), cov);
  if (work.options.covariances == Covariances::where_they_change)
    work.covariances.push(cov, chunk.count);
  if (!out.innovation_variance.empty())
    std::ranges::fill(out.innovation_variance.subspan(chunk.first, chunk.count),
                      1.0 / steady.gain.per_S);
  if (out.innovation.empty()) return;
  for (std::size_t t = 0; t < lane_length; ++t)
    for (int lane = 0; lane < lanes; ++lane)
      out.innovation[epoch(chunk.first, lane, t)] =
          work.lane_means[t].y_S[lane] / steady.gain.per_S;
}

}  // namespace

template <int N>
bool filter_constant_gain(Work<N>& work, const Chunk<N>& chunk, State<N>& state) {
  const Steady<N>& steady = *work.steady;
  LaneNumbers end[N] = {}, begin[N];
  Mat<N> x = column(state.x);
  set_lane<N>(x, 0, end);
  if (!filter_ends(work, chunk, end)) return false;
  // All lanes but the first started with the mean 0: the effect of their true initial mean is
  // added.
  for (int l = 0; l < lanes; ++l) {
    set_lane<N>(x, l, begin);
    if (work.options.smooth) work.output.means[epoch(chunk.first, l, 0)] = x;
    const Mat<N> own = lane_of<N>(end, l);
    x = l == 0 ? own : Mat<N>(own + steady.lane_decay * x);
  }
  for (int i = 0; i < N; ++i) state.x[i] = x(i);
  if (work.options.smooth) return true;
  filter_means(work, chunk, true, begin);
  write_constant_gain(work, chunk);
  return true;
}

template <int N>
void smooth_constant_gain(Work<N>& work, const Chunk<N>& chunk, Later<N>& later) {
  const Steady<N>& steady = *work.steady;
  LaneNumbers x[N], l[N] = {};
  for (int lane = 0; lane < lanes; ++lane)
    set_lane<N>(work.output.means[epoch(chunk.first, lane, 0)], lane, x);
  filter_means(work, chunk, false, x);
  Mat<N> after = column(later.l);
  set_lane<N>(after, lanes - 1, l);
  work.constant_gain->look_back(work.model, steady.gain, work.lane_means.data(), lane_length, l);
  for (int lane = lanes - 1; lane >= 0; --lane) {
    const Mat<N> own = lane_of<N>(l, lane);
    set_lane<N>(after, lane, l);
    after = lane == lanes - 1 ? own : Mat<N>(own + steady.lane_decay.transpose() * after);
  }
  work.constant_gain->smooth(work.model, steady.gain, work.lane_means.data(), lane_length, l);
  for (int i = 0; i < N; ++i) later.l[i] = l[i][0];
  for (std::size_t e = 0; e < Symmetric<N>::entries; ++e)
    later.next[e] = steady.limit.smoothed.lower[e];
  write_constant_gain(work, chunk);
}

template bool filter_constant_gain(Work<1>&, const Chunk<1>&, State<1>&);
template bool filter_constant_gain(Work<2>&, const Chunk<2>&, State<2>&);
template bool filter_constant_gain(Work<3>&, const Chunk<3>&, State<3>&);
template bool filter_constant_gain(Work<4>&, const Chunk<4>&, State<4>&);
template void smooth_constant_gain(Work<1>&, const Chunk<1>&, Later<1>&);
template void smooth_constant_gain(Work<2>&, const Chunk<2>&, Later<2>&);
template void smooth_constant_gain(Work<3>&, const Chunk<3>&, Later<3>&);
template void smooth_constant_gain(Work<4>&, const Chunk<4>&, Later<4>&);

}  // namespace proofmass::estimate::packed
