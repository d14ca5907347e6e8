#include "proofmass/estimate/fast/matrix_series.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

namespace proofmass::estimate {
namespace {

using Eigen::Index;
constexpr int most = most_matrix_states;
using Dense = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, most, most>;
using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, most, 1>;
using ConstDense = Eigen::Map<const Dense>;
using ConstVector = Eigen::Map<const Vector>;

constexpr double none = std::numeric_limits<double>::quiet_NaN();

std::size_t square(int n) {
  return static_cast<std::size_t>(n) * static_cast<std::size_t>(n);
}
std::size_t product(int n, int m) {
  return static_cast<std::size_t>(n) * static_cast<std::size_t>(m);
}

ConstDense at(const MatrixSequence& sequence, std::size_t k, int rows, int columns) {
  const std::size_t which =
      sequence.which.empty() ? 0 : static_cast<std::size_t>(sequence.which[k]);
  return {sequence.values.data() + which * product(rows, columns), rows, columns};
}

Status check(const MatrixSequence& sequence,
             std::size_t size,
             std::size_t entries,
             const char* name) {
  const std::string text = name;
  if (entries == 0) return Done{};
  if (sequence.values.empty() || sequence.values.size() % entries != 0)
    return Error{Errc::invalid_argument, text + ": its size does not fit the model"};
  if (!sequence.which.empty() && sequence.which.size() != size)
    return Error{Errc::invalid_argument, text + ": expected one matrix for each epoch"};
  const auto matrices = static_cast<std::int64_t>(sequence.values.size() / entries);
  if (std::ranges::any_of(sequence.which, [&](auto k) { return k < 0 || k >= matrices; }))
    return Error{Errc::invalid_argument, text + ": a matrix index is out of range"};
  if (!std::ranges::all_of(sequence.values, [](double x) { return std::isfinite(x); }))
    return Error{Errc::not_finite, text + ": expected finite entries"};
  return Done{};
}

Status check_sizes(const MatrixSeries& s) {
  const auto fits = [](int n, int least) { return n >= least && n <= most; };
  if (!fits(s.states, 1) || !fits(s.channels, 1) || !fits(s.inputs, 0))
    return Error{Errc::invalid_argument,
                 "expected 1 to 32 states and channels, and 32 inputs at most"};
  const std::size_t n = static_cast<std::size_t>(s.states);
  if (s.prior_mean.size() != n || s.prior_cov.size() != n * n)
    return Error{Errc::invalid_argument, "the prior's size is not that of the state"};
  if (s.z.empty() || s.z.size() % static_cast<std::size_t>(s.channels) != 0)
    return Error{Errc::invalid_argument,
                 "expected at least one epoch, with a measurement or NaN for each channel"};
  if (s.u.size() != s.size() * static_cast<std::size_t>(s.inputs))
    return Error{Errc::invalid_argument, "expected an input for each epoch"};
  return Done{};
}

Status check(const MatrixSeries& s) {
  if (Status sizes = check_sizes(s); !sizes) return sizes;
  const std::size_t size = s.size();
  for (const Status& one :
       {check(s.F, size, square(s.states), "F"), check(s.Q, size, square(s.states), "Q"),
        check(s.H, size, product(s.channels, s.states), "H"),
        check(s.R, size, square(s.channels), "R"),
        check(s.B, size, product(s.states, s.inputs), "B")})
    if (!one) return one;
  const auto finite = [](double x) { return std::isfinite(x); };
  if (!std::ranges::all_of(s.prior_mean, finite) || !std::ranges::all_of(s.prior_cov, finite))
    return Error{Errc::not_finite, "the prior: expected finite entries"};
  if (!std::ranges::all_of(s.u, finite))
    return Error{Errc::not_finite, "the inputs: expected finite values"};
  if (std::ranges::any_of(s.z, [](double x) { return std::isinf(x); }))
    return Error{Errc::not_finite, "a measurement is infinite; mark a missing one as NaN"};
  return Done{};
}

/// L of S = L Lᵀ into the lower triangle. False if S is not positive definite.
bool cholesky(Dense& S) {
  for (Index j = 0; j < S.rows(); ++j) {
    double pivot = S(j, j) - S.row(j).head(j).squaredNorm();
    if (!(pivot > 0.0) || !std::isfinite(pivot)) return false;
    pivot = std::sqrt(pivot);
    S(j, j) = pivot;
    for (Index i = j + 1; i < S.rows(); ++i)
      S(i, j) = (S(i, j) - S.row(i).head(j).dot(S.row(j).head(j))) / pivot;
  }
  return true;
}

/// X ← S⁻¹ X.
template <class Matrix>
void solve(const Dense& L, Matrix& X) {
  for (Index i = 0; i < L.rows(); ++i) {
    for (Index j = 0; j < i; ++j) X.row(i) -= L(i, j) * X.row(j);
    X.row(i) /= L(i, i);
  }
  for (Index i = L.rows(); i-- > 0;) {
    for (Index j = i + 1; j < L.rows(); ++j) X.row(i) -= L(j, i) * X.row(j);
    X.row(i) /= L(i, i);
  }
}

/// The available measurements of one epoch.
struct Present {
  Dense H, R;
  Vector y;  // minus the prediction
  std::vector<Index> channels;
};

/// Data of the epochs' corrections for the backward pass; 0 in channels without a measurement.
struct Corrections {
  std::vector<double> K;            // states × channels
  std::vector<double> S_inverse_H;  // channels × states
  std::vector<double> S_inverse_y;

  void resize(std::size_t size, std::size_t states, std::size_t channels) {
    K.resize(size * states * channels);
    S_inverse_H.resize(K.size());
    S_inverse_y.resize(size * channels);
  }
};

/// Runs forwards, storing the gains if there is a backward pass.
class Pass {
 public:
  Pass(const MatrixSeries& series, const MatrixOutput& output, bool keeps)
      : series_(series), output_(output) {
    x_ = ConstVector(series.prior_mean.data(), series.states);
    P_ = ConstDense(series.prior_cov.data(), series.states, series.states);
    if (keeps) kept_.resize(series.size(), states(), channels());
  }

  [[nodiscard]] Status forward(const Progress& progress) {
    for (std::size_t k = 0; k < series_.size(); ++k) {
      if (k > 0) predict(k);
      if (!correct(k))
        return Error{
            Errc::not_positive_definite,
            "epoch " + std::to_string(k) + ": the innovation covariance is not positive definite"};
      std::copy_n(x_.data(), series_.states, output_.mean.data() + k * states());
      std::copy_n(P_.data(), square(series_.states), output_.cov.data() + k * states() * states());
      if (progress && k % 1024 == 0)
        progress("filter", static_cast<double>(k) / static_cast<double>(series_.size()));
    }
    return Done{};
  }

  /// Each state given all measurements, instead of those up to its epoch.
  void back(const Progress& progress) {
    start_back();
    for (std::size_t k = series_.size(); k-- > 0;) {
      look_back_from_state(k);
      look_back(k);
      if (progress && k % 1024 == 0)
        progress("smoother", 1.0 - static_cast<double>(k) / static_cast<double>(series_.size()));
    }
  }

  /// Each state given the measurements up to `lag` epochs later.
  void back_by(std::size_t lag, const Progress& progress) {
    const std::size_t last = series_.size() - 1;
    for (std::size_t k = 0; k <= last; ++k) {
      start_back();
      for (std::size_t j = std::min(k + std::min(lag, series_.size()), last); j > k; --j)
        look_back(j);
      look_back_from_state(k);
      if (progress && k % 64 == 0)
        progress("smoother", static_cast<double>(k) / static_cast<double>(series_.size()));
    }
  }

  [[nodiscard]] const MatrixSummary& summary() const { return summary_; }

 private:
  [[nodiscard]] std::size_t states() const { return static_cast<std::size_t>(series_.states); }
  [[nodiscard]] std::size_t channels() const { return static_cast<std::size_t>(series_.channels); }

  void predict(std::size_t k) {
    const int N = series_.states;
    const ConstDense F = at(series_.F, k, N, N);
    const Vector moved = F * x_;
    x_ = moved;
    if (series_.inputs > 0)
      x_.noalias() += at(series_.B, k, N, series_.inputs) *
                      ConstVector(series_.u.data() + k * static_cast<std::size_t>(series_.inputs),
                                  series_.inputs);
    const Dense FP = F * P_;
    P_.noalias() = FP * F.transpose();
    P_ += at(series_.Q, k, N, N);
  }

  /// Measurements of epoch k; NaN for the others in the output.
  [[nodiscard]] Present present(std::size_t k) {
    const int N = series_.states, M = series_.channels;
    const double* z = series_.z.data() + k * channels();
    Present out;
    for (Index i = 0; i < M; ++i)
      if (!std::isnan(z[i])) out.channels.push_back(i);
    std::fill_n(output_.innovation.data() + k * channels(), M, none);
    std::fill_n(output_.innovation_cov.data() + k * channels() * channels(), product(M, M), none);
    const auto m = static_cast<Index>(out.channels.size());
    const ConstDense H = at(series_.H, k, M, N), R = at(series_.R, k, M, M);
    out.H.resize(m, N);
    out.R.resize(m, m);
    out.y.resize(m);
    for (Index i = 0; i < m; ++i) {
      const Index row = out.channels[static_cast<std::size_t>(i)];
      out.H.row(i) = H.row(row);
      out.y(i) = z[row] - H.row(row).dot(x_);
      for (Index j = 0; j < m; ++j) out.R(i, j) = R(row, out.channels[static_cast<std::size_t>(j)]);
    }
    return out;
  }

  void write(std::size_t k, const Present& read, const Dense& S) {
    double* y = output_.innovation.data() + k * channels();
    double* cov = output_.innovation_cov.data() + k * channels() * channels();
    for (std::size_t i = 0; i < read.channels.size(); ++i) {
      y[read.channels[i]] = read.y(static_cast<Index>(i));
      for (std::size_t j = 0; j < read.channels.size(); ++j)
        cov[read.channels[i] * series_.channels + read.channels[j]] =
            S(static_cast<Index>(i), static_cast<Index>(j));
    }
  }

  [[nodiscard]] bool correct(std::size_t k) {
    const int N = series_.states;
    const Present read = present(k);
    if (read.channels.empty()) return true;
    Dense gain_transposed = read.H * P_;  // H P⁻
    Dense S = gain_transposed * read.H.transpose();
    S += read.R;
    write(k, read, S);
    if (!cholesky(S)) return false;
    solve(S, gain_transposed);
    const Dense K = gain_transposed.transpose();
    Vector weighted = read.y;
    solve(S, weighted);
    x_.noalias() += K * read.y;
    Dense A = Dense::Identity(N, N);
    A.noalias() -= K * read.H;
    const Dense AP = A * P_, KR = K * read.R;
    P_.noalias() = AP * A.transpose();
    P_.noalias() += KR * K.transpose();
    const Dense other = P_.transpose();
    P_ = 0.5 * (P_ + other);
    count(read, S, read.y.dot(weighted));
    if (!kept_.K.empty()) keep(k, read, S, K, weighted);
    return true;
  }

  void keep(std::size_t k,
            const Present& read,
            const Dense& L,
            const Dense& gain,
            const Vector& weighted) {
    const int N = series_.states, M = series_.channels;
    Dense weighted_H = read.H;
    solve(L, weighted_H);
    const std::size_t first = k * states() * channels();
    Eigen::Map<Dense> K(kept_.K.data() + first, N, M), SH(kept_.S_inverse_H.data() + first, M, N);
    for (std::size_t i = 0; i < read.channels.size(); ++i) {
      const auto row = static_cast<Index>(i);
      kept_.S_inverse_y[k * channels() + static_cast<std::size_t>(read.channels[i])] =
          weighted(row);
      SH.row(read.channels[i]) = weighted_H.row(row);
      K.col(read.channels[i]) = gain.col(row);
    }
  }

  void count(const Present& read, const Dense& L, double nis) {
    const std::size_t m = read.channels.size();
    summary_.readings += m;
    summary_.nis += nis;
    summary_.log_likelihood -=
        0.5 * (static_cast<double>(m) * std::log(2.0 * std::numbers::pi) + nis);
    for (Index i = 0; i < L.rows(); ++i) summary_.log_likelihood -= std::log(L(i, i));
  }

  void start_back() {
    lambda_ = Vector::Zero(series_.states);
    Lambda_ = Dense::Zero(series_.states, series_.states);
  }

  /// x̂ − P λ and P − P Λ P.
  void look_back_from_state(std::size_t k) {
    const int N = series_.states;
    Eigen::Map<Vector> x(output_.mean.data() + k * states(), N);
    Eigen::Map<Dense> P(output_.cov.data() + k * states() * states(), N, N);
    x.noalias() -= P * lambda_;
    const Dense PL = P * Lambda_;
    Dense smoothed = P;
    smoothed.noalias() -= PL * P;
    P = 0.5 * (smoothed + smoothed.transpose());
  }

  /// λ and Λ through the measurements of epoch k and the step before them.
  void look_back(std::size_t k) {
    const int N = series_.states;
    const std::size_t first = k * states() * channels();
    const ConstDense K(kept_.K.data() + first, N, series_.channels);
    const ConstDense SH(kept_.S_inverse_H.data() + first, series_.channels, N);
    const ConstVector Sy(kept_.S_inverse_y.data() + k * channels(), series_.channels);
    const ConstDense H = at(series_.H, k, series_.channels, N);
    Dense A = Dense::Identity(N, N);
    A.noalias() -= K * H;
    const Vector corrected = A.transpose() * lambda_;
    lambda_ = corrected;
    lambda_.noalias() -= H.transpose() * Sy;
    const Dense AL = A.transpose() * Lambda_;
    Lambda_.noalias() = AL * A;
    Lambda_.noalias() += H.transpose() * SH;
    if (k == 0) return;
    const ConstDense F = at(series_.F, k, N, N);
    const Vector moved = F.transpose() * lambda_;
    lambda_ = moved;
    const Dense FL = F.transpose() * Lambda_;
    Lambda_.noalias() = FL * F;
  }

  const MatrixSeries& series_;
  const MatrixOutput& output_;
  Vector x_, lambda_;
  Dense P_, Lambda_;
  Corrections kept_;
  MatrixSummary summary_;
};

Status check_output(const MatrixSeries& series, const MatrixOutput& output) {
  const std::size_t size = series.size(), n = static_cast<std::size_t>(series.states),
                    m = static_cast<std::size_t>(series.channels);
  const bool fits = output.mean.size() == size * n && output.cov.size() == size * n * n &&
                    output.innovation.size() == size * m &&
                    output.innovation_cov.size() == size * m * m;
  if (!fits) return Error{Errc::invalid_argument, "the output's size does not fit the model"};
  return Done{};
}

}  // namespace

Result<MatrixSummary> run_matrices(const MatrixSeries& series,
                                   MatrixPass pass,
                                   std::size_t lag,
                                   const MatrixOutput& output,
                                   const Progress& progress) {
  if (const Status valid = check(series); !valid) return valid.error();
  if (const Status fits = check_output(series, output); !fits) return fits.error();
  Pass run(series, output, pass != MatrixPass::filter);
  if (const Status done = run.forward(progress); !done) return done.error();
  if (pass == MatrixPass::smooth) run.back(progress);
  if (pass == MatrixPass::fixed_lag) run.back_by(lag, progress);
  return run.summary();
}

}  // namespace proofmass::estimate
