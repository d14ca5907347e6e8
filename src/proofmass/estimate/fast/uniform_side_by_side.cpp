#include <cmath>

#include "proofmass/estimate/fast/uniform_pass.hpp"

namespace proofmass::estimate::packed {
namespace {

template <int N>
using Leaps = std::vector<CompositionStart<N>>;

/// The composition of each lane, each from the end of the previous one; P of each lane's beginning
/// to `state`.
template <int N>
Leaps<N> leap_through(const Work<N>& work, const Chunk<N>& chunk, LaneState<N>& state) {
  Leaps<N> leaps;
  leaps.reserve(lanes);
  Mat<N, N> P = dense<N>(chunk.start.P);
  for (int lane = 0; lane < lanes; ++lane) {
    for (int i = 0; i < N; ++i)
      for (int j = 0; j <= i; ++j) state.P[Symmetric<N>::index(i, j)][lane] = P(i, j);
    P = leaps.emplace_back(work.lane_leap, P).P;
  }
  return leaps;
}

/// Whether the chunk begins with a strongly shrinking covariance: the digits lost there are
/// recovered only by the pass of one epoch after another.
template <int N>
bool begins_wide(const Chunk<N>& chunk, const Leaps<N>& leaps) {
  for (int i = 0; i < N; ++i)
    if (chunk.start.P[Symmetric<N>::index(i, i)] > 1e3 * leaps[0].P(i, i)) return true;
  return false;
}

/// Whether each lane ends with the covariance with which the next began.
template <int N>
bool closes(const Leaps<N>& leaps, const LaneState<N>& end) {
  constexpr double tolerance = 1e-10;
  for (int lane = 0; lane < lanes; ++lane) {
    const Mat<N, N>& P = leaps[static_cast<std::size_t>(lane)].P;
    for (int i = 0; i < N; ++i)
      for (int j = 0; j <= i; ++j) {
        const double off = end.P[Symmetric<N>::index(i, j)][lane] - P(i, j);
        if (!(std::abs(off) <= tolerance * std::sqrt(P(i, i) * P(j, j)))) return false;
      }
  }
  return true;
}

template <int N>
void add_score(Work<N>& work) {
  constexpr std::size_t together = 8;
  for (std::size_t t = 0; t < lane_length; t += together) {
    LaneScore some{};
    for (double& product : some.R_S) product = 1.0;
    work.side_by_side->score(work.model, work.lane_rows.data() + t,
                             static_cast<int>(std::min(together, lane_length - t)), some);
    for (int lane = 0; lane < lanes; ++lane) {
      work.score.nis += some.nis[lane];
      work.score.R_S.multiply(some.R_S[lane]);
    }
  }
  work.score.readings += chunk_length;
}

template <int N>
Symmetric<N> covariance(const LaneRow<N>& row, int lane) {
  Symmetric<N> P;
  for (std::size_t e = 0; e < P.lower.size(); ++e) P.lower[e] = row.P[e][lane];
  return P;
}

template <int N>
void write_innovations(const Work<N>& work, const Chunk<N>& chunk) {
  for (std::size_t t = 0; t < lane_length; ++t)
    for (int lane = 0; lane < lanes; ++lane) {
      const LaneRow<N>& row = work.lane_rows[t];
      const std::size_t k = epoch(chunk.first, lane, t);
      if (!work.output.innovation.empty())
        work.output.innovation[k] = row.y_S[lane] / row.per_S[lane];
      if (!work.output.innovation_variance.empty())
        work.output.innovation_variance[k] = 1.0 / row.per_S[lane];
    }
}

template <int N>
void keep_covariances(Work<N>& work) {
  const bool smooth = work.options.smooth;
  for (std::size_t i = 0; i < chunk_length; ++i) {
    const std::size_t at = smooth ? chunk_length - 1 - i : i;
    work.covariances.push(
        covariance(work.lane_rows[at % lane_length], static_cast<int>(at / lane_length)));
  }
}

/// The filter over the chunk, from `state` before it; rows are stored on request. Returns whether
/// all measurements are present.
template <int N>
bool filter_lanes(Work<N>& work, const Chunk<N>& chunk, LaneState<N>& state, bool keep) {
  work.lane_rows.resize(lane_length);
  for (std::size_t t = 0; t < lane_length; t += together) {
    if (!lay_out(work, chunk, t)) return false;
    work.side_by_side->filter(work.model, work.lane_z.data() + t * lanes, together, state,
                              keep ? work.lane_rows.data() + t : nullptr);
  }
  return true;
}

template <int N>
void write_side_by_side(Work<N>& work, const Chunk<N>& chunk) {
  const UniformOutput<N>& out = work.output;
  write_lanes<N>(chunk.first, out.means, [&](std::size_t t) { return work.lane_rows[t].x; });
  if (!out.covariances.empty())
    write_lanes<Symmetric<N>::entries>(chunk.first, out.covariances,
                                       [&](std::size_t t) { return work.lane_rows[t].P; });
  if (!out.innovation.empty() || !out.innovation_variance.empty()) write_innovations(work, chunk);
  if (work.options.covariances == Covariances::where_they_change) keep_covariances(work);
}

}  // namespace

template <int N>
bool filter_side_by_side(Work<N>& work, const Chunk<N>& chunk, State<N>& state) {
  LaneState<N> lane{};
  const Leaps<N> leaps = leap_through(work, chunk, lane);
  if (begins_wide(chunk, leaps)) return false;
  for (int i = 0; i < N; ++i) lane.x[i][0] = state.x[i];
  if (!filter_lanes(work, chunk, lane, !work.options.smooth)) return false;
  if (!closes(leaps, lane)) return false;

  // All lanes but the first started with the mean 0: the effect of their true initial mean is
  // added.
  LaneNumbers begin[N];
  Mat<N> x = column(chunk.start.x);
  for (int l = 0; l < lanes; ++l) {
    set_lane<N>(x, l, begin);
    if (work.options.smooth) work.output.means[epoch(chunk.first, l, 0)] = x;
    const Mat<N> end = lane_of<N>(lane.x, l);
    x = l == 0 ? end : Mat<N>(end + leaps[static_cast<std::size_t>(l)].Phi * x);
  }
  for (int i = 0; i < N; ++i) state.x[i] = x(i);
  for (std::size_t e = 0; e < Symmetric<N>::entries; ++e) state.P[e] = lane.P[e][lanes - 1];
  if (work.options.smooth) return true;
  work.side_by_side->filter_means(work.model, work.lane_z.data(), lane_length, begin,
                                  work.lane_rows.data());
  add_score(work);
  write_side_by_side(work, chunk);
  return true;
}

template <int N>
void smooth_side_by_side(Work<N>& work, const Chunk<N>& chunk, Later<N>& later) {
  LaneState<N> lane{};
  const Leaps<N> leaps = leap_through(work, chunk, lane);
  for (int l = 0; l < lanes; ++l)
    set_lane<N>(work.output.means[epoch(chunk.first, l, 0)], l, lane.x);
  (void)filter_lanes(work, chunk, lane, true);
  add_score(work);

  LaneNumbers begin[N] = {};
  for (int i = 0; i < N; ++i) begin[i][lanes - 1] = later.l[i];
  work.side_by_side->look_back(work.model, work.lane_rows.data(), lane_length, begin);
  LaneLater<N> lane_later;
  Mat<N> l = column(later.l);
  Mat<N, N> L = dense<N>(later.L);
  for (int at = lanes - 1; at >= 0; --at) {
    set_lane<N>(l, at, lane_later.l);
    for (int i = 0; i < N; ++i)
      for (int j = 0; j <= i; ++j) lane_later.L[Symmetric<N>::index(i, j)][at] = L(i, j);
    const CompositionStart<N>& leap = leaps[static_cast<std::size_t>(at)];
    const Mat<N> own = lane_of<N>(begin, at);
    l = at == lanes - 1 ? own : Mat<N>(own + leap.Phi.transpose() * l);
    L = (leap.Lambda + leap.Phi.transpose() * L * leap.Phi).eval();
  }
  if (work.options.covariances == Covariances::none)
    work.side_by_side->smooth_means(work.model, work.lane_rows.data(), lane_length, lane_later.l);
  else
    work.side_by_side->smooth(work.model, work.lane_rows.data(), lane_length, lane_later);
  for (std::size_t e = 0; e < Symmetric<N>::entries; ++e) {
    later.L[e] = lane_later.L[e][0];
    later.next[e] = work.lane_rows[0].P[e][0];
  }
  for (int i = 0; i < N; ++i) later.l[i] = lane_later.l[i][0];
  write_side_by_side(work, chunk);
}

template bool filter_side_by_side(Work<1>&, const Chunk<1>&, State<1>&);
template bool filter_side_by_side(Work<2>&, const Chunk<2>&, State<2>&);
template bool filter_side_by_side(Work<3>&, const Chunk<3>&, State<3>&);
template bool filter_side_by_side(Work<4>&, const Chunk<4>&, State<4>&);
template void smooth_side_by_side(Work<1>&, const Chunk<1>&, Later<1>&);
template void smooth_side_by_side(Work<2>&, const Chunk<2>&, Later<2>&);
template void smooth_side_by_side(Work<3>&, const Chunk<3>&, Later<3>&);
template void smooth_side_by_side(Work<4>&, const Chunk<4>&, Later<4>&);

}  // namespace proofmass::estimate::packed
