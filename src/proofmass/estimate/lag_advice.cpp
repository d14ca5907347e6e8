#include "proofmass/estimate/lag_advice.hpp"

#include <cmath>
#include <cstdio>

#include "proofmass/core/contract.hpp"
#include "proofmass/core/linalg.hpp"

namespace proofmass::estimate {
namespace {

// 2⁶⁰ measurements exceed any recording.
constexpr std::size_t most_doublings = 60;
constexpr double nothing = 1e-6;

/// Orthonormal rows that span the observable subspace: H, H F, H F² …
Eigen::MatrixXd seen_rows(const Eigen::MatrixXd& F, const Eigen::MatrixXd& H) {
  const Eigen::Index n = F.rows();
  Eigen::MatrixXd V(n, n);
  Eigen::Index count = 0;
  const auto add = [&](Eigen::RowVectorXd row) {
    const double length = row.norm();
    for (int twice = 0; twice < 2; ++twice)
      row -= (row * V.topRows(count).transpose()) * V.topRows(count);
    if (count < n && row.norm() > 1e-11 * length) V.row(count++) = row.normalized();
  };
  for (Eigen::Index i = 0; i < H.rows(); ++i) add(H.row(i));
  for (Eigen::Index j = 0; j < count; ++j) add(V.row(j) * F);
  return V.topRows(count);
}

std::string number(double value, int digits) {
  char text[32];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return text;
}

std::string readings(std::size_t count, double dt_s) {
  return std::to_string(count) + (count == 1 ? " reading (" : " readings (") +
         number(static_cast<double>(count) * dt_s, 3) + " s)";
}

}  // namespace

// Powers of A grow in the unobservable subspace, and rounding would reintroduce it: everything is
// computed in the observable one.
LagGain::LagGain(const Parts& parts) {
  const Eigen::MatrixXd V = seen_rows(parts.F, parts.H);
  const Eigen::MatrixXd I = Eigen::MatrixXd::Identity(parts.F.rows(), parts.F.rows());
  Eigen::MatrixXd A = V * parts.F * (I - parts.gain * parts.H) * V.transpose();
  const Eigen::MatrixXd H = parts.H * V.transpose();
  Eigen::MatrixXd sum = H.transpose() * positive_inverse(parts.innovation_variance) * H;
  effect_ = parts.seen * parts.F.transpose() * V.transpose();
  for (std::size_t j = 0; j < most_doublings; ++j) {
    sums_.push_back(sum);
    powers_.push_back(A);
    const Eigen::MatrixXd more = A.transpose() * sum * A;
    if ((reduction(more).array() <= 1e-17 * reduction(sum).array()).all()) break;
    sum += more;
    A = (A * A).eval();
  }
}

Eigen::VectorXd LagGain::reduction(const Eigen::MatrixXd& sum) const {
  return (effect_ * sum * effect_.transpose()).diagonal();
}

Eigen::VectorXd LagGain::variance_reduction(std::size_t lag) const {
  const Eigen::Index n = effect_.cols();
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(n, n), power = Eigen::MatrixXd::Identity(n, n);
  for (std::size_t j = 0; j < sums_.size(); ++j) {
    if ((lag >> j & 1U) == 0) continue;
    sum += power.transpose() * sums_[j] * power;
    power = (powers_[j] * power).eval();
  }
  // A lag longer than all doublings together has converged.
  if (lag >> sums_.size() != 0) sum = sums_.back();
  return reduction(sum);
}

Eigen::VectorXd LagGain::variance_reduction() const {
  return reduction(sums_.back());
}

std::size_t LagGain::shortest(int state, double share) const {
  PM_EXPECTS(state >= 0 && state < effect_.rows() && share > 0.0 && share < 1.0);
  const double wanted = share * variance_reduction()(state);
  // The largest insufficient number of measurements, bit by bit: each further one reduces the
  // variance more.
  const Eigen::Index n = effect_.cols();
  std::size_t lag = 0;
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(n, n), power = Eigen::MatrixXd::Identity(n, n);
  for (std::size_t j = sums_.size(); j-- > 0;) {
    const Eigen::MatrixXd longer = sum + power.transpose() * sums_[j] * power;
    if (reduction(longer)(state) >= wanted) continue;
    sum = longer;
    power = (powers_[j] * power).eval();
    lag |= std::size_t{1} << j;
  }
  return lag + 1;
}

StateLagAdvice detail::state_advice(const LagGain& gain,
                                    int state,
                                    std::optional<double> filter_variance) {
  StateLagAdvice advice;
  if (!filter_variance) {
    advice.why_not = "not observable: its variance grows without limit at any lag";
    return advice;
  }
  const double reduction = gain.variance_reduction()(state);
  if (!(reduction > nothing * *filter_variance)) {
    advice.why_not = "later measurements contain no further information on it";
    return advice;
  }
  advice.lag = StateLag{*filter_variance, *filter_variance - reduction, gain.shortest(state, 0.95),
                        gain.shortest(state, 0.99)};
  return advice;
}

std::string lag_words(const StateLagAdvice& advice, const std::string& state, double dt_s) {
  if (!advice.lag) return state + ": no lag pays: " + advice.why_not;
  const StateLag& lag = *advice.lag;
  const double falls = 100.0 * (1.0 - std::sqrt(lag.interval_variance / lag.filter_variance));
  return state + ": a lag of " + readings(lag.lag_95, dt_s) + " gets 95 %, of " +
         readings(lag.lag_99, dt_s) +
         " 99 % of what all later readings give; its standard deviation then falls by " +
         number(falls, 2) + " %";
}

}  // namespace proofmass::estimate
