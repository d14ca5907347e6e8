#include "proofmass/sensor/joint_test.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <vector>

#include "proofmass/core/chi_square.hpp"
#include "proofmass/core/linalg.hpp"
#include "proofmass/sensor/file/fields.hpp"

namespace proofmass::sensor {
namespace {

using Eigen::Index;

/// The figures that both calibrations measured, in units of the standard deviation of their change.
struct Shared {
  Eigen::VectorXd change;
  Eigen::MatrixXd old_part, new_part;
};

/// An Error gives the reason if there is nothing to test.
Result<Shared> shared_part(const Calibration& before, const Calibration& after) {
  const auto olds = nine_figures(before), news = nine_figures(after);
  std::vector<std::size_t> both;
  for (std::size_t k = 0; k < 9; ++k)
    if (*olds[k] && *news[k] && !carried_over(*olds[k], *news[k]) &&
        (*olds[k])->unit.si_symbol == (*news[k])->unit.si_symbol)
      both.push_back(k);
  if (both.empty()) return Error{Errc::not_observable, "no figure was measured twice in one unit"};
  if (!before.covariance || !after.covariance)
    return Error{Errc::not_observable,
                 fmt::format("no covariance in {}", whose(!before.covariance, !after.covariance))};
  const auto n = static_cast<Index>(both.size());
  Shared shared{Eigen::VectorXd(n), Eigen::MatrixXd(n, n), Eigen::MatrixXd(n, n)};
  const auto scale = [&](std::size_t k) {
    const double variance = (*before.covariance)[k][k] + (*after.covariance)[k][k];
    return variance > 0.0 ? std::sqrt(variance) : 1.0;
  };
  for (Index i = 0; i < n; ++i) {
    const std::size_t a = both[static_cast<std::size_t>(i)];
    shared.change(i) = ((*news[a])->si() - (*olds[a])->si()) / scale(a);
    for (Index j = 0; j < n; ++j) {
      const std::size_t b = both[static_cast<std::size_t>(j)];
      shared.old_part(i, j) = (*before.covariance)[a][b] / (scale(a) * scale(b));
      shared.new_part(i, j) = (*after.covariance)[a][b] / (scale(a) * scale(b));
    }
  }
  return shared;
}

}  // namespace

std::optional<double> dof_of(const SensorModel& model) {
  const auto& dof = model.calibration.dof;
  return dof && dof->si() > 0.0 ? std::optional(dof->si()) : std::nullopt;
}

std::optional<double> welch(double old_share,
                            std::optional<double> old_dof,
                            double new_share,
                            std::optional<double> new_dof) {
  double inverse = 0.0;
  if (old_dof) inverse += old_share * old_share / *old_dof;
  if (new_dof) inverse += new_share * new_share / *new_dof;
  const double total = old_share + new_share;
  return inverse > 0.0 ? std::optional(total * total / inverse) : std::nullopt;
}

std::string_view whose(bool old_lacks, bool new_lacks) {
  return old_lacks && new_lacks ? "OLD and NEW" : old_lacks ? "OLD" : "NEW";
}

Result<JointTest> joint_test(const SensorModel& before, const SensorModel& after) {
  const auto shared = shared_part(before.calibration, after.calibration);
  if (!shared) return shared.error();
  const SymmetricEigen S = symmetric_eigen(shared->old_part + shared->new_part);
  const Index n = S.values.size();
  if (S.values(0) < -1e-6 * std::max(S.values(n - 1), 0.0))
    return Error{Errc::not_observable, "a covariance has a negative variance in some direction"};
  JointTest test;
  double old_share = 0.0, new_share = 0.0;
  for (Index k = 0; k < n; ++k) {
    if (S.values(k) <= 1e-12 * S.values(n - 1)) continue;
    const Eigen::VectorXd v = S.vectors.col(k);
    const double along = v.dot(shared->change);
    test.statistic += along * along / S.values(k);
    old_share += v.dot(shared->old_part * v) / S.values(k);
    new_share += v.dot(shared->new_part * v) / S.values(k);
    ++test.figures;
  }
  if (test.figures == 0) return Error{Errc::not_observable, "the covariances are 0"};
  const auto p = static_cast<double>(test.figures);
  test.dof =
      welch(std::max(old_share, 0.0), dof_of(before), std::max(new_share, 0.0), dof_of(after));
  const double statistic = std::min(test.statistic, 1e6);
  test.p = test.dof ? fisher_f_p(statistic / p, p, *test.dof) : chi_square_p(statistic, p);
  return test;
}

}  // namespace proofmass::sensor
