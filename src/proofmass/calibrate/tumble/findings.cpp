#include "proofmass/calibrate/tumble/findings.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <tuple>

#include "proofmass/calibrate/tumble/components.hpp"
#include "proofmass/core/chi_square.hpp"
#include "proofmass/core/linalg.hpp"
#include "proofmass/core/number_words.hpp"

namespace proofmass::calibrate {
namespace {

constexpr double chance = 0.01;
constexpr double rounding = 1e-12;  // relative to the outputs' magnitude: smaller residuals are
                                    // rounding

// p-value of a single studentised residual.
double residual_p(double t, double dof) {
  if (dof > 0.0) return student_t_p(t, dof);
  return chi_square_p(t * t, 1.0);
}

// Externally studentised residual; nullopt without sufficient degrees of freedom.
std::optional<double> studentised(double z, double dof, bool external) {
  if (!external) return z;
  if (dof < 2.0) return std::nullopt;
  const double left = std::max(dof - z * z, 1e-12 * dof);
  return z * std::sqrt((dof - 1.0) / left);
}

// Numbers the positions: equal if all variables of the model are equal.
std::vector<std::size_t> visits(View<TumblePosition> positions, std::size_t& count) {
  constexpr double same_rad = 1e-5;
  std::vector<std::size_t> number;
  count = 0;
  const auto same = [&](const TumblePosition& a, const TumblePosition& b) {
    const double turn = 2.0 * std::acos(-1.0);
    return std::abs(std::remainder(a.angle_rad - b.angle_rad, turn)) < same_rad &&
           std::abs(std::remainder(a.mount_rad - b.mount_rad, turn)) < same_rad &&
           a.plane == b.plane && a.direction == b.direction;
  };
  for (std::size_t k = 0; k < positions.size(); ++k) {
    std::size_t j = 0;
    while (j < k && !same(positions[j], positions[k])) ++j;
    number.push_back(j < k ? number[j] : count++);
  }
  return number;
}

struct Within {
  double rss = 0.0, dof = 0.0;
};

// Residual sum of squares about the mean of each visited position, with the drift fitted if the
// model has it.
Within within_visits(View<TumblePosition> positions,
                     const Eigen::VectorXd& outputs,
                     const Eigen::VectorXd* drift) {
  std::size_t count = 0;
  const std::vector<std::size_t> number = visits(positions, count);
  const auto centred = [&](const Eigen::VectorXd& values) {
    std::vector<double> sum(count, 0.0), visited(count, 0.0);
    for (std::size_t k = 0; k < number.size(); ++k) {
      sum[number[k]] += values(static_cast<Eigen::Index>(k));
      visited[number[k]] += 1.0;
    }
    Eigen::VectorXd out = values;
    for (std::size_t k = 0; k < number.size(); ++k)
      out(static_cast<Eigen::Index>(k)) -= sum[number[k]] / visited[number[k]];
    return out;
  };
  Eigen::VectorXd y = centred(outputs);
  Within out{.dof = static_cast<double>(positions.size() - count)};
  if (drift != nullptr) {
    const Eigen::VectorXd d = centred(*drift);
    constexpr double least = 1e-9;
    if (d.squaredNorm() > least) {
      y -= d * (d.dot(y) / d.squaredNorm());
      out.dof -= 1.0;
    }
  }
  out.rss = y.squaredNorm();
  return out;
}

// Errors of the positions `kept`.
TumbleErrors without(const TumbleErrors& errors, const std::vector<Eigen::Index>& kept) {
  TumbleErrors out = errors;
  out.noise_std = errors.noise_std(kept);
  out.lever = errors.lever(kept);
  if (errors.drift.cols() > 0) out.drift = errors.drift(kept, Eigen::all);
  out.setting.clear();
  for (const Eigen::Index k : kept)
    out.setting.push_back(errors.setting[static_cast<std::size_t>(k)]);
  return out;
}

// (P y)_k/√P_kk with sizes estimated from the other positions only; nullopt if they do not
// determine the fit, or are inconsistent themselves.
std::optional<double> against_the_others(const TumbleSolution& solution, Eigen::Index row) {
  const Eigen::MatrixXd& A = solution.design.A;
  const TumbleErrors& errors = solution.regression.errors;
  std::vector<Eigen::Index> kept;
  for (Eigen::Index k = 0; k < A.rows(); ++k)
    if (k != row) kept.push_back(k);
  const Eigen::MatrixXd A_kept = A(kept, Eigen::all);
  constexpr double least_information = 1e-6;
  if (symmetric_eigen(A_kept.transpose() * A_kept).values.minCoeff() < least_information)
    return std::nullopt;
  const TumbleSizes sizes = find_sizes(A_kept, solution.outputs(kept), without(errors, kept));
  if ((errors.noise_known && sizes.noise > 1.0) || sizes.noise <= 0.0) return std::nullopt;
  return solve_tumble(A, solution.outputs, errors, sizes).deleted(row);
}

// Tests the positions with the largest deletion residuals, each against a fit without it, since an
// outlier inflates the error sizes by which it would be judged.
void name_suspects(const TumbleSolution& solution, double least, TumbleFit& fit) {
  constexpr std::size_t most_candidates = 4;
  const TumbleErrors& errors = solution.regression.errors;
  const TumbleSolved plain = solve_tumble(solution.design.A, solution.outputs, errors, {});
  std::vector<std::size_t> order(fit.positions.size());
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
  const auto size = [&](std::size_t k) {
    return std::abs(plain.deleted(static_cast<Eigen::Index>(k)));
  };
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return size(a) > size(b); });
  order.resize(std::min(order.size(), most_candidates));
  const double left = errors.noise_known ? errors.noise_dof : static_cast<double>(fit.dof) - 1.0;
  double largest = 0.0;
  std::optional<std::size_t> found;
  for (const std::size_t k : order) {
    const auto t = against_the_others(solution, static_cast<Eigen::Index>(k));
    if (!t || std::abs(*t) <= largest) continue;
    largest = std::abs(*t);
    found = k;
    fit.positions[k].studentised = *t;
  }
  if (!found || residual_p(largest, left) >= least) return;
  for (TumbleResidual& r : fit.positions) r.suspect = false;
  fit.positions[*found].suspect = true;
}

std::string rate_unit(bool in_time) {
  return in_time ? "per second" : "per position";
}

// From the two visits of one position that are furthest apart in time.
std::optional<double> closure_rate(const TumbleSolution& solution, View<TumblePosition> positions) {
  const TumbleDesign& design = solution.design;
  const double scale =
      amplitude_of(design, solution.regression.beta) / solution.options.gravity_mps2;
  double farthest = 0.0;
  std::optional<double> rate;
  for (std::size_t j = 0; j < positions.size(); ++j) {
    for (std::size_t k = 0; k < j; ++k) {
      const double apart = design.when[j] - design.when[k];
      const bool same = design.setting[j] == design.setting[k] &&
                        positions[j].plane == positions[k].plane &&
                        std::abs(positions[j].mount_rad - positions[k].mount_rad) < 1e-3;
      if (!same || std::abs(apart) <= farthest) continue;
      farthest = std::abs(apart);
      rate = (positions[j].output - positions[k].output) / apart / scale;
    }
  }
  return rate;
}

}  // namespace

void find_residuals(const TumbleSolution& solution,
                    View<TumblePosition> positions,
                    TumbleFit& fit) {
  const TumbleRegression& regression = solution.regression;
  const bool indexing = regression.indexing_std_rad > 0.0,
             by_deletion = regression.deleted.size() > 0;
  // With two kinds of error there is no exact distribution; Student's t is conservative.
  const bool external = (!fit.noise_known || fit.scatter > 1.0) && !indexing && !by_deletion;
  const auto dof = static_cast<double>(fit.dof);
  const double left = external ? dof - 1.0 : regression.dof;
  double size = 0.0;
  for (const TumblePosition& p : positions) size = std::max(size, std::abs(p.output));
  const double least = chance / static_cast<double>(positions.size());
  for (std::size_t k = 0; k < positions.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    TumbleResidual out;
    out.residual = regression.residual(row);
    out.fitted = positions[k].output - out.residual;
    const double variance = regression.residual_variance(row);
    if (regression.has_scale) out.std = std::sqrt(variance);
    // The residual of a position that alone determines a parameter is zero.
    const bool judged = out.std && *out.std > rounding * size && fit.dof > 0;
    if (judged && by_deletion)
      out.studentised = regression.deleted(row);
    else if (judged)
      out.studentised = studentised(out.residual / *out.std, dof, external);
    out.suspect = out.studentised && residual_p(*out.studentised, left) < least;
    fit.positions.push_back(out);
  }
  if (fit.dof >= 2 && regression.sigma > 0.0) name_suspects(solution, least, fit);
}

std::optional<TumbleLackOfFit> find_lack_of_fit(const TumbleSolution& solution,
                                                View<TumblePosition> positions,
                                                const Eigen::VectorXd& outputs) {
  const TumbleRegression& regression = solution.regression;
  const auto n = static_cast<Eigen::Index>(positions.size());
  const auto dof = static_cast<std::size_t>(n - solution.design.A.cols());
  if (dof == 0) return std::nullopt;
  TumbleLackOfFit out;
  if (regression.noise_known) {
    out.against = "noise of the means";
    out.dof = dof;
    out.noise_dof = regression.noise_dof;
    out.statistic = regression.chi_square / static_cast<double>(dof);
    out.p = out.noise_dof > 0.0 ? fisher_f_p(out.statistic, static_cast<double>(dof), out.noise_dof)
                                : chi_square_p(regression.chi_square, static_cast<double>(dof));
    return out;
  }
  // An error of indexing is repeated at each visit, so repeated positions do not show it.
  if (solution.options.indexing_std_rad.value_or(0.0) > 0.0) return std::nullopt;
  const auto drift = solution.design.find(TumbleTerm::drift);
  Eigen::VectorXd column;
  if (drift) column = solution.design.A.col(static_cast<Eigen::Index>(*drift));
  const Within within = within_visits(positions, outputs, drift ? &column : nullptr);
  const double lack = static_cast<double>(dof) - within.dof;
  const double size = outputs.cwiseAbs().maxCoeff();
  const double floor = rounding * rounding * size * size;
  if (within.dof < 1.0 || lack < 1.0 || within.rss <= floor) return std::nullopt;
  out.against = "repeated positions";
  out.dof = static_cast<std::size_t>(lack);
  out.noise_dof = within.dof;
  out.statistic = std::max(regression.rss - within.rss, 0.0) / lack / (within.rss / within.dof);
  out.p = fisher_f_p(out.statistic, lack, within.dof);
  return out;
}

TumbleDrift find_drift(const TumbleSolution& solution,
                       View<TumblePosition> positions,
                       const TumbleFit& fit) {
  const TumbleDesign& design = solution.design;
  TumbleDrift out;
  out.known = design.closed;
  out.in_time = design.in_time;
  const TumbleCoefficient* found = fit.find(TumbleQuantity::drift);
  out.removed = found != nullptr && found->value.has_value();
  if (!out.known) {
    out.words =
        "drift during the test is unknown: no position was revisited late enough, and a change "
        "of the bias would affect the other coefficients";
    return out;
  }
  if (!out.removed) {
    out.rate_mps2 = closure_rate(solution, positions);
    out.words = fmt::format(
        "the repeated position shows a drift of {} m/s² {}, which was not removed: {} positions "
        "leave no redundancy if it is removed",
        compact(out.rate_mps2.value_or(0.0), 3), rate_unit(out.in_time), positions.size());
    return out;
  }
  out.rate_mps2 = found->value;
  out.words = fmt::format("drift of {} m/s² {} was removed", compact(*found->value, 3),
                          rate_unit(out.in_time));
  if (found->std && *found->std > 0.0) {
    out.p = residual_p(*found->value / *found->std, found->dof);
    out.words += *out.p < 0.05 ? fmt::format(": it is more than chance (p = {:.2g})", *out.p)
                               : fmt::format(": it may be chance (p = {:.2g})", *out.p);
  }
  if (!out.in_time) out.words += "; the rows' order was taken as that of the visits";
  return out;
}

}  // namespace proofmass::calibrate
