#include "proofmass/calibrate/gyroscope/fit.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "proofmass/core/chi_square.hpp"
#include "proofmass/core/linalg.hpp"
#include "proofmass/sensor/datasheet.hpp"

namespace proofmass::calibrate {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double undetermined_std = 0.05;  // relative, or rad
constexpr double suspect_p = 0.01;         // after Bonferroni's correction
constexpr double largest_F = 1e12;         // beyond which there is no probability left
constexpr int most_iterations = 40;
constexpr double smallest_step = 1e-10;  // relative

double size_of(const Matrix3d& A) {
  return A.norm() / std::sqrt(3.0);
}

// Two unit vectors that span the plane perpendicular to u.
Eigen::Matrix<double, 2, 3> tangents(const Vector3d& u) {
  Index least = 0;
  u.cwiseAbs().minCoeff(&least);
  const Vector3d first = u.cross(Vector3d::Unit(least)).normalized();
  Eigen::Matrix<double, 2, 3> out;
  out << first.transpose(), u.cross(first).transpose();
  return out;
}

// The rotation vector, perpendicular to both, from a to b.
Vector3d turn_between(const Vector3d& a, const Vector3d& b) {
  const Vector3d axis = a.cross(b);
  const double sine = axis.norm();
  return sine > 1e-12 ? Vector3d(std::atan2(sine, a.dot(b)) / sine * axis) : axis;
}

// Residuals, derivatives and covariance at one A.
class Equations {
 public:
  Equations(const GyroscopeData& data, const RestRegression& rests, const Matrix3d& A)
      : data_(data), rests_(rests), A_(A) {}

  MatrixEquations assemble(const std::vector<bool>& used) {
    const auto motions = static_cast<Index>(std::ranges::count(used, true));
    const Index rows = 2 * motions + static_cast<Index>(data_.rates.size());
    out_.size = size_of(A_);
    out_.residual = VectorXd::Zero(rows);
    out_.by_matrix = MatrixXd::Zero(rows, 9);
    out_.by_offset = MatrixXd::Zero(rows, 12);
    out_.by_accel = MatrixXd::Zero(rows, 9);
    out_.covariance = MatrixXd::Zero(rows, rows);
    by_rest_ = MatrixXd::Zero(rows, 6 * static_cast<Index>(data_.rests.size()));
    Index row = 0;
    for (std::size_t k = 0; k < data_.motions.size(); ++k) {
      if (!used[k]) continue;
      add(data_.motions[k], row);
      row += 2;
    }
    for (const GyroscopeRate& rate : data_.rates) add(rate, row++);
    add_rest_noise();
    if (!rests_.why_no_g.empty()) add_unknown_g();
    return std::move(out_);
  }

 private:
  void add(const GyroscopeMotion& motion, Index row);
  void add(const GyroscopeRate& rate, Index row);
  void add_rest_noise();
  void add_unknown_g();

  const GyroscopeData& data_;
  const RestRegression& rests_;
  Matrix3d A_;
  MatrixEquations out_;
  // Derivatives by the independent errors of each rest: the tilt of the accelerometer's mean, then
  // the gyroscope's mean. Rows × 6 rests.
  MatrixXd by_rest_;
};

// u₁ is gravity at the end as measured, R ᵀ u₀ as predicted; the residual is the rotation vector
// from the predicted to the measured. A rotation of the end frame by δ adds δ to it, a rotation of
// u₁ by ε adds ε, one of u₀ subtracts Rᵀ ε: all perpendicular to u₁.
void Equations::add(const GyroscopeMotion& motion, Index row) {
  const GyroscopeRest &before = data_.rests[motion.from], &after = data_.rests[motion.to];
  const MotionRotation turn = integrate(motion.samples, A_, rests_.G, motion.noise_axes);
  const Eigen::Matrix<double, 2, 3> t = tangents(after.up);
  const Matrix3d back = turn.R.transpose();
  out_.residual.segment<2>(row) = t * turn_between(back * before.up, after.up);
  out_.by_matrix.middleRows<2>(row) = out_.size * t * turn.by_matrix;
  out_.by_offset.block<2, 9>(row, 3) = t * turn.by_g;
  out_.by_accel.middleRows<2>(row) = t * (after.tilt_by_accel - back * before.tilt_by_accel);
  // Earth's rotation during the motion is not the mean of that in the two rests.
  const double duration_s = motion.samples.duration_s();
  const double earth = earth_rate_radps * duration_s / std::sqrt(3.0);
  const Matrix3d noise = turn.noise + earth * earth * Matrix3d::Identity();
  out_.covariance.block<2, 2>(row, row) += t * noise * t.transpose();
  const auto from = 6 * static_cast<Index>(motion.from), to = 6 * static_cast<Index>(motion.to);
  by_rest_.block<2, 3>(row, from) -= t * back;
  by_rest_.block<2, 3>(row, to) += t;
  const Eigen::Matrix<double, 2, 3> by_mean = -0.5 * t * turn.by_rate * A_;
  by_rest_.block<2, 3>(row, from + 3) += by_mean;
  by_rest_.block<2, 3>(row, to + 3) += by_mean;
  out_.turned_rad.push_back(turn.turned_rad);
}

// |A (mean − bias − G f)| is the table's rate.
void Equations::add(const GyroscopeRate& rate, Index row) {
  const Vector3d y = rate.mean - rests_.bias - rests_.G * rate.force;
  const Vector3d omega = A_ * y, along = omega.normalized();
  const Eigen::RowVector3d by_reading = along.transpose() * A_;
  out_.residual(row) = omega.norm() - rate.rate_radps;
  for (Index i = 0; i < 3; ++i) {
    out_.by_matrix.block<1, 3>(row, 3 * i) = out_.size * along(i) * y.transpose();
    out_.by_offset(row, i) = -by_reading(i);
    out_.by_offset.block<1, 3>(row, 3 + 3 * i) = -by_reading(i) * rate.force.transpose();
  }
  // Earth's rotation adds its component along the table's axis, which is not known.
  out_.covariance(row, row) += rate.std_radps * rate.std_radps +
                               earth_rate_radps * earth_rate_radps / 3.0 +
                               by_reading.cwiseAbs2().dot(rate.variance);
}

void Equations::add_rest_noise() {
  for (std::size_t k = 0; k < data_.rests.size(); ++k) {
    const GyroscopeRest& rest = data_.rests[k];
    const auto column = 6 * static_cast<Index>(k);
    const auto tilt = by_rest_.middleCols<3>(column), mean = by_rest_.middleCols<3>(column + 3);
    out_.covariance += tilt * rest.tilt_covariance * tilt.transpose() +
                       mean * rest.variance.asDiagonal() * mean.transpose();
  }
  // A sensor without visible noise: rounding of the arithmetic.
  constexpr double least_rad = 1e-9;
  out_.covariance.diagonal().array() += least_rad * least_rad;
}

// A g-sensitivity that the rests do not determine acts on every motion alike.
void Equations::add_unknown_g() {
  const double std = sensor::mpu6050.g_sensitivity_radps_per_mps2 / out_.size;
  const auto by_g = out_.by_offset.rightCols<9>();
  out_.covariance += std * std * (by_g * by_g.transpose());
}

// N = Jᵀ W J divided into what is determined and what is not.
struct Solution {
  Matrix9 cofactor, undetermined;
};

Solution solve_normal(const Matrix9& N, double factor) {
  const SymmetricEigen parts = symmetric_eigen(N);
  Solution out{Matrix9::Zero(), Matrix9::Zero()};
  for (Index k = 0; k < 9; ++k) {
    const Eigen::Matrix<double, 9, 1> v = parts.vectors.col(k);
    const double variance = factor / std::max(parts.values(k), 1e-300);
    if (variance < undetermined_std * undetermined_std)
      out.cofactor += v * v.transpose() / parts.values(k);
    else
      out.undetermined += v * v.transpose();
  }
  return out;
}

Matrix3d stepped(const Matrix3d& A, double size, const Eigen::Matrix<double, 9, 1>& step) {
  Matrix3d out = A;
  for (Index i = 0; i < 3; ++i) out.row(i) += size * step.segment<3>(3 * i).transpose();
  return out;
}

// Determined parameters at the minimum of rᵀ W r; the steps are halved while the sum increases.
MatrixFit minimise(const GyroscopeData& data,
                   const RestRegression& rests,
                   const Matrix3d& start,
                   const std::vector<bool>& used) {
  MatrixFit fit;
  fit.A = start;
  fit.used = used;
  fit.equations = Equations(data, rests, fit.A).assemble(used);
  for (; fit.iterations < most_iterations && !fit.converged; ++fit.iterations) {
    const MatrixEquations& now = fit.equations;
    const MatrixXd W = positive_inverse(now.covariance);
    const Matrix9 N = now.by_matrix.transpose() * W * now.by_matrix;
    const Eigen::Matrix<double, 9, 1> step =
        -solve_normal(N, 1.0).cofactor * (now.by_matrix.transpose() * (W * now.residual));
    const double before = now.residual.dot(W * now.residual);
    double part = 1.0;
    for (int halving = 0; halving < 8; ++halving, part *= 0.5) {
      MatrixEquations next =
          Equations(data, rests, stepped(fit.A, now.size, part * step)).assemble(used);
      const double after = next.residual.dot(W * next.residual);
      if (after > before * (1.0 + 1e-9) && halving < 7) continue;
      fit.A = stepped(fit.A, now.size, part * step);
      fit.converged =
          part * step.norm() < smallest_step || std::abs(before - after) < 1e-9 * before;
      fit.equations = std::move(next);
      break;
    }
  }
  return fit;
}

// Scatter, what is determined, deletion residuals.
void judge(const GyroscopeData& data, MatrixFit& fit) {
  const MatrixEquations& now = fit.equations;
  fit.weights = positive_inverse(now.covariance);
  const Matrix9 N = now.by_matrix.transpose() * fit.weights * now.by_matrix;
  const double rss = now.residual.dot(fit.weights * now.residual);
  Solution solution = solve_normal(N, 1.0);
  const auto rows = static_cast<double>(now.residual.size());
  const double dof = rows - (9.0 - solution.undetermined.trace());
  fit.scatter = scatter_of(rss, std::max(std::round(dof), 0.0), data.noise_dof);
  solution = solve_normal(N, std::max(fit.scatter.factor, 1e-12));
  fit.cofactor = solution.cofactor;
  fit.undetermined = solution.undetermined;
  const MatrixXd gain = fit.weights * now.by_matrix;
  const MatrixXd P = fit.weights - gain * fit.cofactor * gain.transpose();
  const VectorXd pulled = P * now.residual;
  const auto motions = static_cast<Index>(now.turned_rad.size());
  for (Index k = 0; k < motions; ++k) {
    const Eigen::Matrix2d block = P.block<2, 2>(2 * k, 2 * k);
    const Eigen::Vector2d own = pulled.segment<2>(2 * k);
    // Without the motion nothing is left that checks it.
    const double redundancy = (block * now.covariance.block<2, 2>(2 * k, 2 * k)).trace();
    if (redundancy < 1e-3) {
      fit.leave_one_out_rad.emplace_back();
      fit.studentised.emplace_back();
      continue;
    }
    const Eigen::Vector2d deleted = solve(block, own);
    fit.leave_one_out_rad.emplace_back(deleted.norm());
    fit.studentised.emplace_back(std::sqrt(0.5 * own.dot(deleted)));
  }
}

// The motion whose exclusion lowers the sum of squares significantly.
std::optional<std::size_t> contradicting(const MatrixFit& fit, double noise_dof) {
  const MatrixEquations& now = fit.equations;
  const double rss = now.residual.dot(fit.weights * now.residual);
  const double dof =
      static_cast<double>(now.residual.size()) - (9.0 - fit.undetermined.trace()) - 2.0;
  const auto count = static_cast<double>(now.turned_rad.size());
  std::optional<std::size_t> worst;
  double least = suspect_p;
  std::size_t at = 0;
  for (std::size_t k = 0; k < fit.used.size(); ++k) {
    if (!fit.used[k]) continue;
    const std::optional<double>& t = fit.studentised[at++];
    if (!t || dof < 2.0) continue;
    const double gain = 2.0 * *t * *t;
    const Scatter rest = scatter_of(std::max(rss - gain, 0.0), dof, noise_dof);
    const double F = std::min(0.5 * gain / std::max(rest.factor, 1e-300), largest_F);
    const double p = count * fisher_f_p(F, 2.0, rest.dof);
    if (p >= least) continue;
    least = p;
    worst = k;
  }
  return worst;
}

}  // namespace

MatrixFit fit_matrix(const GyroscopeData& data,
                     const RestRegression& rests,
                     const Matrix3d& start) {
  std::vector<bool> used(data.motions.size(), true);
  const std::size_t most_excluded = data.motions.size() / 4;
  MatrixFit fit = minimise(data, rests, start, used);
  judge(data, fit);
  for (std::size_t excluded = 0; excluded < most_excluded; ++excluded) {
    const std::optional<std::size_t> worst = contradicting(fit, data.noise_dof);
    if (!worst) break;
    used[*worst] = false;
    fit = minimise(data, rests, fit.A, used);
    judge(data, fit);
  }
  return fit;
}

}  // namespace proofmass::calibrate
