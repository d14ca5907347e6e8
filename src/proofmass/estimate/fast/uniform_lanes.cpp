#include "proofmass/estimate/fast/uniform_lanes.hpp"

#include "proofmass/core/vector_clones.hpp"
#include "proofmass/estimate/fast/one_lane.hpp"
#include "proofmass/estimate/fast/packed_patterns.hpp"

namespace proofmass::estimate::packed {
namespace {

template <int N, Pattern S, bool keep>
[[gnu::always_inline]] inline void filter_loop(
    const StepModel<N>& m, const double* z, int count, LaneState<N>& state, LaneRow<N>* rows) {
  constexpr int E = Symmetric<N>::entries;
  for (int t = 0; t < count; ++t, z += lanes) {
#pragma GCC ivdep
    for (int lane = 0; lane < lanes; ++lane) {
      double P[E], x[N], K[N];
      load(state.P, lane, P);
      load(state.x, lane, x);
      predict_mean<N, S>(m, x);
      predict_cov<N, S>(m, P);
      const double per_S = correct_cov<N, S>(m, P, K);
      const double y = z[lane] - predicted_reading<N, S>(m, x);
      add_gain(K, y, x);
      store(P, lane, state.P);
      store(x, lane, state.x);
      if constexpr (keep) {
        store(P, lane, rows[t].P);
        store(x, lane, rows[t].x);
        store(K, lane, rows[t].K);
        rows[t].y_S[lane] = y * per_S;
        rows[t].per_S[lane] = per_S;
      }
    }
  }
}

template <int N, Pattern S>
PM_VECTOR_CLONES void filter_ends(const StepModel<N>& m,
                                  const double* __restrict z,
                                  int count,
                                  LaneState<N>& __restrict state) {
  filter_loop<N, S, false>(m, z, count, state, nullptr);
}

template <int N, Pattern S>
PM_VECTOR_CLONES void filter_rows(const StepModel<N>& m,
                                  const double* __restrict z,
                                  int count,
                                  LaneState<N>& __restrict state,
                                  LaneRow<N>* __restrict rows) {
  filter_loop<N, S, true>(m, z, count, state, rows);
}

template <int N, Pattern S>
void filter(
    const StepModel<N>& m, const double* z, int count, LaneState<N>& state, LaneRow<N>* rows) {
  if (rows != nullptr)
    filter_rows<N, S>(m, z, count, state, rows);
  else
    filter_ends<N, S>(m, z, count, state);
}

template <int N, Pattern S>
PM_VECTOR_CLONES void filter_means(const StepModel<N>& m,
                                   const double* __restrict z,
                                   int count,
                                   LaneNumbers* __restrict means,
                                   LaneRow<N>* __restrict rows) {
  for (int t = 0; t < count; ++t, z += lanes) {
#pragma GCC ivdep
    for (int lane = 0; lane < lanes; ++lane) {
      double x[N], K[N];
      load(means, lane, x);
      load(rows[t].K, lane, K);
      predict_mean<N, S>(m, x);
      const double y = z[lane] - predicted_reading<N, S>(m, x);
      add_gain(K, y, x);
      store(x, lane, means);
      store(x, lane, rows[t].x);
      rows[t].y_S[lane] = y * rows[t].per_S[lane];
    }
  }
}

template <int N, Pattern S>
PM_VECTOR_CLONES void look_back(const StepModel<N>& m,
                                const LaneRow<N>* __restrict rows,
                                int count,
                                LaneNumbers* __restrict later) {
  for (int t = count; t-- > 0;) {
#pragma GCC ivdep
    for (int lane = 0; lane < lanes; ++lane) {
      double l[N], K[N];
      load(later, lane, l);
      load(rows[t].K, lane, K);
      mean_back<N, S>(m, K, rows[t].y_S[lane], l);
      store(l, lane, later);
    }
  }
}

template <int N, Pattern S>
PM_VECTOR_CLONES void smooth(const StepModel<N>& m,
                             LaneRow<N>* __restrict rows,
                             int count,
                             LaneLater<N>& __restrict later) {
  constexpr int E = Symmetric<N>::entries;
  for (int t = count; t-- > 0;) {
#pragma GCC ivdep
    for (int lane = 0; lane < lanes; ++lane) {
      double P[E], L[E], x[N], l[N], K[N];
      load(rows[t].P, lane, P);
      load(rows[t].x, lane, x);
      load(rows[t].K, lane, K);
      load(later.L, lane, L);
      load(later.l, lane, l);
      smooth_mean<N, S>(P, l, x);
      smooth_cov<N, S>(L, P);
      mean_back<N, S>(m, K, rows[t].y_S[lane], l);
      uncorrect_Lambda<N, S>(m, K, rows[t].per_S[lane], L);
      unpredict_Lambda<N, S>(m, L);
      store(P, lane, rows[t].P);
      store(x, lane, rows[t].x);
      store(L, lane, later.L);
      store(l, lane, later.l);
    }
  }
}

template <int N, Pattern S>
PM_VECTOR_CLONES void smooth_means(const StepModel<N>& m,
                                   LaneRow<N>* __restrict rows,
                                   int count,
                                   LaneNumbers* __restrict later) {
  for (int t = count; t-- > 0;) {
#pragma GCC ivdep
    for (int lane = 0; lane < lanes; ++lane) {
      double P[Symmetric<N>::entries], x[N], l[N], K[N];
      load(rows[t].P, lane, P);
      load(rows[t].x, lane, x);
      load(rows[t].K, lane, K);
      load(later, lane, l);
      smooth_mean<N, S>(P, l, x);
      mean_back<N, S>(m, K, rows[t].y_S[lane], l);
      store(x, lane, rows[t].x);
      store(l, lane, later);
    }
  }
}

template <int N>
PM_VECTOR_CLONES void add_score(const StepModel<N>& m,
                                const LaneRow<N>* __restrict rows,
                                int count,
                                LaneScore& __restrict score) {
  for (int t = 0; t < count; ++t)
    for (int lane = 0; lane < lanes; ++lane) {
      const double y_S = rows[t].y_S[lane], per_S = rows[t].per_S[lane];
      score.nis[lane] += y_S * y_S / per_S;
      score.R_S[lane] *= m.R * per_S;
    }
}

template <int N, Pattern S>
constexpr LaneKernels<N> kernels_of() {
  return {filter<N, S>, filter_means<N, S>, look_back<N, S>,
          smooth<N, S>, smooth_means<N, S>, add_score<N>};
}

template <int N, std::size_t... I>
constexpr auto kernels(std::index_sequence<I...>) {
  return std::array{kernels_of<N, patterns<N>[I]>()...};
}
template <int N>
constexpr auto all_kernels = kernels<N>(std::make_index_sequence<patterns<N>.size()>{});

}  // namespace

template <int N>
const LaneKernels<N>& lane_kernels(const StepModel<N>& model) {
  return all_kernels<N>[pattern_of(model)];
}

template const LaneKernels<1>& lane_kernels(const StepModel<1>&);
template const LaneKernels<2>& lane_kernels(const StepModel<2>&);
template const LaneKernels<3>& lane_kernels(const StepModel<3>&);
template const LaneKernels<4>& lane_kernels(const StepModel<4>&);

}  // namespace proofmass::estimate::packed
