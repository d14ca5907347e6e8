#include "proofmass/calibrate/multi_position/fixture_fit.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <vector>

#include "proofmass/calibrate/multi_position/parts.hpp"
#include "proofmass/calibrate/multi_position/pose_selection.hpp"
#include "proofmass/core/chi_square.hpp"
#include "proofmass/core/linalg.hpp"
#include "proofmass/core/so3.hpp"

namespace proofmass::calibrate {
namespace {

using Matrix3x12 = Eigen::Matrix<double, 3, 12>;
using Matrix12 = Eigen::Matrix<double, 12, 12>;

constexpr double suspect_p = 0.01;   // after Bonferroni's correction
constexpr double rounding_g = 1e-9;  // smaller residuals do not count as contradictions
constexpr std::ptrdiff_t fewest_given = 5;

struct GivenPose {
  NormalisedPose pose;
  Eigen::Vector3d up;
  bool used = true;
};

struct State {
  Parameters p;
  Eigen::Matrix3d R_sensor_fixture;
  double noise_factor = 1.0;        // of the means' variances
  double placement_variance = 0.0;  // rad², about either axis
};

// With f = M (u − b) and n = f/|f|: e = (|f| − 1) r + (I − r rᵀ) n about r = R d, its derivatives
// by p and by a small rotation of R, and its covariance. A position error does not shorten f, as it
// would in the plain difference f − r.
struct GivenTerm {
  Eigen::Vector3d e, up;
  Matrix3x12 J;
  Eigen::Matrix3d covariance;
  double along_variance, across_variance;  // of e by noise alone, along up and across (both axes)
};

GivenTerm given_term(const State& state, const GivenPose& given) {
  const Parameters& p = state.p;
  const Eigen::Matrix3d M = correction(p);
  const Eigen::Vector3d v = given.pose.u - p.head<3>();
  const Eigen::Vector3d w = v.cwiseQuotient(p.segment<3>(3));
  GivenTerm term;
  term.up = state.R_sensor_fixture * given.up;
  const Eigen::Vector3d f = M * v;
  const Eigen::Vector3d n = f.normalized();
  const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - term.up * term.up.transpose();
  term.e = (f.norm() - 1.0) * term.up + across * n;
  const Eigen::Matrix3d G = term.up * n.transpose() +
                            across * (Eigen::Matrix3d::Identity() - n * n.transpose()) / f.norm();
  Eigen::Matrix<double, 3, 9> force;
  force << -M, -M * w.asDiagonal(), Eigen::Matrix3d::Zero();
  force(0, 6) = -w.y();
  force(0, 7) = w.z();
  force(1, 8) = -w.z();
  term.J << G * force, cross_matrix(term.up);
  const Eigen::Matrix3d GM = G * M;
  const Eigen::Matrix3d noise = state.noise_factor * GM * given.pose.covariance * GM.transpose();
  term.along_variance = term.up.dot(noise * term.up);
  term.across_variance = noise.trace() - term.along_variance;
  term.covariance = noise + state.placement_variance * across;
  return term;
}

// Σ (d, 1)(d, 1)ᵀ over the directions of those used.
Eigen::Matrix4d spread_of(const std::vector<GivenPose>& poses) {
  Eigen::Matrix4d N = Eigen::Matrix4d::Zero();
  for (const GivenPose& given : poses) {
    if (!given.used) continue;
    const Eigen::Vector4d row = given.up.homogeneous();
    N += row * row.transpose();
  }
  return N;
}

// Whether those used are enough and not coplanar.
bool carry_parameters(const std::vector<GivenPose>& poses) {
  const auto used = std::ranges::count_if(poses, [](const GivenPose& pose) { return pose.used; });
  return used >= fewest_given &&
         symmetric_eigen(spread_of(poses)).values(0) >= 1e-4 * static_cast<double>(used);
}

// u = A d + b by least squares, then A⁻¹ = Rᵀ M.
Result<State> linear_start(const std::vector<GivenPose>& poses) {
  if (!carry_parameters(poses)) {
    return Error{Errc::not_observable,
                 "the given directions are coplanar or nearly so: add positions out of the plane"};
  }
  const Eigen::Matrix4d N = spread_of(poses);
  Eigen::Matrix<double, 4, 3> right = Eigen::Matrix<double, 4, 3>::Zero();
  for (const GivenPose& given : poses) {
    const Eigen::Vector4d row = given.up.homogeneous();
    right += row * given.pose.u.transpose();
  }
  const Eigen::Matrix<double, 4, 3> X = positive_inverse(N) * right;
  const Eigen::Matrix3d A = X.topRows<3>().transpose();
  if (!(A.determinant() > 0.0)) {
    return Error{Errc::invalid_argument,
                 "the given directions are the mirror image of the data, or an axis does not "
                 "follow them: is the sign of an axis wrong?"};
  }
  const auto [Q, M] = positive_qr(A.inverse());
  State state;
  state.p << X.row(3).transpose(), M.diagonal().cwiseInverse(), -M(0, 1) / M(1, 1),
      M(0, 2) / M(2, 2), -M(1, 2) / M(2, 2);
  state.R_sensor_fixture = Q.transpose();
  return state;
}

struct GivenFit {
  State state;
  Matrix12 cofactor = Matrix12::Zero();
  Scatter scatter;  // along the directions
  std::size_t dof = 0;
  int iterations = 0;
  bool converged = false;
};

// One Gauss–Newton step with the weights of the state; returns its length in units of the
// uncertainty.
double step(const std::vector<GivenPose>& poses, GivenFit& fit) {
  Matrix12 N = Matrix12::Zero();
  Eigen::Matrix<double, 12, 1> right = Eigen::Matrix<double, 12, 1>::Zero();
  for (const GivenPose& given : poses) {
    if (!given.used) continue;
    const GivenTerm term = given_term(fit.state, given);
    const Eigen::Matrix3d W = positive_inverse(term.covariance);
    N += term.J.transpose() * W * term.J;
    right -= term.J.transpose() * W * term.e;
  }
  fit.cofactor = positive_inverse(N);
  const Eigen::Matrix<double, 12, 1> change = fit.cofactor * right;
  fit.state.p += change.head<9>();
  const Eigen::Vector3d turn = change.tail<3>();
  if (turn.norm() > 0.0) {
    const Eigen::Matrix3d by = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
    fit.state.R_sensor_fixture = by * fit.state.R_sensor_fixture;
  }
  return std::sqrt(std::max(0.0, change.dot(right)));
}

// Noise from the residuals along the directions, placement from those across: each sum of squares
// has its own remaining degrees of freedom.
void estimate_variances(const std::vector<GivenPose>& poses, double noise_dof, GivenFit& fit) {
  double lengths = 0.0, along = 0.0, along_dof = 0.0, across = 0.0, across_noise = 0.0,
         across_dof = 0.0;
  for (const GivenPose& given : poses) {
    if (!given.used) continue;
    const GivenTerm term = given_term(fit.state, given);
    const Eigen::Matrix3d W = positive_inverse(term.covariance);
    const Eigen::Matrix3d hat = term.J * fit.cofactor * term.J.transpose() * W;
    const double h_along = term.up.dot(hat * term.up);
    const double e_along = term.up.dot(term.e);
    along += e_along * e_along * fit.state.noise_factor / term.along_variance;
    along_dof += 1.0 - h_along;
    lengths += 1.0;
    across += term.e.squaredNorm() - e_along * e_along;
    across_noise += term.across_variance * (1.0 - (hat.trace() - h_along) / 2.0);
    across_dof += 2.0 - (hat.trace() - h_along);
  }
  // If norms alone do not determine the nine parameters, the residual along the directions is the
  // curvature of position errors, not noise.
  fit.scatter = scatter_of(along, lengths > 9.0 ? along_dof : 0.0, noise_dof);
  if (fit.scatter.dof > 0.0) fit.state.noise_factor = std::max(fit.scatter.factor, 1e-20);
  if (across_dof > 0.5)
    fit.state.placement_variance = std::max(0.0, (across - across_noise) / across_dof);
}

GivenFit fit_given(const std::vector<GivenPose>& poses, const State& start, double noise_dof) {
  GivenFit fit;
  fit.state = start;
  constexpr int most = 50;
  for (; fit.iterations < most && !fit.converged; ++fit.iterations) {
    const double before = fit.state.placement_variance;
    fit.converged = step(poses, fit) < 1e-6 && fit.iterations > 4;
    estimate_variances(poses, noise_dof, fit);
    fit.converged &= std::abs(fit.state.placement_variance - before) <= 1e-6 * before + 1e-30;
  }
  const auto used = std::ranges::count_if(poses, [](const GivenPose& pose) { return pose.used; });
  fit.dof = 3 * static_cast<std::size_t>(used) - 12;
  return fit;
}

// A pose's squared distance from the others, in `parts` residuals out of a sum with `dof`.
struct Contradiction {
  double parts;
  double dof, total = 0.0;
  std::vector<double> distance;

  // p-value of the distance over all poses: F-test of the deleted pose.
  [[nodiscard]] double p(std::size_t worst) const {
    const double rest = total - distance[worst], rest_dof = dof - parts;
    if (!(distance[worst] > 0.0) || !(rest > 0.0) || !(rest_dof >= 1.0)) return 1.0;
    const double F = distance[worst] / parts / (rest / rest_dof);
    return static_cast<double>(distance.size()) * fisher_f_p(F, parts, rest_dof);
  }
};

// The pose that contradicts the others most, if significantly: by its norm alone or as a whole.
std::optional<std::size_t> suspect_of(const std::vector<GivenPose>& poses, const GivenFit& fit) {
  Contradiction whole{3.0, static_cast<double>(fit.dof), 0.0, std::vector(poses.size(), 0.0)};
  Contradiction length{1.0, 0.0, 0.0, whole.distance};
  for (std::size_t k = 0; k < poses.size(); ++k) {
    if (!poses[k].used) continue;
    const GivenTerm term = given_term(fit.state, poses[k]);
    const Eigen::Matrix3d left = term.covariance - term.J * fit.cofactor * term.J.transpose();
    const double e = term.up.dot(term.e), left_along = term.up.dot(left * term.up);
    length.total += e * e / term.along_variance;
    length.dof += left_along / term.along_variance;
    if (term.e.norm() < rounding_g || !(left_along > 1e-6 * term.along_variance)) continue;
    whole.total += term.e.dot(positive_inverse(term.covariance) * term.e);
    whole.distance[k] = term.e.dot(positive_inverse(left) * term.e);
    length.distance[k] = e * e / left_along;
  }
  for (const Contradiction* test : {&length, &whole}) {
    const auto worst =
        static_cast<std::size_t>(std::ranges::max_element(test->distance) - test->distance.begin());
    if (2.0 * test->p(worst) < suspect_p) return worst;
  }
  return std::nullopt;
}

Result<std::vector<GivenPose>> given_poses(View<Pose> poses, const ReadingScale& scale) {
  if (std::ssize(poses) < fewest_given) {
    return Error{
        Errc::too_few_samples,
        fmt::format("{} positions: given directions need at least {}", poses.size(), fewest_given)};
  }
  const std::vector<NormalisedPose> normalised = normalise(poses, scale);
  std::vector<GivenPose> out;
  out.reserve(poses.size());
  for (std::size_t k = 0; k < poses.size(); ++k) {
    if (!poses[k].up || !(poses[k].up->norm() > 0.0)) {
      return Error{Errc::invalid_argument,
                   fmt::format("position {}: its direction is not given", k + 1)};
    }
    out.push_back({normalised[k], poses[k].up->normalized()});
  }
  return out;
}

MultiPosition assembled(const std::vector<GivenPose>& poses,
                        const GivenFit& fit,
                        const ReadingScale& scale,
                        bool noise_known,
                        const MultiPositionOptions& options) {
  MultiPosition out;
  out.model = PoseModel::given_12;
  out.gravity_mps2 = options.gravity_mps2;
  const ParameterMatrix slope = scale.slope().asDiagonal();
  const ParameterMatrix cofactor = fit.cofactor.topLeftCorner<9, 9>();
  const auto dof = static_cast<double>(fit.dof);
  out.shares = {{"noise of the means and placement", true, slope * cofactor * slope, dof},
                gravity_share(scale.to_reading(fit.state.p), options)};
  set_estimate(scale.to_reading(fit.state.p), true, out);
  out.dof = dof;
  const double g = options.gravity_mps2;
  for (const GivenPose& given : poses) {
    const NormTerm term = norm_term(fit.state.p, given.pose);
    PoseResidual& pose = out.poses.emplace_back();
    pose.residual_mps2 = g * term.residual;
    pose.predicted_std_mps2 = noise_known ? g * std::sqrt(term.variance) : 0.0;
    pose.suspect = !given.used;
    pose.used = given.used;
    pose.force_mps2 = g * term.force;
  }
  set_residual_sums(out);
  out.lack_of_fit = fit.scatter.lack_of_fit;
  const Eigen::AngleAxisd mounting(fit.state.R_sensor_fixture);
  out.mounting_rad = mounting.angle() * mounting.axis();
  out.mounting_std_rad = fit.cofactor.bottomRightCorner<3, 3>().diagonal().cwiseSqrt();
  out.axes_in_fixture = fit.state.R_sensor_fixture;
  out.placement_std_rad = std::sqrt(fit.state.placement_variance);
  out.condition = std::sqrt(
      fit.cofactor.diagonal().cwiseProduct(positive_inverse(fit.cofactor).diagonal()).maxCoeff());
  out.iterations = fit.iterations;
  out.converged = fit.converged;
  return out;
}

bool is_finite(const GivenFit& fit) {
  return fit.cofactor.allFinite() && fit.state.p.allFinite() &&
         fit.state.R_sensor_fixture.allFinite();
}

Error contradicted(const std::vector<GivenPose>& poses) {
  return {
      Errc::not_observable,
      fmt::format("the {} positions contradict each other, and those that agree do not determine "
                  "the parameters: check the given directions, and add positions",
                  poses.size())};
}

}  // namespace

Result<MultiPosition> calibrate_given(View<Pose> poses,
                                      const ReadingScale& scale,
                                      double noise_dof,
                                      const MultiPositionOptions& options) {
  Result<std::vector<GivenPose>> given = given_poses(poses, scale);
  if (!given) return given.error();
  std::vector<GivenPose> all = *given;
  const Result<State> start = linear_start(all);
  if (!start) return start.error();
  GivenFit fit = fit_given(all, *start, noise_dof);
  if (!is_finite(fit)) return contradicted(*given);
  while (const std::optional<std::size_t> suspect = suspect_of(all, fit)) {
    all[*suspect].used = false;
    if (!carry_parameters(all)) return contradicted(*given);
    fit = fit_given(all, fit.state, noise_dof);
    if (!is_finite(fit)) return contradicted(*given);
  }
  if (options.keep_suspects) fit = fit_given(*given, fit.state, noise_dof);
  MultiPosition out = assembled(all, fit, scale, noise_dof > 0.0, options);
  if (options.keep_suspects)
    for (PoseResidual& pose : out.poses) pose.used = true;
  return out;
}

}  // namespace proofmass::calibrate
