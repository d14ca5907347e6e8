#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "proofmass/estimate/filter/linear_series.hpp"

// Textbook reference in 128 bits: the filter in Joseph form, the Rauch–Tung–Striebel smoother with
// its inverse, and generalised least squares with a flat prior. Slow and simple; with 34 digits it
// is accurate to all digits of a double.
namespace proofmass::estimate::test {

__extension__ using Quad = __float128;

/// A dense matrix of 128-bit numbers, row by row.
class QuadMatrix {
 public:
  QuadMatrix(std::size_t rows, std::size_t columns)
      : rows_(rows), columns_(columns), at_(rows * columns, Quad(0)) {}
  template <int Rows, int Columns>
  explicit QuadMatrix(const Mat<Rows, Columns>& from)
      : QuadMatrix(static_cast<std::size_t>(Rows), static_cast<std::size_t>(Columns)) {
    for (int i = 0; i < Rows; ++i)
      for (int j = 0; j < Columns; ++j)
        (*this)(static_cast<std::size_t>(i), static_cast<std::size_t>(j)) = from(i, j);
  }
  [[nodiscard]] static QuadMatrix identity(std::size_t n) {
    QuadMatrix out(n, n);
    for (std::size_t i = 0; i < n; ++i) out(i, i) = 1;
    return out;
  }
  Quad& operator()(std::size_t i, std::size_t j = 0) { return at_[i * columns_ + j]; }
  const Quad& operator()(std::size_t i, std::size_t j = 0) const { return at_[i * columns_ + j]; }
  [[nodiscard]] std::size_t rows() const { return rows_; }
  [[nodiscard]] std::size_t columns() const { return columns_; }

  [[nodiscard]] QuadMatrix transposed() const {
    QuadMatrix out(columns_, rows_);
    for (std::size_t i = 0; i < rows_; ++i)
      for (std::size_t j = 0; j < columns_; ++j) out(j, i) = (*this)(i, j);
    return out;
  }

  friend QuadMatrix operator*(const QuadMatrix& a, const QuadMatrix& b) {
    QuadMatrix out(a.rows_, b.columns_);
    for (std::size_t i = 0; i < a.rows_; ++i)
      for (std::size_t k = 0; k < a.columns_; ++k)
        for (std::size_t j = 0; j < b.columns_; ++j) out(i, j) += a(i, k) * b(k, j);
    return out;
  }
  friend QuadMatrix operator+(QuadMatrix a, const QuadMatrix& b) {
    for (std::size_t i = 0; i < a.at_.size(); ++i) a.at_[i] += b.at_[i];
    return a;
  }
  friend QuadMatrix operator-(QuadMatrix a, const QuadMatrix& b) {
    for (std::size_t i = 0; i < a.at_.size(); ++i) a.at_[i] -= b.at_[i];
    return a;
  }
  friend QuadMatrix operator*(Quad scale, QuadMatrix a) {
    for (Quad& x : a.at_) x *= scale;
    return a;
  }

  /// A⁻¹ and |A| by Gauss–Jordan with the largest pivot of each column.
  struct Inverse;
  [[nodiscard]] Inverse inverse() const;

 private:
  std::size_t rows_, columns_;
  std::vector<Quad> at_;
};

struct QuadMatrix::Inverse {
  QuadMatrix matrix;
  double log_determinant = 0.0;
};

inline QuadMatrix::Inverse QuadMatrix::inverse() const {
  QuadMatrix a = *this;
  Inverse out{identity(rows_)};
  const auto size = [](Quad x) { return x < 0 ? -x : x; };
  for (std::size_t c = 0; c < rows_; ++c) {
    std::size_t pivot = c;
    for (std::size_t i = c + 1; i < rows_; ++i)
      if (size(a(i, c)) > size(a(pivot, c))) pivot = i;
    const Quad scale = a(pivot, c);
    out.log_determinant += std::log(static_cast<double>(size(scale)));
    for (std::size_t j = 0; j < rows_; ++j) {
      std::swap(a(c, j), a(pivot, j));
      std::swap(out.matrix(c, j), out.matrix(pivot, j));
      a(c, j) /= scale;
      out.matrix(c, j) /= scale;
    }
    for (std::size_t i = 0; i < rows_; ++i) {
      const Quad factor = a(i, c);
      if (i == c || factor == 0) continue;
      for (std::size_t j = 0; j < rows_; ++j) {
        a(i, j) -= factor * a(c, j);
        out.matrix(i, j) -= factor * out.matrix(c, j);
      }
    }
  }
  return out;
}

/// One epoch in 128 bits.
struct QuadGaussian {
  QuadMatrix mean, cov;
};

struct QuadRun {
  std::vector<QuadGaussian> filtered, smoothed;
  std::vector<QuadMatrix> lag_one;  ///< [k] of x[k+1], x[k]
};

/// Filter in Joseph form, one channel at a time, and Rauch–Tung–Striebel smoother.
template <int N, int M, int U>
[[nodiscard]] QuadRun quad_smoother(const LinearSeries<N, M, U>& series,
                                    const std::vector<Epoch<M, U>>& epochs,
                                    const Gaussian<N>& prior) {
  constexpr auto n = static_cast<std::size_t>(N);
  QuadRun run;
  QuadGaussian x{QuadMatrix(prior.mean), QuadMatrix(prior.cov)};
  std::vector<QuadGaussian> predicted;
  const QuadMatrix one = QuadMatrix::identity(n);
  for (std::size_t k = 0; k < series.size(); ++k) {
    const auto& m = series.model(k);
    if (k > 0) {
      const QuadMatrix F(m.F);
      x.mean = F * x.mean;
      if constexpr (U > 0) x.mean = x.mean + QuadMatrix(m.B) * QuadMatrix(epochs[k].u);
      x.cov = F * x.cov * F.transposed() + QuadMatrix(m.Q);
    }
    predicted.push_back(x);
    for (int i = 0; i < M; ++i) {
      if (std::isnan(epochs[k].z(i))) continue;
      const Mat<N> h_double = m.H.row(i).transpose();
      const QuadMatrix h(h_double), ht = h.transposed();
      const QuadMatrix Ph = x.cov * h;
      const Quad S = (ht * Ph)(0) + Quad(m.R(i));
      const QuadMatrix K = (Quad(1) / S) * Ph;
      x.mean = x.mean + (Quad(epochs[k].z(i)) - (ht * x.mean)(0)) * K;
      const QuadMatrix rest = one - K * ht;
      x.cov = rest * x.cov * rest.transposed() + Quad(m.R(i)) * (K * K.transposed());
    }
    run.filtered.push_back(x);
  }
  run.smoothed = run.filtered;
  if (series.size() > 0) run.lag_one.assign(series.size() - 1, one);
  for (std::size_t k = series.size(); k-- > 1;) {
    const QuadMatrix F(series.model(k).F);
    const QuadGaussian& from = run.filtered[k - 1];
    const QuadMatrix G = from.cov * F.transposed() * predicted[k].cov.inverse().matrix;
    run.smoothed[k - 1] = {
        from.mean + G * (run.smoothed[k].mean - predicted[k].mean),
        from.cov + G * (run.smoothed[k].cov - predicted[k].cov) * G.transposed()};
    run.lag_one[k - 1] = run.smoothed[k].cov * G.transposed();
  }
  return run;
}

/// All states at once.
struct QuadBatch {
  QuadMatrix mean, cov;         ///< of the states stacked, epoch by epoch
  double log_likelihood = 0.0;  ///< diffuse, by the package KFAS's convention
};

/// Generalised least squares over the first `count` epochs: the information on all states from
/// measurements, steps and the start (zero mean; infinite variance of the diffuse states),
/// inverted. The likelihood is ∫ p(measurements | start) over the diffuse states, with density 1.
template <int N, int M, int U>
[[nodiscard]] QuadBatch least_squares(const LinearSeries<N, M, U>& series,
                                      const std::vector<Epoch<M, U>>& epochs,
                                      const std::vector<std::optional<double>>& start_variance,
                                      std::size_t count) {
  constexpr auto n = static_cast<std::size_t>(N);
  QuadMatrix information(n * count, n * count), vector(n * count, 1);
  Quad squares = 0;
  double logs = 0.0;
  constexpr double log_2pi = 1.8378770664093454836;
  const auto add = [&](const QuadMatrix& A, const QuadMatrix& weight, const QuadMatrix& b,
                       std::size_t at) {
    const QuadMatrix AtW = A.transposed() * weight;
    const QuadMatrix square = AtW * A, right = AtW * b;
    for (std::size_t i = 0; i < square.rows(); ++i) {
      vector(at + i) += right(i);
      for (std::size_t j = 0; j < square.rows(); ++j) information(at + i, at + j) += square(i, j);
    }
    squares += (b.transposed() * weight * b)(0);
    logs += static_cast<double>(b.rows()) * log_2pi;
  };
  const QuadMatrix one = QuadMatrix::identity(1);
  for (std::size_t i = 0; i < n; ++i) {
    if (!start_variance[i]) continue;
    QuadMatrix row(1, n);
    row(0, i) = 1;
    add(row, (Quad(1) / Quad(*start_variance[i])) * one, QuadMatrix(1, 1), 0);
    logs += std::log(*start_variance[i]);
  }
  for (std::size_t k = 0; k < count; ++k) {
    const auto& m = series.model(k);
    for (int i = 0; i < M; ++i) {
      if (std::isnan(epochs[k].z(i))) continue;
      QuadMatrix b(1, 1);
      b(0) = epochs[k].z(i);
      const Mat<1, N> h = m.H.row(i);
      add(QuadMatrix(h), (Quad(1) / Quad(m.R(i))) * one, b, n * k);
      logs += std::log(m.R(i));
    }
    if (k == 0) continue;
    QuadMatrix residual(n, 2 * n);
    for (std::size_t i = 0; i < n; ++i) {
      residual(i, n + i) = 1;
      for (std::size_t j = 0; j < n; ++j)
        residual(i, j) = -Quad(m.F(static_cast<int>(i), static_cast<int>(j)));
    }
    QuadMatrix b(n, 1);
    if constexpr (U > 0) b = QuadMatrix(m.B) * QuadMatrix(epochs[k].u);
    const auto Q = QuadMatrix(m.Q).inverse();
    add(residual, Q.matrix, b, n * (k - 1));
    logs += Q.log_determinant;
  }
  auto inverse = information.inverse();
  QuadBatch out{inverse.matrix * vector, inverse.matrix};
  squares -= (vector.transposed() * out.mean)(0);
  const double states = static_cast<double>(n * count);
  out.log_likelihood =
      -0.5 * (logs + static_cast<double>(squares) - states * log_2pi + inverse.log_determinant);
  return out;
}

}  // namespace proofmass::estimate::test
