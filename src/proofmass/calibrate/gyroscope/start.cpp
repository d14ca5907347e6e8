#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "proofmass/calibrate/gyroscope/fit.hpp"
#include "proofmass/core/statistics.hpp"

namespace proofmass::calibrate {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr std::size_t most_motions = 8;  // enough to choose among coarse candidates
constexpr double explained_rad = 0.35;   // median angle from which the fit converges

// Every n-th motion.
std::vector<const GyroscopeMotion*> chosen_motions(const GyroscopeData& data) {
  std::vector<const GyroscopeMotion*> out;
  const std::size_t stride = (data.motions.size() + most_motions - 1) / most_motions;
  for (std::size_t k = 0; k < data.motions.size(); k += std::max<std::size_t>(stride, 1))
    out.push_back(&data.motions[k]);
  return out;
}

double median_angle(const GyroscopeData& data,
                    const std::vector<const GyroscopeMotion*>& motions,
                    const Matrix3d& A) {
  std::vector<double> angles;
  for (const GyroscopeMotion* motion : motions) {
    Vector3d up = data.rests[motion->from].up;
    for (std::size_t n = 0; n < motion->samples.step_s.size(); ++n) {
      const Vector3d y = 0.5 * (motion->samples.reading[n] + motion->samples.reading[n + 1]);
      const Vector3d back = up.cross(motion->samples.step_s[n] * (A * y));
      up = (up + back + 0.5 * back.cross(motion->samples.step_s[n] * (A * y))).normalized();
    }
    const Vector3d& measured = data.rests[motion->to].up;
    angles.push_back(std::atan2(up.cross(measured).norm(), up.dot(measured)));
  }
  return median(angles).value_or(0.0);
}

// Scales at which the median motion turns by 0.2 to 15 rad, 8 % apart.
std::vector<double> scales(const std::vector<const GyroscopeMotion*>& motions, bool in_radps) {
  if (in_radps) return {1.0};
  std::vector<double> turned;
  for (const GyroscopeMotion* motion : motions) {
    double sum = 0.0;
    for (std::size_t n = 0; n < motion->samples.step_s.size(); ++n)
      sum += motion->samples.step_s[n] * motion->samples.reading[n].norm();
    turned.push_back(sum);
  }
  const double usual = std::max(median(turned).value_or(1.0), 1e-300);
  std::vector<double> out;
  for (double angle = 0.2; angle < 15.0; angle *= 1.08) out.push_back(angle / usual);
  return out;
}

struct Candidate {
  Matrix3d A = Matrix3d::Identity();
  double angle_rad = 10.0;
};

void try_scales(const GyroscopeData& data,
                const std::vector<const GyroscopeMotion*>& motions,
                const std::vector<double>& scales,
                const Matrix3d& axes,
                Candidate& best) {
  for (const double scale : scales) {
    const double angle = median_angle(data, motions, scale * axes);
    if (angle < best.angle_rad) best = {scale * axes, angle};
  }
}

// The 48 assignments of the gyroscope's axes to the accelerometer's, with signs.
std::vector<Matrix3d> signed_permutations() {
  std::vector<Matrix3d> out;
  std::array<Index, 3> order{0, 1, 2};
  do {
    for (int signs = 0; signs < 8; ++signs) {
      Matrix3d P = Matrix3d::Zero();
      for (Index k = 0; k < 3; ++k)
        P(k, order[static_cast<std::size_t>(k)]) = (signs >> k & 1) != 0 ? -1.0 : 1.0;
      out.push_back(P);
    }
  } while (std::ranges::next_permutation(order).found);
  return out;
}

}  // namespace

Result<Matrix3d> starting_matrix(const GyroscopeData& data, bool in_radps) {
  const std::vector<const GyroscopeMotion*> motions = chosen_motions(data);
  if (motions.empty()) return Matrix3d(Matrix3d::Identity());
  const std::vector<double> range = scales(motions, in_radps);
  Candidate best;
  try_scales(data, motions, range, Matrix3d::Identity(), best);
  if (best.angle_rad > explained_rad)
    for (const Matrix3d& axes : signed_permutations()) try_scales(data, motions, range, axes, best);
  if (best.angle_rad > explained_rad)
    return Error{Errc::not_observable,
                 "gyroscope: no scale and assignment of its axes rotates gravity as the "
                 "accelerometer measures it: check its unit and that both sensors have one clock"};
  const Matrix3d& A = best.A;
  if (A.col(0).cross(A.col(1)).dot(A.col(2)) < 0.0)
    return Error{Errc::invalid_argument,
                 "gyroscope: its axes form a left-handed system with the accelerometer's: change "
                 "the sign of one channel, or the order of two"};
  return best.A;
}

}  // namespace proofmass::calibrate
