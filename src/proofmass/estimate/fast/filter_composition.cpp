#include "proofmass/estimate/fast/filter_composition.hpp"

#include <cmath>
#include <utility>

namespace proofmass::estimate::packed {
namespace {

/// Extended precision: the constants are computed once and used for every lane, so that their
/// rounding errors would accumulate.
using Real = long double;
template <int N>
using Square = Eigen::Matrix<Real, N, N>;
template <int N>
struct Leap {
  Square<N> A, C, J;
};

/// B ← W⁻¹ B by elimination with the largest pivot of each column.
template <int N, class Matrix>
void solve(Matrix W, Matrix& B) {
  for (int c = 0; c < N; ++c) {
    int pivot = c;
    for (int i = c + 1; i < N; ++i)
      if (std::abs(W(i, c)) > std::abs(W(pivot, c))) pivot = i;
    for (int j = 0; j < N; ++j) {
      std::swap(W(c, j), W(pivot, j));
      std::swap(B(c, j), B(pivot, j));
    }
    for (int i = 0; i < N; ++i) {
      if (i == c) continue;
      const auto factor = W(i, c) / W(c, c);
      for (int j = c; j < N; ++j) W(i, j) -= factor * W(c, j);
      for (int j = 0; j < N; ++j) B(i, j) -= factor * B(c, j);
    }
  }
  for (int i = 0; i < N; ++i) B.row(i) /= W(i, i);
}

template <int N, class Matrix>
void symmetrise(Matrix& A) {
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < i; ++j) A(i, j) = A(j, i) = (A(i, j) + A(j, i)) / 2;
}

template <int N>
Leap<N> one_step(const LinearModel<N, 1>& model) {
  using Vector = Eigen::Matrix<Real, N, 1>;
  const Square<N> F = model.F.template cast<Real>(), Q = model.Q.template cast<Real>();
  const Vector h = model.H.transpose().template cast<Real>(), Qh = Q * h, Fh = F.transpose() * h;
  const Real S = h.dot(Qh) + Real{model.R(0)};
  return {F - Qh * Fh.transpose() / S, Q - Qh * Qh.transpose() / S, Fh * Fh.transpose() / S};
}

/// The first leap, then the second.
template <int N>
Leap<N> chained(const Leap<N>& first, const Leap<N>& second) {
  const Square<N> W = Square<N>::Identity() + second.J * first.C;
  Square<N> A = second.A.transpose(), J = second.J * first.A;
  solve<N>(W, A);
  solve<N>(W, J);
  Leap<N> both{A.transpose() * first.A, A.transpose() * first.C * second.A.transpose() + second.C,
               first.A.transpose() * J + first.J};
  symmetrise<N>(both.C);
  symmetrise<N>(both.J);
  return both;
}

}  // namespace

template <int N>
ComposedFilter<N> composed_filter(const LinearModel<N, 1>& model, std::size_t count) {
  Leap<N> power = one_step(model), all = power;
  for (std::size_t left = count - 1; left > 0; left /= 2) {
    if (left % 2 == 1) all = chained(all, power);
    power = chained(power, power);
  }
  return {all.A.template cast<double>(), all.C.template cast<double>(),
          all.J.template cast<double>()};
}

template <int N>
CompositionStart<N>::CompositionStart(const ComposedFilter<N>& leap, const Mat<N, N>& before)
    : Phi(leap.A.transpose()), Lambda(leap.J) {
  const Mat<N, N> W = Mat<N, N>::Identity() + leap.J * before;  // (I + P J)ᵀ
  solve<N>(W, Phi);
  solve<N>(W, Lambda);
  Phi.transposeInPlace();
  symmetrise<N>(Lambda);
  P = Phi * before * leap.A.transpose() + leap.C;
  symmetrise<N>(P);
}

template ComposedFilter<1> composed_filter(const LinearModel<1, 1>&, std::size_t);
template ComposedFilter<2> composed_filter(const LinearModel<2, 1>&, std::size_t);
template ComposedFilter<3> composed_filter(const LinearModel<3, 1>&, std::size_t);
template ComposedFilter<4> composed_filter(const LinearModel<4, 1>&, std::size_t);
template struct CompositionStart<1>;
template struct CompositionStart<2>;
template struct CompositionStart<3>;
template struct CompositionStart<4>;

}  // namespace proofmass::estimate::packed
