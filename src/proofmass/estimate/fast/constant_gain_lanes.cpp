#include "proofmass/estimate/fast/constant_gain_lanes.hpp"

#include <array>

#include "proofmass/core/vector_clones.hpp"
#include "proofmass/estimate/fast/one_lane.hpp"
#include "proofmass/estimate/fast/packed_patterns.hpp"

namespace proofmass::estimate::packed {
namespace {

template <int N, Pattern S, bool keep>
[[gnu::always_inline]] inline void constant_loop(const StepModel<N>& m,
                                                 const ConstantGain<N>& gain,
                                                 const double* z,
                                                 int count,
                                                 LaneNumbers* state,
                                                 LaneMean<N>* means,
                                                 LaneNumbers& squares) {
  for (int t = 0; t < count; ++t, z += lanes) {
#pragma GCC ivdep
    for (int lane = 0; lane < lanes; ++lane) {
      double x[N];
      load(state, lane, x);
      predict_mean<N, S>(m, x);
      const double y = z[lane] - predicted_reading<N, S>(m, x);
      add_gain(gain.K, y, x);
      store(x, lane, state);
      if constexpr (keep) {
        const double y_S = y * gain.per_S;
        store(x, lane, means[t].x);
        means[t].y_S[lane] = y_S;
        squares[lane] += y_S * y_S;
      }
    }
  }
}

template <int N, Pattern S>
PM_VECTOR_CLONES void constant_ends(const StepModel<N>& m,
                                    const ConstantGain<N>& gain,
                                    const double* __restrict z,
                                    int count,
                                    LaneNumbers* __restrict x,
                                    LaneNumbers& __restrict squares) {
  constant_loop<N, S, false>(m, gain, z, count, x, nullptr, squares);
}

template <int N, Pattern S>
PM_VECTOR_CLONES void constant_rows(const StepModel<N>& m,
                                    const ConstantGain<N>& gain,
                                    const double* __restrict z,
                                    int count,
                                    LaneNumbers* __restrict x,
                                    LaneMean<N>* __restrict means,
                                    LaneNumbers& __restrict squares) {
  constant_loop<N, S, true>(m, gain, z, count, x, means, squares);
}

template <int N, Pattern S>
void filter(const StepModel<N>& m,
            const ConstantGain<N>& gain,
            const double* z,
            int count,
            LaneNumbers* x,
            LaneMean<N>* means,
            LaneNumbers& squares) {
  if (means != nullptr)
    constant_rows<N, S>(m, gain, z, count, x, means, squares);
  else
    constant_ends<N, S>(m, gain, z, count, x, squares);
}

template <int N, Pattern S>
PM_VECTOR_CLONES void look_back(const StepModel<N>& m,
                                const ConstantGain<N>& gain,
                                const LaneMean<N>* __restrict means,
                                int count,
                                LaneNumbers* __restrict later) {
  for (int t = count; t-- > 0;) {
#pragma GCC ivdep
    for (int lane = 0; lane < lanes; ++lane) {
      double l[N];
      load(later, lane, l);
      mean_back<N, S>(m, gain.K, means[t].y_S[lane], l);
      store(l, lane, later);
    }
  }
}

template <int N, Pattern S>
PM_VECTOR_CLONES void smooth(const StepModel<N>& m,
                             const ConstantGain<N>& gain,
                             LaneMean<N>* __restrict means,
                             int count,
                             LaneNumbers* __restrict later) {
  constexpr unsigned nothing = unseen<N>(S);
  for (int t = count; t-- > 0;) {
#pragma GCC ivdep
    for (int lane = 0; lane < lanes; ++lane) {
      double x[N], l[N];
      load(means[t].x, lane, x);
      load(later, lane, l);
      detail::each<N>([&](auto i) __attribute__((always_inline)) {
        detail::each<N>([&](auto j) __attribute__((always_inline)) {
          if constexpr (!detail::claimed(nothing, j())) x[i()] -= gain.seen[i()][j()] * l[j()];
        });
      });
      mean_back<N, S>(m, gain.K, means[t].y_S[lane], l);
      store(x, lane, means[t].x);
      store(l, lane, later);
    }
  }
}

template <int N, std::size_t... I>
constexpr auto kernels(std::index_sequence<I...>) {
  return std::array{ConstantGainKernels<N>{filter<N, patterns<N>[I]>, look_back<N, patterns<N>[I]>,
                                           smooth<N, patterns<N>[I]>}...};
}
template <int N>
constexpr auto all_kernels = kernels<N>(std::make_index_sequence<patterns<N>.size()>{});

}  // namespace

template <int N>
const ConstantGainKernels<N>& constant_gain_kernels(const StepModel<N>& model) {
  return all_kernels<N>[pattern_of(model)];
}

template const ConstantGainKernels<1>& constant_gain_kernels(const StepModel<1>&);
template const ConstantGainKernels<2>& constant_gain_kernels(const StepModel<2>&);
template const ConstantGainKernels<3>& constant_gain_kernels(const StepModel<3>&);
template const ConstantGainKernels<4>& constant_gain_kernels(const StepModel<4>&);

}  // namespace proofmass::estimate::packed
