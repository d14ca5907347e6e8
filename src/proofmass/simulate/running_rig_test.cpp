#include "proofmass/simulate/running_rig.hpp"

#include <algorithm>
#include <gtest/gtest.h>

#include "proofmass/simulate/rig/perfect_rig.hpp"

namespace proofmass::simulate::running_rig_test {
namespace {

/// All features of a rig combined.
RigOptions everything() {
  RigOptions options;
  options.daq = {.bits = 16, .skew_s = 1e-4};
  options.supply = {.ripple_rms_v = 0.02, .recorded = true};
  options.wheel.profile = {{.duration_s = 2.0, .speed_radps = 3.0, .ramp_s = 1.0},
                           {.duration_s = 1.0, .speed_radps = -2.0, .ramp_s = 1.0}};
  options.wheel.ripple.random_fraction_rms = 0.02;
  options.wheel.shake_vertical_rms_mps2 = 0.2;
  options.sensors[0].bias_walk_mps2_rts = {0.1, 0.0, 0.2};
  options.sensors[1].noise_density_mps2_rthz = {1e-3, 0.0, 2e-3};
  options.sensors[1].filter_signal = true;
  return options;
}

/// In blocks of the given number of scans, the last one shorter.
void run_in_pieces(const RigOptions& options,
                   std::size_t piece,
                   RunningRig::Columns& recorded,
                   RunningRig::Columns& truth) {
  RunningRig rig = RunningRig::start(options).value();
  while (rig.scan() < rig.profile_scans()) {
    const std::uint64_t left = rig.profile_scans() - rig.scan();
    rig.run(std::min<std::uint64_t>(piece, left), recorded, &truth);
  }
}

void expect_same(const Recording& whole, const RunningRig::Columns& pieces) {
  ASSERT_EQ(pieces.size(), whole.channels.size());
  for (std::size_t c = 0; c < pieces.size(); ++c)
    EXPECT_EQ(pieces[c], whole.channels[c].values) << whole.channels[c].name;
}

TEST(RunningRig, InPiecesOfAnySizeIsTheSimulatedRigToTheLastBit) {
  for (const double skew_s : {0.0, 1e-4}) {
    RigOptions options = everything();
    options.daq.skew_s = skew_s;
    const RigResult whole = simulated(options);
    ASSERT_EQ(whole.recording.samples(), 600U);
    for (const std::size_t piece : {1, 7, 64, 599, 600}) {
      RunningRig::Columns recorded, truth;
      run_in_pieces(options, piece, recorded, truth);
      expect_same(whole.recording, recorded);
      expect_same(whole.truth, truth);
    }
  }
}

TEST(RunningRig, ReadsTheSameWhetherOrNotItsTruthIsAskedFor) {
  const RigOptions options = everything();
  RunningRig rig = RunningRig::start(options).value();
  RunningRig::Columns recorded;
  rig.run(rig.profile_scans(), recorded);
  expect_same(simulated(options).recording, recorded);
}

TEST(RunningRig, HasTheChannelsOfTheSimulatedRig) {
  const RigOptions options = everything();
  const RunningRig rig = RunningRig::start(options).value();
  const RigResult whole = simulated(options);
  ASSERT_EQ(rig.recording().channels.size(), 7U);
  for (std::size_t c = 0; c < 7; ++c) {
    EXPECT_EQ(rig.recording().channels[c].name, whole.recording.channels[c].name);
    EXPECT_EQ(rig.recording().channels[c].unit, whole.recording.channels[c].unit);
  }
  EXPECT_EQ(rig.truth().channels.size(), whole.truth.channels.size());
  EXPECT_EQ(rig.recording().samples(), 0U);
  EXPECT_EQ(rig.sensors().size(), 2U);
}

TEST(RunningRig, PastItsProfileKeepsTheLastSpeed) {
  RigOptions options = perfect();
  options.wheel.ripple = {};
  options.wheel.profile = {{.duration_s = 2.0, .speed_radps = 4.0, .ramp_s = 2.0}};
  RunningRig rig = RunningRig::start(options).value();
  RunningRig::Columns recorded, truth;
  rig.run(10 * rig.profile_scans() + 1, recorded, &truth);
  EXPECT_EQ(truth[1].back(), 4.0);
  EXPECT_EQ(truth[2].back(), 0.0);
  EXPECT_NEAR(truth[0].back(), 4.0 + 4.0 * 18.0, 1e-11);
  EXPECT_NEAR(truth[1][200], 2.0, 1e-12);  // half way up
}

TEST(RunningRig, KeepsTheMemoryOfItsColumns) {
  RunningRig rig = RunningRig::start(RigOptions{}).value();
  RunningRig::Columns recorded;
  rig.run(100, recorded);
  const double* const before = recorded[5].data();
  for (std::vector<double>& column : recorded) column.clear();
  rig.run(100, recorded);
  EXPECT_EQ(recorded[5].data(), before);
  EXPECT_EQ(recorded[5].size(), 100U);
}

TEST(RunningRig, SaysWhichOptionIsWrong) {
  RigOptions options;
  options.axes = 1;
  const auto rig = RunningRig::start(options);
  ASSERT_FALSE(rig);
  EXPECT_EQ(rig.error().message, "axes must be 2 or 3");
}

}  // namespace
}  // namespace proofmass::simulate::running_rig_test
