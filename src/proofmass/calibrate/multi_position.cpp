#include "proofmass/calibrate/multi_position.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/calibrate/multi_position/ellipsoid_start.hpp"
#include "proofmass/calibrate/multi_position/fixture_fit.hpp"
#include "proofmass/calibrate/multi_position/norm_fit.hpp"
#include "proofmass/calibrate/multi_position/parts.hpp"
#include "proofmass/calibrate/multi_position/pose_design.hpp"
#include "proofmass/calibrate/multi_position/pose_selection.hpp"
#include "proofmass/calibrate/multi_position/six_position.hpp"
#include "proofmass/core/contract.hpp"
#include "proofmass/core/statistics.hpp"
#include "proofmass/core/units.hpp"

namespace proofmass::calibrate {
namespace {

constexpr double singular = 1e6;         // of a condition, where the noise does not decide
constexpr double useless_error_g = 0.1;  // a parameter with a larger error is not determined

Status check(View<Pose> poses, const MultiPositionOptions& options) {
  if (!(options.gravity_mps2 > 0.0) || !std::isfinite(options.gravity_mps2))
    return Error{Errc::invalid_argument, "gravity: expected a positive number"};
  if (poses.empty()) return Error{Errc::too_few_samples, "no position at rest"};
  for (std::size_t k = 0; k < poses.size(); ++k) {
    if (poses[k].mean.allFinite() && poses[k].mean_covariance.allFinite()) continue;
    return Error{Errc::not_finite, fmt::format("position {}: its mean is not finite", k + 1)};
  }
  return Done{};
}

Eigen::MatrixXd information_of(const PoseSelection& selection, NormParameters free) {
  const auto count = static_cast<Eigen::Index>(free);
  Eigen::MatrixXd N = Eigen::MatrixXd::Zero(count, count);
  for (std::size_t k = 0; k < selection.fit.terms.size(); ++k) {
    if (!selection.used[k]) continue;
    const NormTerm& term = selection.fit.terms[k];
    const Eigen::VectorXd j = term.gradient.head(count);
    N += j * j.transpose() / term.variance;
  }
  return N;
}

double typical_variance(const PoseSelection& selection) {
  std::vector<double> variances;
  variances.reserve(selection.fit.terms.size());
  for (const NormTerm& term : selection.fit.terms) variances.push_back(term.variance);
  return *median(variances) * std::max(selection.scatter.factor, 1e-300);
}

// Whether the poses determine the fitted parameters.
bool carried(const PoseSelection& selection, const MultiPositionOptions& options) {
  const NormFit& fit = selection.fit;
  if (!(fit.condition < singular) || !fit.cofactor.allFinite()) return false;
  if (selection.scatter.dof == 0.0) return true;
  const Eigen::VectorXd error = errors_at_1g(selection.scatter.factor * fit.cofactor, fit.p);
  if (error.size() == 9 && error.tail<3>().maxCoeff() > options.orthogonality_std_rad) return false;
  return error.maxCoeff() < useless_error_g;
}

struct NormCalibration {
  NormParameters free;
  PoseSelection selection;
};

// Nine parameters if requested or determined, else six.
Result<NormCalibration> choose(const NormData& data,
                               double noise_dof,
                               const MultiPositionOptions& options) {
  const bool asked = options.model.has_value();
  const bool nine_first = asked ? *options.model == PoseModel::norm_9 : data.poses.size() >= 9;
  for (const NormParameters free : {NormParameters::nine, NormParameters::six}) {
    if (free == NormParameters::nine && !nine_first) continue;
    const auto count = static_cast<std::size_t>(free);
    if (data.poses.size() < count) {
      return Error{Errc::too_few_samples,
                   fmt::format("{} positions for {} parameters: at least {} are needed, and 18 "
                               "spread over all directions are sensible",
                               data.poses.size(), count, count)};
    }
    const Parameters start = ellipsoid_start(data.poses, free == NormParameters::nine);
    Result<PoseSelection> selection =
        select_poses(data, start, {free, noise_dof, options.keep_suspects});
    if (!selection) {
      if (free == NormParameters::nine && !asked) continue;
      return Error{
          Errc::not_observable,
          "no bias and scale bring the positions to one length: " + selection.error().message +
              "; check the unit of the data, and add positions in other directions"};
    }
    if (carried(*selection, options)) return NormCalibration{free, *selection};
    if (free == NormParameters::nine && !asked) continue;
    const Eigen::MatrixXd information = information_of(*selection, free);
    const NextPose next = next_pose(information, selection->fit.p, 1.0);
    return Error{Errc::not_observable, fmt::format("the positions {}: add others, such as: {}",
                                                   unresolved(information), next.words)};
  }
  PM_EXPECTS(false);
}

// Sensitivity of the normalised parameters to the three angles omitted by six parameters: the
// others adapt to the residuals.
Eigen::Matrix<double, 9, 3> sensitivity_to_angles(const PoseSelection& selection) {
  const auto n = static_cast<Eigen::Index>(selection.fit.terms.size());
  Eigen::MatrixXd J(n, 9);
  for (Eigen::Index k = 0; k < n; ++k)
    J.row(k) = selection.fit.terms[static_cast<std::size_t>(k)].gradient;
  const Eigen::MatrixXd pull =
      J.leftCols<6>().transpose() * selection.weights.times(J.rightCols<3>());
  Eigen::Matrix<double, 9, 3> out;
  out << -selection.fit.cofactor * pull, Eigen::Matrix3d::Identity();
  return out;
}

// Contribution of quantisation to the parameters' covariance.
Eigen::MatrixXd by_resolution(const NormCalibration& norm,
                              std::vector<Pose> poses,
                              const ReadingScale& scale) {
  const PoseSelection& selection = norm.selection;
  const auto n = static_cast<Eigen::Index>(poses.size()), count = selection.fit.cofactor.rows();
  for (Pose& pose : poses) pose.mean_covariance = pose.rounding_variance.asDiagonal();
  const std::vector<NormalisedPose> steps = normalise(poses, scale);
  Eigen::MatrixXd J(n, count);
  Eigen::VectorXd variance(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const auto place = static_cast<std::size_t>(k);
    J.row(k) = selection.fit.terms[place].gradient.head(count);
    variance(k) = norm_term(selection.fit.p, steps[place]).variance;
  }
  const Eigen::MatrixXd gain = selection.fit.cofactor * selection.weights.times(J).transpose();
  return std::min(selection.scatter.factor, 1.0) * gain * variance.asDiagonal() * gain.transpose();
}

std::vector<UncertaintyShare> shares_of(const NormCalibration& norm,
                                        const Weighable& weighed,
                                        const ReadingScale& scale,
                                        const MultiPositionOptions& options) {
  constexpr double negligible = 1e-4;  // of the variance: less is not worth a line
  const PoseSelection& selection = norm.selection;
  const ParameterMatrix slope = scale.slope().asDiagonal();
  ParameterMatrix noise = ParameterMatrix::Zero();
  const auto count = static_cast<Eigen::Index>(norm.free);
  noise.topLeftCorner(count, count) = selection.scatter.factor * selection.fit.cofactor;
  ParameterMatrix steps = ParameterMatrix::Zero();
  if (weighed.noise_dof > 0.0)
    steps.topLeftCorner(count, count) = by_resolution(norm, weighed.poses, scale);
  std::vector<UncertaintyShare> shares;
  const bool resolved = steps.trace() < negligible * noise.trace();
  if (!resolved) noise -= steps;
  if (selection.scatter.dof > 0.0)
    shares.push_back({"noise of the means", true, slope * noise * slope, selection.scatter.dof});
  if (!resolved) shares.push_back({"resolution of the output", false, slope * steps * slope, 0.0});
  if (selection.by_choice.size() > 0) {
    ParameterMatrix choice = ParameterMatrix::Zero();
    choice.topLeftCorner(count, count) = selection.by_choice;
    shares.push_back({"which position is bad", true, slope * choice * slope, 0.0});
  }
  if (norm.free == NormParameters::six) {
    const Eigen::Matrix<double, 9, 3> S =
        options.orthogonality_std_rad * (slope * sensitivity_to_angles(selection));
    shares.push_back({"orthogonality of the axes", false, S * S.transpose(), 0.0});
  }
  shares.push_back(gravity_share(scale.to_reading(selection.fit.p), options));
  return shares;
}

std::vector<PoseResidual> residuals_of(const PoseSelection& selection,
                                       bool noise_known,
                                       double gravity_mps2) {
  std::vector<PoseResidual> out(selection.fit.terms.size());
  for (std::size_t k = 0; k < out.size(); ++k) {
    const NormTerm& term = selection.fit.terms[k];
    out[k].residual_mps2 = gravity_mps2 * term.residual;
    if (noise_known) out[k].predicted_std_mps2 = gravity_mps2 * std::sqrt(term.variance);
    if (selection.leave_one_out[k])
      out[k].leave_one_out_mps2 = gravity_mps2 * *selection.leave_one_out[k];
    out[k].studentised = selection.studentised[k];
    if (selection.detectable[k]) out[k].detectable_mps2 = gravity_mps2 * *selection.detectable[k];
    out[k].suspect = selection.suspect[k];
    out[k].used = selection.used[k];
    out[k].force_mps2 = gravity_mps2 * term.force;
  }
  return out;
}

// With little redundancy some positions are not checked by others.
void add_unchecked(MultiPosition& out) {
  constexpr double large = 15.0;  // of what noise does; among 18 well spread positions it is 6
  std::string positions;
  double largest_mps2 = 0.0;
  for (std::size_t k = 0; k < out.poses.size(); ++k) {
    const PoseResidual& pose = out.poses[k];
    if (!pose.used || !pose.detectable_mps2 || !(pose.predicted_std_mps2 > 0.0)) continue;
    if (*pose.detectable_mps2 < large * pose.predicted_std_mps2) continue;
    positions += fmt::format("{}{}", positions.empty() ? "" : ", ", k + 1);
    largest_mps2 = std::max(largest_mps2, *pose.detectable_mps2);
  }
  if (positions.empty()) return;
  out.notes.push_back(fmt::format(
      "the others hardly check position {}: an error of up to {:.2g} mg there would not "
      "be noticed, and the intervals do not contain it; add positions near it",
      positions, 1e3 * largest_mps2 / standard_gravity_mps2));
}

void add_notes(const NormCalibration& norm,
               const MultiPositionOptions& options,
               MultiPosition& out) {
  if (out.dof == 0.0) out.notes.emplace_back(noise_missing);
  add_unchecked(out);
  if (norm.free == NormParameters::six) {
    out.notes.push_back(fmt::format(
        "misalignment_rad: null: {}; the axes are taken as orthogonal within {:.3g} rad, "
        "which the uncertainties hold",
        options.model ? "six parameters were requested"
                      : "the positions do not determine nine parameters",
        options.orthogonality_std_rad));
  }
}

MultiPosition assembled(const NormCalibration& norm,
                        const Weighable& weighed,
                        const ReadingScale& scale,
                        const MultiPositionOptions& options) {
  const PoseSelection& selection = norm.selection;
  MultiPosition out;
  out.model = norm.free == NormParameters::nine ? PoseModel::norm_9 : PoseModel::norm_6;
  out.shares = shares_of(norm, weighed, scale, options);
  set_estimate(scale.to_reading(selection.fit.p), norm.free == NormParameters::nine, out);
  out.dof = selection.scatter.dof;
  out.gravity_mps2 = options.gravity_mps2;
  out.poses = residuals_of(selection, weighed.noise_dof > 0.0, options.gravity_mps2);
  set_residual_sums(out);
  out.lack_of_fit = selection.lack_of_fit;
  out.doubtful = selection.alike;
  out.condition = selection.fit.condition;
  const double factor = selection.scatter.dof > 0.0 ? selection.scatter.factor : 1.0;
  out.next_pose = next_pose(information_of(selection, norm.free) / std::max(factor, 1e-300),
                            selection.fit.p, typical_variance(selection));
  out.iterations = selection.fit.iterations;
  out.converged = selection.fit.converged;
  add_notes(norm, options, out);
  return out;
}

}  // namespace

Status check_acceleration_unit(View<Pose> poses, double gravity_mps2) {
  std::vector<double> lengths;
  lengths.reserve(poses.size());
  for (const Pose& pose : poses) lengths.push_back(pose.mean.norm());
  const double length = median(lengths).value_or(gravity_mps2);
  constexpr double near = 0.25;
  const auto wrong = [&](const char* meaning, const char* unit) {
    return Error{
        Errc::invalid_argument,
        fmt::format("at rest the norm is {:.3g} m/s², which is gravity in {}", length, meaning),
        {Advice{"unit", unit}}};
  };
  if (std::abs(length - 1.0) < near) return wrong("g", "g");
  if (std::abs(length / 1000.0 - 1.0) < near) return wrong("mg", "mg");
  if (std::abs(length / (gravity_mps2 * gravity_mps2) - 1.0) < near)
    return wrong("m/s² interpreted as g", "m/s2");
  return Done{};
}

Result<MultiPosition> calibrate_positions(View<Pose> poses, const MultiPositionOptions& options) {
  if (const Status status = check(poses, options); !status) return status.error();
  const Weighable weighed = weighable(poses, options.noise_dof);
  const std::optional<ReadingScale> scale = reading_scale(weighed.poses, options.gravity_mps2);
  if (!scale) {
    return Error{Errc::not_observable,
                 "all positions read the same: turn the sensor to different directions"};
  }
  if (options.model == PoseModel::given_12)
    return calibrate_given(weighed.poses, *scale, weighed.noise_dof, options);
  if (options.model == PoseModel::six_position)
    return calibrate_six_position(weighed.poses, weighed.noise_dof, options);
  const Result<NormCalibration> norm =
      choose(norm_data(weighed, *scale, options), weighed.noise_dof, options);
  if (!norm) return norm.error();
  return assembled(*norm, weighed, *scale, options);
}

}  // namespace proofmass::calibrate
