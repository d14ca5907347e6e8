#include "proofmass/estimate/fast/steady_state.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "proofmass/core/linalg.hpp"

namespace proofmass::estimate::detail {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int most_doublings = 60;

struct Dense {
  MatrixXd F, Q, H, R;
};

/// Typical change of each state in a few steps, 1 if it is not driven: in these units the entries
/// of a model with any step length are near 1.
VectorXd natural_units(const Dense& m) {
  VectorXd moved = VectorXd::Zero(m.F.rows());
  MatrixXd power = MatrixXd::Identity(m.F.rows(), m.F.rows());
  for (Eigen::Index j = 0; j < m.F.rows(); ++j, power *= m.F)
    moved += (power * m.Q * power.transpose()).diagonal();
  return moved.unaryExpr([](double q) { return q > 0.0 ? std::sqrt(q) : 1.0; });
}

/// w minus its components along the columns of `basis`, to full precision.
VectorXd without(const MatrixXd& basis, Eigen::Index columns, VectorXd w) {
  for (int twice = 0; twice < 2; ++twice)
    w -= basis.leftCols(columns) * (basis.leftCols(columns).transpose() * w);
  return w;
}

/// An orthonormal basis, first of the observable subspace, then of its complement.
struct Staircase {
  MatrixXd basis;
  Eigen::Index seen = 0;
};

Staircase staircase(const Dense& m) {
  const Eigen::Index n = m.F.rows();
  Staircase out{MatrixXd::Zero(n, n), 0};
  const auto add = [&](const VectorXd& candidate) {
    const double length = candidate.norm();
    const VectorXd w = without(out.basis, out.seen, candidate);
    if (out.seen < n && w.norm() > 1e-11 * length) out.basis.col(out.seen++) = w.normalized();
  };
  for (Eigen::Index i = 0; i < m.H.rows(); ++i) add(m.H.row(i).transpose());
  for (Eigen::Index j = 0; j < out.seen; ++j) add(m.F.transpose() * out.basis.col(j));
  // Entirely unobservable axes stay exactly as they are.
  for (Eigen::Index have = out.seen; have < n; ++have) {
    VectorXd best = VectorXd::Zero(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const VectorXd w = without(out.basis, have, VectorXd::Unit(n, i));
      if (w.norm() > best.norm()) best = w;
    }
    out.basis.col(have) = best.normalized();
  }
  return out;
}

MatrixXd symmetrised(const MatrixXd& A) {
  return 0.5 * (A + A.transpose());
}

/// Whether no entry of A changed by more than rounding, relative to its row's and column's
/// diagonal.
bool settled(const MatrixXd& A, const MatrixXd& before) {
  for (Eigen::Index i = 0; i < A.rows(); ++i)
    for (Eigen::Index j = 0; j < A.cols(); ++j)
      if (std::abs(A(i, j) - before(i, j)) > 1e-15 * std::sqrt(A(i, i) * A(j, j))) return false;
  return true;
}

/// X = Σ Bⁱ C Dⁱ, the solution of X = B X D + C, by doubled sums; nullopt if there is none.
std::optional<MatrixXd> doubled_sum(MatrixXd B, const MatrixXd& C, MatrixXd D) {
  MatrixXd X = C;
  for (int j = 0; j < most_doublings; ++j) {
    const MatrixXd more = B * X * D;
    X += more;
    if (!X.allFinite()) return std::nullopt;
    if ((more.array().abs() <= 1e-17 * X.array().abs()).all()) return X;
    B = (B * B).eval();
    D = (D * D).eval();
  }
  return std::nullopt;
}

/// −1 / ln of the largest modulus of A's eigenvalues; infinite if it is not below 1.
double slowest_steps(MatrixXd A) {
  double log_norm = 0.0;  // of A's power before it was scaled, over the power
  double power = 1.0;
  for (int j = 0; j < 40; ++j, power *= 2.0) {
    const double norm = A.norm();
    if (norm < 1e-300) return 0.0;
    log_norm += std::log(norm) / power;
    A /= norm;
    A = (A * A).eval();
  }
  return log_norm < -1e-12 ? -1.0 / log_norm : std::numeric_limits<double>::infinity();
}

/// Riccati limit P⁻ of an observable pair, by doubling.
MatrixXd riccati_limit(const Dense& m) {
  const Eigen::Index n = m.F.rows();
  const MatrixXd I = MatrixXd::Identity(n, n);
  MatrixXd A = m.F.transpose(), P = m.Q;
  MatrixXd G = m.H.transpose() * m.R.diagonal().cwiseInverse().asDiagonal() * m.H;
  for (int j = 0; j < most_doublings; ++j) {
    MatrixXd both(n, 2 * n);
    both << A, G;
    both = solve(I + G * P, both);
    const MatrixXd WA = both.leftCols(n), WG = both.rightCols(n), before = P;
    P = symmetrised(P + A.transpose() * P * WA);
    G = symmetrised(G + A * WG * A.transpose());
    A = (A * WA).eval();
    if (settled(P, before)) break;
  }
  return P;
}

/// The blocks of a model in the staircase's basis: d observable, u not.
struct Split {
  Dense d;
  MatrixXd F_ud, F_uu, Q_ud, Q_uu;
};

Split split(const Dense& m, const Staircase& stairs) {
  const Eigen::Index n = m.F.rows(), d = stairs.seen, u = n - d;
  const MatrixXd F = stairs.basis.transpose() * m.F * stairs.basis;
  const MatrixXd Q = stairs.basis.transpose() * m.Q * stairs.basis;
  return {{F.topLeftCorner(d, d), Q.topLeftCorner(d, d), m.H * stairs.basis.leftCols(d), m.R},
          F.bottomLeftCorner(u, d),
          F.bottomRightCorner(u, u),
          Q.bottomLeftCorner(u, d),
          Q.bottomRightCorner(u, u)};
}

/// Variance of the unobservable part, driven by C each step, and the remainder of its initial value
/// after so many steps that any decaying component has vanished: both for the same number of steps.
struct Unseen {
  MatrixXd P, left;
};

Unseen sum_unseen(const MatrixXd& F_uu, const MatrixXd& C) {
  Unseen sum{C, F_uu};
  for (int j = 0; j < 36 && (j == 0 || sum.left.norm() < 1e60); ++j) {
    sum.P = symmetrised(sum.P + sum.left * sum.P * sum.left.transpose());
    sum.left = (sum.left * sum.left).eval();
  }
  return sum;
}

Error no_limit(const char* why) {
  return {Errc::not_observable, std::string("the filter's gains have no limit: ") + why};
}

Status check(const Dense& m) {
  if (!m.F.allFinite() || !m.Q.allFinite() || !m.H.allFinite() || !m.R.allFinite())
    return Error{Errc::not_finite, "the model holds what is not a number"};
  if (!(m.R.diagonal().array() > 0.0).all())
    return Error{Errc::not_positive_definite, "a channel's variance in R is not positive"};
  return Done{};
}

/// Entries of states without a limit, set to 0.
MatrixXd kept(const MatrixXd& P, const SteadyParts& parts) {
  MatrixXd out = P;
  for (Eigen::Index i = 0; i < P.rows(); ++i)
    for (Eigen::Index j = 0; j < P.cols(); ++j)
      if (!parts.has_limit(i) || !parts.has_limit(j)) out(i, j) = 0.0;
  return out;
}

}  // namespace

Result<SteadyParts> steady_parts(const MatrixXd& F,
                                 const MatrixXd& Q,
                                 const MatrixXd& H,
                                 const VectorXd& R) {
  Dense m{F, Q, H, R.asDiagonal()};
  if (const Status fine = check(m); !fine) return fine.error();
  const VectorXd units = natural_units(m), per_unit = units.cwiseInverse();
  const auto D = units.asDiagonal(), D_inverse = per_unit.asDiagonal();
  m.F = D_inverse * F * D;
  m.Q = D_inverse * Q * D_inverse;
  m.H = H * D;
  const Staircase stairs = staircase(m);
  const Split s = split(m, stairs);
  const Eigen::Index n = F.rows(), d = stairs.seen, u = n - d;

  const MatrixXd P_dd = riccati_limit(s.d);
  SteadyParts parts;
  const MatrixXd S = s.d.H * P_dd * s.d.H.transpose() + m.R,
                 S_inverse = solve(S, MatrixXd::Identity(S.rows(), S.rows()));
  MatrixXd K(n, H.rows());
  K.topRows(d) = P_dd * s.d.H.transpose() * S_inverse;
  const MatrixXd keep = MatrixXd::Identity(d, d) - K.topRows(d) * s.d.H;
  const MatrixXd closed = s.d.F * keep;
  parts.slowest_steps = slowest_steps(closed);
  if (!std::isfinite(parts.slowest_steps))
    return no_limit(
        "a measured quantity is constant without process noise, so its variance tends to 0");
  const auto P_ud =
      doubled_sum(s.F_uu, s.F_ud * P_dd * closed.transpose() + s.Q_ud, closed.transpose());
  if (!P_ud)
    return no_limit("an unobservable quantity grows faster than the filter's errors decay");
  K.bottomRows(u) = *P_ud * s.d.H.transpose() * S_inverse;

  const MatrixXd FK_u = s.F_ud * K.topRows(d) + s.F_uu * K.bottomRows(u);
  const MatrixXd crossed = s.F_uu * *P_ud * s.F_ud.transpose();
  const Unseen unseen =
      sum_unseen(s.F_uu, symmetrised(s.F_ud * P_dd * s.F_ud.transpose() + crossed +
                                     crossed.transpose() - FK_u * S * FK_u.transpose() + s.Q_uu));
  MatrixXd P(n, n);
  P << P_dd, P_ud->transpose(), *P_ud, unseen.P;
  const MatrixXd filtered = P - K * S * K.transpose();
  const MatrixXd W = s.d.H * s.d.F;
  const auto L =
      doubled_sum((keep * s.d.F).transpose(), W.transpose() * S_inverse * W, keep * s.d.F);
  if (!L) return no_limit("the information of later measurements does not converge");

  const MatrixXd T = D * stairs.basis, O = stairs.basis.leftCols(d);
  const MatrixXd left = stairs.basis.rightCols(u) * unseen.left;
  parts.has_limit = left.rowwise().norm().array() < 1e-6;
  parts.gain = T * K;
  parts.innovation_variance = symmetrised(S);
  parts.predicted = kept(T * P * T.transpose(), parts);
  parts.filtered = kept(T * filtered * T.transpose(), parts);
  const MatrixXd seen = stairs.basis * filtered.leftCols(d);
  parts.seen = D * seen * O.transpose() * D;
  parts.smoothed = parts.filtered - kept(D * seen * *L * seen.transpose() * D, parts);
  parts.Lambda = D_inverse * O * *L * O.transpose() * D_inverse;
  return parts;
}

}  // namespace proofmass::estimate::detail
