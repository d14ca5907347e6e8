#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>

#include "proofmass/calibrate/multi_position.hpp"
#include "proofmass/calibrate/pose_guide.hpp"
#include "proofmass/calibrate/pose_means.hpp"
#include "proofmass/signal/rests.hpp"
#include "proofmass/simulate/procedure.hpp"

namespace proofmass::guided_test {
namespace {

using calibrate::GuideKind;
using calibrate::GuideProcedure;
using calibrate::PoseGuide;
using simulate::Procedure;
using simulate::ProcedureResult;

simulate::ProcedureOptions options_of(Procedure procedure, std::uint64_t seed, bool volts) {
  simulate::ProcedureOptions options = simulate::default_options(procedure);
  options.seed = seed;
  if (volts) options.output = simulate::RigOutput::voltage;
  return options;
}

PoseGuide guided(const simulate::ProcedureOptions& options,
                 const ProcedureResult& twin,
                 std::size_t positions,
                 std::size_t cut) {
  calibrate::GuideOptions how;
  how.procedure = options.procedure == Procedure::tumble ? GuideProcedure::tumble
                                                         : GuideProcedure::multi_position;
  how.channels = {0, 1, 2};
  how.rate_hz = options.rate_hz;
  how.positions = positions;
  if (options.output == simulate::RigOutput::acceleration) how.one_g = standard_gravity_mps2;
  PoseGuide guide(how);
  const std::size_t samples = twin.recording.samples();
  for (std::size_t first = 0; first < samples; first += cut) {
    Block block{first, {}};
    for (std::size_t c = 0; c < 3; ++c)
      block.channels.push_back(View<double>(twin.recording.channels[c].values)
                                   .subspan(first, std::min(cut, samples - first)));
    (void)guide.add(block);
  }
  return guide;
}

// Checks that each true pose is taken once, within its rest including the end of its settling, and
// that there are no others.
void expect_true_poses(const PoseGuide& guide,
                       const ProcedureResult& twin,
                       const simulate::ProcedureOptions& options) {
  ASSERT_EQ(guide.poses().size(), twin.truth.poses.size());
  for (std::size_t k = 0; k < guide.poses().size(); ++k) {
    const calibrate::Pose& pose = guide.poses()[k];
    const simulate::TruePose& truth = twin.truth.poses[k];
    EXPECT_GE(*pose.start_s, truth.start_s - options.timing.settle_s) << k;
    EXPECT_LE(*pose.end_s, truth.end_s) << k;
  }
}

class GuidedTwin : public testing::TestWithParam<std::uint64_t> {};

TEST_P(GuidedTwin, TakesThePositionsOfAHandAndNothingElse) {
  for (const bool volts : {false, true}) {
    const auto options = options_of(Procedure::multi_position, GetParam(), volts);
    const ProcedureResult twin = simulate::simulate_procedure(options).value();
    const std::size_t positions = twin.truth.poses.size();
    expect_true_poses(guided(options, twin, positions, 1000), twin, options);
  }
}

TEST_P(GuidedTwin, TakesThePositionsOfATableAtItsAngles) {
  for (const bool volts : {false, true}) {
    const auto options = options_of(Procedure::tumble, GetParam(), volts);
    const ProcedureResult twin = simulate::simulate_procedure(options).value();
    const PoseGuide guide = guided(options, twin, 24, 1000);
    ASSERT_TRUE(guide.done());
    expect_true_poses(guide, twin, options);
    for (std::size_t k = 0; k < guide.angles_deg().size(); ++k)
      EXPECT_NEAR(guide.angles_deg()[k] * rad_per_deg, twin.truth.poses[k].commanded_rad, 1e-9);
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, GuidedTwin, testing::Values(1, 2, 3, 4));

// The largest error of the nine parameters for readings at 1 g, in m/s^2.
double worst_error(const std::vector<calibrate::Pose>& poses,
                   double noise_dof,
                   const ProcedureResult& twin) {
  const calibrate::MultiPosition fit =
      calibrate::calibrate_positions(
          poses, {.gravity_mps2 = standard_gravity_mps2, .noise_dof = noise_dof})
          .value();
  double worst = 0.0;
  for (const simulate::TruePose& pose : twin.truth.poses) {
    // The true sensor's reading, and the force that the fit computes from it.
    Eigen::Vector3d reading;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto i = static_cast<Eigen::Index>(axis);
      const Eigen::Vector3d& f = pose.force_mps2;
      const Eigen::Index p = (i + 1) % 3, o = (i + 2) % 3;
      reading(i) = sensor::output(twin.truth.equations[axis], {f(i), f(p), f(o)}) +
                   twin.truth.mean_drift_mps2[axis];
    }
    Eigen::Matrix3d T = Eigen::Matrix3d::Identity();
    T(0, 1) = -fit.estimate[6];
    T(0, 2) = fit.estimate[7];
    T(1, 2) = -fit.estimate[8];
    const Eigen::Vector3d bias(fit.estimate.data());
    const Eigen::Vector3d scale(fit.estimate.data() + 3);
    const Eigen::Vector3d force = T * (reading - bias).cwiseQuotient(scale);
    worst = std::max(worst, std::abs(force.norm() - pose.force_mps2.norm()));
  }
  return worst;
}

TEST(Guided, PositionsCalibrateAsWellAsTheWholeRecording) {
  double guided_squares = 0.0, whole_squares = 0.0;
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U, 6U}) {
    const auto options = options_of(Procedure::multi_position, seed, false);
    const ProcedureResult twin = simulate::simulate_procedure(options).value();
    const PoseGuide guide = guided(options, twin, twin.truth.poses.size(), 777);
    std::array<View<double>, 3> axes;
    for (std::size_t c = 0; c < 3; ++c) axes[c] = twin.recording.channels[c].values;
    std::vector<calibrate::Dwell> dwells;
    for (const signal::Rest& rest : signal::find_rests(axes, {.rate_hz = options.rate_hz}).rests)
      dwells.push_back({rest.first, rest.last});
    const calibrate::PoseMeans means = calibrate::pose_means(axes, dwells).value();
    const double by_guide = worst_error(guide.poses(), means.noise_dof, twin);
    const double by_whole = worst_error(means.poses, means.noise_dof, twin);
    guided_squares += by_guide * by_guide;
    whole_squares += by_whole * by_whole;
    EXPECT_LT(by_guide, 1e-3 * standard_gravity_mps2) << seed;
  }
  // Rests of two seconds instead of three and a half.
  EXPECT_LT(std::sqrt(guided_squares), 1.5 * std::sqrt(whole_squares));
}

TEST(Guided, StopsAtTwelvePositionsOfTwentyFive) {
  const auto options = options_of(Procedure::multi_position, 1, false);
  const ProcedureResult twin = simulate::simulate_procedure(options).value();
  const PoseGuide guide = guided(options, twin, 12, 100);
  EXPECT_TRUE(guide.done());
  EXPECT_GE(guide.poses().size(), 12U);
  EXPECT_LE(guide.poses().size(), 14U);
  EXPECT_LT(worst_error(guide.poses(), 50.0, twin), 1.5e-3 * standard_gravity_mps2);
}

}  // namespace
}  // namespace proofmass::guided_test
