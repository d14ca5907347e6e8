#include "proofmass/estimate/fast/packed_filter.hpp"

#include <Eigen/LU>
#include <cmath>
#include <utility>

#include "proofmass/estimate/fast/packed_kalman.hpp"
#include "proofmass/estimate/fast/packed_patterns.hpp"

namespace proofmass::estimate::packed {
namespace {

using detail::each;

template <int N>
Mat<N, N> dense(const double (&P)[Symmetric<N>::entries]) {
  Mat<N, N> out;
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < N; ++j) out(i, j) = P[Symmetric<N>::index(i, j)];
  return out;
}

template <int N>
void pack(const Mat<N, N>& P, double (&out)[Symmetric<N>::entries]) {
  for (int i = 0; i < N; ++i)
    for (int j = 0; j <= i; ++j) out[Symmetric<N>::index(i, j)] = 0.5 * (P(i, j) + P(j, i));
}

/// Joseph form of correct_cov, for a P so much wider than the measurement that differences of its
/// entries lose their digits.
template <int N>
[[gnu::noinline]] void correct_wide(const StepModel<N>& m,
                                    const double (&before)[Symmetric<N>::entries],
                                    const double (&K)[N],
                                    double (&P)[Symmetric<N>::entries]) {
  const Mat<N> gain = Eigen::Map<const Mat<N>>(K), h = Eigen::Map<const Mat<N>>(m.h);
  const Mat<N, N> I_Kh = Mat<N, N>::Identity() - gain * h.transpose();
  pack<N>(I_Kh * dense<N>(before) * I_Kh.transpose() + m.R * gain * gain.transpose(), P);
}

/// Whether P − P Λ P is so much smaller than P that the difference loses its digits.
template <int N>
[[gnu::always_inline]] inline bool lost(const double (&filtered)[Symmetric<N>::entries],
                                        const double (&smoothed)[Symmetric<N>::entries]) {
  bool any = false;
  each<N>([&](auto i) __attribute__((always_inline)) {
    constexpr int ii = detail::at<N>(i(), i());
    any = any || !(smoothed[ii] >= 1e-4 * filtered[ii]);
  });
  return any;
}

/// Rauch–Tung–Striebel covariance as a sum of squares, which loses no digits if P is wide:
///     P[k|N] = (I − G F) P (I − G F)ᵀ + G (Q + P[k+1|N]) Gᵀ,   G = P Fᵀ (F P Fᵀ + Q)⁻¹.
/// Leaves `smoothed` unchanged if that inverse does not exist. Returns whether `smoothed` changed.
template <int N>
[[gnu::noinline]] bool smooth_wide(const StepModel<N>& m,
                                   const double (&filtered)[Symmetric<N>::entries],
                                   const double (&next)[Symmetric<N>::entries],
                                   double (&smoothed)[Symmetric<N>::entries]) {
  const Mat<N, N> F =
      Eigen::Map<const Eigen::Matrix<double, N, N, N == 1 ? 0 : Eigen::RowMajor>>(&m.F[0][0]);
  const Mat<N, N> P = dense<N>(filtered), predicted = F * P * F.transpose() + dense<N>(m.Q);
  // Scaled by the standard deviations, so that pivots do not depend on the units of the states.
  const Mat<N> scale = predicted.diagonal().cwiseSqrt().cwiseInverse();
  const Mat<N, N> scaled = scale.asDiagonal() * predicted * scale.asDiagonal();
  const Mat<N, N> FP = scale.asDiagonal() * F * P;
  const Mat<N, N> G = (scale.asDiagonal() * scaled.partialPivLu().solve(FP)).transpose();
  if (!G.allFinite()) return false;
  const Mat<N, N> rest = Mat<N, N>::Identity() - G * F, before = dense<N>(smoothed);
  const Mat<N, N> moved = dense<N>(m.Q) + dense<N>(next);
  const Mat<N, N> sum = rest * P * rest.transpose() + G * moved * G.transpose();
  pack<N>(sum, smoothed);
  const Mat<N> std = sum.diagonal().cwiseSqrt();
  return ((sum - before).array().abs() > 1e-10 * (std * std.transpose()).array()).any();
}

template <int Count>
[[gnu::always_inline]] inline void copy(const double (&from)[Count], double (&to)[Count]) {
  each<Count>([&](auto i) __attribute__((always_inline)) { to[i()] = from[i()]; });
}

/// P, x and K given the measurement z. Returns y / S and 1 / S.
template <int N, Pattern S>
[[gnu::always_inline]] inline std::pair<double, double> read(const StepModel<N>& m,
                                                             double z,
                                                             double (&P)[Symmetric<N>::entries],
                                                             double (&x)[N],
                                                             double (&K)[N]) {
  double before[Symmetric<N>::entries];
  copy(P, before);
  const double per_S = correct_cov<N, S>(m, P, K);
  if (m.R * per_S < 1e-5) correct_wide(m, before, K, P);
  const double y = z - predicted_reading<N, S>(m, x);
  each<N>([&](auto i) __attribute__((always_inline)) { x[i()] += K[i()] * y; });
  return {y * per_S, per_S};
}

template <int N, Pattern S>
void filter(const StepModel<N>& m,
            const double* z,
            std::size_t count,
            bool moves,
            State<N>& state,
            Row<N>* rows) {
  double P[Symmetric<N>::entries], x[N];
  copy(state.P, P);
  copy(state.x, x);
  for (std::size_t k = 0; k < count; ++k) {
    if (moves || k > 0) {
      predict_mean<N, S>(m, x);
      predict_cov<N, S>(m, P);
    }
    double K[N] = {};
    std::pair<double, double> update;
    if (!std::isnan(z[k])) update = read<N, S>(m, z[k], P, x, K);
    if (rows == nullptr) continue;
    Row<N>& row = rows[k];
    copy(P, row.P);
    copy(x, row.x);
    copy(K, row.K);
    row.y_S = update.first;
    row.per_S = update.second;
  }
  copy(P, state.P);
  copy(x, state.x);
}

template <int N, Pattern S>
void smooth(const StepModel<N>& m, Row<N>* rows, std::size_t count, Later<N>& from_later) {
  Later<N> later = from_later;
  for (std::size_t k = count; k-- > 0;) {
    Row<N>& row = rows[k];
    smooth_mean<N, S>(row.P, later.l, row.x);
    double filtered[Symmetric<N>::entries];
    copy(row.P, filtered);
    smooth_cov<N, S>(later.L, row.P);
    if (later.wide || lost<N>(filtered, row.P))
      later.wide = smooth_wide(m, filtered, later.next, row.P);
    copy(row.P, later.next);
    mean_back<N, S>(m, row.K, row.y_S, later.l);
    uncorrect_Lambda<N, S>(m, row.K, row.per_S, later.L);
    unpredict_Lambda<N, S>(m, later.L);
  }
  from_later = later;
}

template <int N, Pattern S>
void smooth_means(const StepModel<N>& m, Row<N>* rows, std::size_t count, Later<N>& from_later) {
  double l[N];
  copy(from_later.l, l);
  for (std::size_t k = count; k-- > 0;) {
    smooth_mean<N, S>(rows[k].P, l, rows[k].x);
    mean_back<N, S>(m, rows[k].K, rows[k].y_S, l);
  }
  copy(l, from_later.l);
}

template <int N, std::size_t... I>
constexpr auto kernels(std::index_sequence<I...>) {
  return std::array{PlainKernels<N>{filter<N, patterns<N>[I]>, smooth<N, patterns<N>[I]>,
                                    smooth_means<N, patterns<N>[I]>}...};
}
template <int N>
constexpr auto all_kernels = kernels<N>(std::make_index_sequence<patterns<N>.size()>{});

}  // namespace

template <int N>
const PlainKernels<N>& plain_kernels(const StepModel<N>& model) {
  return all_kernels<N>[pattern_of(model)];
}

template const PlainKernels<1>& plain_kernels(const StepModel<1>&);
template const PlainKernels<2>& plain_kernels(const StepModel<2>&);
template const PlainKernels<3>& plain_kernels(const StepModel<3>&);
template const PlainKernels<4>& plain_kernels(const StepModel<4>&);

}  // namespace proofmass::estimate::packed
