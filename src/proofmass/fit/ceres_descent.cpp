#include "proofmass/fit/ceres_descent.hpp"

#include <ceres/cost_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>
#include <cmath>

namespace proofmass::fit {
namespace {

using Index = Eigen::Index;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// The residuals relative to their length at the start, as a function of the free parameters in
// units in which each column of the Jacobian there has that length.
struct Scaling {
  double residual = 1.0;
  Eigen::VectorXd parameter;
};

Scaling scaling_at(const Objective& objective,
                   const Eigen::VectorXd& p,
                   const std::vector<Index>& free) {
  Eigen::VectorXd r;
  Scaling scaling{1.0, Eigen::VectorXd::Ones(static_cast<Index>(free.size()))};
  if (!objective.residuals(p, r)) return scaling;
  if (const double length = r.stableNorm(); length > 0.0) scaling.residual = length;
  const Eigen::MatrixXd J = objective.jacobian(p);
  for (std::size_t k = 0; k < free.size(); ++k) {
    const double slope = J.col(free[k]).stableNorm();
    double unit = scaling.residual / slope;
    if (!std::isnormal(unit)) unit = std::abs(p(free[k]));
    scaling.parameter(static_cast<Index>(k)) = unit > 0.0 ? unit : 1.0;
  }
  return scaling;
}

class ScaledCost final : public ceres::CostFunction {
 public:
  ScaledCost(const Objective& objective,
             const Descent& descent,
             const Eigen::VectorXd& p,
             const Scaling& scaling)
      : objective_(objective), descent_(descent), p_(p), scaling_(scaling) {
    set_num_residuals(static_cast<int>(objective.residual_count()));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(descent.free.size()));
  }

  bool Evaluate(double const* const* scaled, double* residuals, double** jacobians) const override {
    const Eigen::VectorXd p = unscaled(scaled[0]);
    Eigen::VectorXd r;
    if (!objective_.residuals(p, r)) return false;
    Eigen::VectorXd::Map(residuals, r.size()) = r / scaling_.residual;
    if (jacobians == nullptr || jacobians[0] == nullptr) return true;
    const Eigen::MatrixXd J = objective_.jacobian(p);
    Eigen::Map<RowMajor> out(jacobians[0], r.size(), scaling_.parameter.size());
    for (Index k = 0; k < out.cols(); ++k)
      out.col(k) = J.col(descent_.free[static_cast<std::size_t>(k)]) *
                   (scaling_.parameter(k) / scaling_.residual);
    return out.allFinite();
  }

  // Within the bounds even if the scaling rounds.
  [[nodiscard]] Eigen::VectorXd unscaled(const double* scaled) const {
    Eigen::VectorXd p = p_;
    for (std::size_t k = 0; k < descent_.free.size(); ++k) {
      const Index j = descent_.free[k];
      p(j) = std::min(
          std::max(scaled[k] * scaling_.parameter(static_cast<Index>(k)), objective_.lower()(j)),
          objective_.upper()(j));
    }
    return p;
  }

 private:
  const Objective& objective_;
  const Descent& descent_;
  const Eigen::VectorXd& p_;
  const Scaling& scaling_;
};

ceres::Solver::Options solver_options(const Descent& descent) {
  ceres::Solver::Options options;
  options.logging_type = ceres::SILENT;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = descent.max_iterations;
  options.max_num_consecutive_invalid_steps = 100;
  options.function_tolerance = 1e-15;
  options.parameter_tolerance = 1e-14;
  options.gradient_tolerance = 1e-300;
  options.min_lm_diagonal = 1e-20;
  switch (descent.way) {
    case Way::levenberg_marquardt:
      options.initial_trust_region_radius = 1e2;
      break;
    case Way::cautious:
      options.initial_trust_region_radius = 1e-2;
      break;
    case Way::dogleg:
      options.trust_region_strategy_type = ceres::DOGLEG;
      options.initial_trust_region_radius = 1.0;
      break;
    case Way::subspace_dogleg:
      options.trust_region_strategy_type = ceres::DOGLEG;
      options.dogleg_type = ceres::SUBSPACE_DOGLEG;
      break;
    case Way::over_hills:
      options.use_nonmonotonic_steps = true;
      break;
  }
  return options;
}

}  // namespace

int descend(const Objective& objective, const Descent& descent, Eigen::VectorXd& p) {
  if (descent.free.empty()) return 0;
  const Scaling scaling = scaling_at(objective, p, descent.free);
  const Eigen::VectorXd begin = p;
  ScaledCost cost(objective, descent, begin, scaling);
  Eigen::VectorXd scaled(scaling.parameter.size());

  ceres::Problem::Options ownership;
  ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(ownership);
  for (Index k = 0; k < scaled.size(); ++k)
    scaled(k) = begin(descent.free[static_cast<std::size_t>(k)]) / scaling.parameter(k);
  problem.AddResidualBlock(&cost, nullptr, scaled.data());
  for (Index k = 0; k < scaled.size(); ++k) {
    const Index j = descent.free[static_cast<std::size_t>(k)];
    const double lower = objective.lower()(j) / scaling.parameter(k);
    const double upper = objective.upper()(j) / scaling.parameter(k);
    if (std::isfinite(lower))
      problem.SetParameterLowerBound(scaled.data(), static_cast<int>(k), lower);
    if (std::isfinite(upper))
      problem.SetParameterUpperBound(scaled.data(), static_cast<int>(k), upper);
  }
  ceres::Solver::Summary summary;
  ceres::Solve(solver_options(descent), &problem, &summary);
  if (summary.IsSolutionUsable() && scaled.allFinite()) p = cost.unscaled(scaled.data());
  return static_cast<int>(summary.iterations.size());
}

}  // namespace proofmass::fit
