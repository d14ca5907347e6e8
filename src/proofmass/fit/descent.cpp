#include "proofmass/fit/descent.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

namespace proofmass::fit {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using Index = Eigen::Index;

// The sum of squares as a function of the free parameters, in the units of its start.
class Landscape {
 public:
  Landscape(const Objective& objective, const std::vector<Index>& free, const VectorXd& p)
      : objective_(objective), free_(free), p_(p), unit_(VectorXd::Ones(size())) {
    VectorXd r;
    if (!objective.residuals(p, r)) return;
    if (const double length = r.stableNorm(); length > 0.0) length_ = length;
    const MatrixXd J = objective.jacobian(p);
    for (Index k = 0; k < size(); ++k) {
      const Index j = free_[static_cast<std::size_t>(k)];
      double unit = length_ / J.col(j).stableNorm();
      if (!std::isnormal(unit)) unit = std::abs(p(j));
      unit_(k) = unit > 0.0 ? unit : 1.0;
    }
  }

  [[nodiscard]] Index size() const { return static_cast<Index>(free_.size()); }
  [[nodiscard]] VectorXd start() const { return p_(free_).cwiseQuotient(unit_); }
  [[nodiscard]] VectorXd lower() const { return objective_.lower()(free_).cwiseQuotient(unit_); }
  [[nodiscard]] VectorXd upper() const { return objective_.upper()(free_).cwiseQuotient(unit_); }

  // Within the bounds even if the scaling rounds.
  [[nodiscard]] VectorXd parameters(const VectorXd& u) const {
    VectorXd p = p_;
    p(free_) = u.cwiseProduct(unit_);
    return p.cwiseMax(objective_.lower()).cwiseMin(objective_.upper());
  }

  [[nodiscard]] bool residuals(const VectorXd& u, VectorXd& r) const {
    if (!objective_.residuals(parameters(u), r)) return false;
    r /= length_;
    return true;
  }

  [[nodiscard]] MatrixXd jacobian(const VectorXd& u) const {
    const MatrixXd J = objective_.jacobian(parameters(u));
    return J(Eigen::all, free_) * (unit_ / length_).asDiagonal();
  }

 private:
  const Objective& objective_;
  const std::vector<Index>& free_;
  const VectorXd p_;
  VectorXd unit_;
  double length_ = 1.0;
};

// The linear model about a point: J = Q R, q = Qᵀ r.
struct LinearModel {
  MatrixXd R;
  VectorXd q, gradient;
  VectorXd scale;  // D, lengths of the columns of J

  // |r + J s|²/2 − |r|²/2
  [[nodiscard]] double change(const VectorXd& s) const {
    return gradient.dot(s) + 0.5 * (R * s).squaredNorm();
  }
};

LinearModel linearise(const MatrixXd& J, const VectorXd& r) {
  constexpr double shortest = 1e-10;
  const Eigen::HouseholderQR<MatrixXd> qr(J);
  const Index p = J.cols();
  LinearModel model;
  model.R = qr.matrixQR().topRows(p).triangularView<Eigen::Upper>();
  model.q = (qr.householderQ().transpose() * r).head(p);
  model.gradient = model.R.transpose() * model.q;
  model.scale = model.R.colwise().norm().transpose().cwiseMax(shortest);
  return model;
}

// The model with the columns of the parameters that may move.
LinearModel part_of(const LinearModel& model, const std::vector<Index>& moving) {
  return {model.R(Eigen::all, moving), model.q, model.gradient(moving), model.scale(moving)};
}

// The s that minimises |q + R s|² + |D s|²/Δ.
VectorXd damped_step(const LinearModel& model, double radius) {
  const Index rows = model.R.rows(), columns = model.R.cols();
  MatrixXd A = MatrixXd::Zero(rows + columns, columns);
  A.topRows(rows) = model.R;
  A.bottomRows(columns).diagonal() = model.scale / std::sqrt(radius);
  VectorXd b = VectorXd::Zero(rows + columns);
  b.head(rows) = -model.q;
  return Eigen::HouseholderQR<MatrixXd>(A).solve(b);
}

// Steepest descent in the scaled parameters as far as the model falls, then towards the
// Gauss–Newton step, as far as |D s| ≤ Δ.
VectorXd dogleg_step(const LinearModel& model, double radius) {
  constexpr double nearly_undamped = 1e16;
  const VectorXd downhill = -model.gradient.cwiseQuotient(model.scale.cwiseAbs2());
  const double curvature = (model.R * downhill).squaredNorm();
  const VectorXd cauchy = downhill * (-model.gradient.dot(downhill) / curvature);
  const VectorXd newton = damped_step(model, nearly_undamped);
  const auto length = [&](const VectorXd& s) { return model.scale.cwiseProduct(s).norm(); };
  if (length(newton) <= radius) return newton;
  if (const double far = length(cauchy); !(far < radius)) return cauchy * (radius / far);
  const VectorXd a = model.scale.cwiseProduct(cauchy),
                 b = model.scale.cwiseProduct(newton - cauchy);
  const double ab = a.dot(b), bb = b.squaredNorm();
  const double room = radius * radius - a.squaredNorm();
  const double along = room / (ab + std::sqrt(ab * ab + bb * room));  // root without cancellation
  return cauchy + along * (newton - cauchy);
}

// The radius, by the ratio of the actual to the predicted decrease.
class TrustRegion {
 public:
  explicit TrustRegion(Way way)
      : dogleg_(way == Way::dogleg),
        radius_(way == Way::levenberg_marquardt ? 1e2
                : way == Way::cautious          ? 1e-2
                                                : 1.0) {}

  [[nodiscard]] VectorXd step(const LinearModel& model) const {
    return dogleg_ ? dogleg_step(model, radius_) : damped_step(model, radius_);
  }
  [[nodiscard]] bool vanished() const { return !(radius_ > 1e-32); }

  void accept(double ratio, double step_length) {
    constexpr double largest = 1e16;
    if (dogleg_) {
      if (ratio > 0.75) radius_ = std::max(radius_, 3.0 * step_length);
      if (ratio < 0.25) radius_ *= 0.5;
    } else {
      radius_ /= std::max(1.0 / 3.0, 1.0 - std::pow(2.0 * ratio - 1.0, 3));
    }
    radius_ = std::min(radius_, largest);
    shrink_by_ = 2.0;
  }

  void reject() {
    radius_ /= shrink_by_;
    if (!dogleg_) shrink_by_ *= 2.0;
  }

 private:
  bool dogleg_;
  double radius_, shrink_by_ = 2.0;
};

// The parameters that are not pressed against a bound.
std::vector<Index> moving_at(const VectorXd& u,
                             const VectorXd& gradient,
                             const VectorXd& lower,
                             const VectorXd& upper) {
  std::vector<Index> moving;
  for (Index k = 0; k < u.size(); ++k)
    if (!(u(k) <= lower(k) && gradient(k) >= 0.0) && !(u(k) >= upper(k) && gradient(k) <= 0.0))
      moving.push_back(k);
  return moving;
}

}  // namespace

int descend(const Objective& objective, const Descent& descent, VectorXd& p) {
  constexpr double least_ratio = 1e-3, least_decrease = 1e-15, least_step = 1e-14;
  if (descent.free.empty()) return 0;
  const Landscape landscape(objective, descent.free, p);
  const VectorXd lower = landscape.lower(), upper = landscape.upper();
  VectorXd u = landscape.start(), r;
  if (!landscape.residuals(u, r)) return 0;
  MatrixXd J = landscape.jacobian(u);
  if (!J.allFinite()) return 0;
  LinearModel model = linearise(J, r);
  double cost = 0.5 * r.squaredNorm();
  TrustRegion region(descent.way);
  int iteration = 0;
  while (iteration < descent.max_iterations && !region.vanished()) {
    ++iteration;
    const std::vector<Index> moving = moving_at(u, model.gradient, lower, upper);
    if (moving.empty()) break;
    VectorXd next = u;
    next(moving) += region.step(part_of(model, moving));
    next = next.cwiseMax(lower).cwiseMin(upper);
    const VectorXd step = next - u;
    if (step.norm() <= least_step * (u.norm() + least_step)) break;
    const double predicted = -model.change(step);
    VectorXd next_r;
    if (!(predicted > 0.0) || !landscape.residuals(next, next_r)) {
      region.reject();
      continue;
    }
    const double decrease = cost - 0.5 * next_r.squaredNorm();
    const double ratio = decrease / predicted;
    if (!(ratio > least_ratio)) {
      region.reject();
      continue;
    }
    J = landscape.jacobian(next);
    if (!J.allFinite()) {
      region.reject();
      continue;
    }
    region.accept(ratio, model.scale.cwiseProduct(step).norm());
    u = next;
    r = next_r;
    cost -= decrease;
    model = linearise(J, r);
    if (decrease <= least_decrease * cost) break;
  }
  p = landscape.parameters(u);
  return iteration;
}

}  // namespace proofmass::fit
