#include "proofmass/calibrate/pose_guide.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include "proofmass/calibrate/guide/fit.hpp"
#include "proofmass/calibrate/guide/turned_axes.hpp"
#include "proofmass/calibrate/multi_position.hpp"
#include "proofmass/core/random.hpp"
#include "proofmass/core/units.hpp"

namespace proofmass::calibrate::pose_guide_test {
namespace {

using Eigen::Vector3d;
using signal::RestPhase;

constexpr double g = standard_gravity_mps2;
constexpr double rate_hz = 50.0;

/// A sensor that is placed in one position after the other, observed by the guide.
class Bench {
 public:
  explicit Bench(const GuideOptions& options, double noise = 0.01)
      : guide(options), noise_(noise), random_(1, "bench") {}

  Bench& reads(const Vector3d& bias, const Vector3d& scale) {
    bias_ = bias;
    scale_ = scale;
    return *this;
  }
  void rest(const Vector3d& up, double seconds) {
    up_ = up.normalized();
    for (int k = 0; k < static_cast<int>(seconds * rate_hz); ++k) add(up_);
  }
  void move_to(const Vector3d& up) {
    const Vector3d from = up_;
    constexpr int moved = 60;
    for (int k = 1; k <= moved; ++k) {
      const double done = static_cast<double>(k) / moved;
      const Vector3d shake = 0.3 * std::sin(0.9 * k) * Vector3d(1.0, -0.5, 0.7);
      add(((1.0 - done) * from + done * up.normalized()).eval() + shake);
    }
    up_ = up.normalized();
  }
  void shock() {
    for (int k = 0; k < 15; ++k) add(up_ + 0.2 * std::sin(1.3 * k) * Vector3d(1.0, 1.0, -1.0));
  }
  [[nodiscard]] std::size_t count(GuideKind kind) const {
    return static_cast<std::size_t>(
        std::ranges::count_if(steps, [&](const GuideStep& s) { return s.kind == kind; }));
  }
  [[nodiscard]] const GuideStep* last(GuideKind kind) const {
    const GuideStep* found = nullptr;
    for (const GuideStep& step : steps)
      if (step.kind == kind) found = &step;
    return found;
  }

  PoseGuide guide;
  std::vector<GuideStep> steps;
  std::array<std::vector<double>, 3> samples;

 private:
  void add(const Vector3d& force_g) {
    std::array<double, 3> row{};
    for (std::size_t a = 0; a < 3; ++a) {
      const auto i = static_cast<Eigen::Index>(a);
      row[a] = bias_(i) + scale_(i) * (g * force_g(i) + noise_ * random_.normal());
      samples[a].push_back(row[a]);
    }
    const Block block{
        samples[0].size() - 1,
        {View<double>(&row[0], 1), View<double>(&row[1], 1), View<double>(&row[2], 1)}};
    for (GuideStep& step : guide.add(block)) steps.push_back(std::move(step));
  }

  double noise_;
  Random random_;
  Vector3d bias_ = Vector3d::Zero(), scale_ = Vector3d::Ones(), up_ = Vector3d::UnitZ();
};

GuideOptions options_of(GuideProcedure procedure) {
  return {.procedure = procedure, .channels = {0, 1, 2}, .rate_hz = rate_hz, .one_g = g};
}

// The direction that a prompt asks for, parsed from its text.
Vector3d asked_for(const std::string& text) {
  Vector3d up = Vector3d::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    const std::string name(1, "xyz"[axis]);
    if (text.find("+" + name) != std::string::npos) up(axis) = 1.0;
    if (text.find("−" + name) != std::string::npos) up(axis) = -1.0;
  }
  return up.normalized();
}

void obey(Bench& bench, double rest_s = 4.0) {
  bench.rest(Vector3d::UnitZ(), 4.0);
  for (int k = 0; k < 60 && !bench.guide.done(); ++k) {
    const Vector3d up = asked_for(bench.last(GuideKind::prompt)->text);
    ASSERT_GT(up.norm(), 0.5) << bench.last(GuideKind::prompt)->text;
    bench.move_to(up + 0.05 * Vector3d(std::sin(k), std::cos(2.0 * k), std::sin(3.0 * k)));
    bench.rest(up + 0.05 * Vector3d(std::sin(k), std::cos(2.0 * k), std::sin(3.0 * k)), rest_s);
  }
}

class PoseGuideInUnits : public testing::TestWithParam<bool> {};

TEST_P(PoseGuideInUnits, LeadsToACalibrationInTwelvePositions) {
  const bool volts = GetParam();
  GuideOptions options = options_of(GuideProcedure::multi_position);
  if (volts) options.one_g.reset();
  Bench bench(options);
  const Vector3d bias = volts ? Vector3d(1.62, 1.68, 1.65) : Vector3d(0.2, -0.3, 0.1);
  const Vector3d scale = volts ? Vector3d(0.0333, 0.0341, 0.0328) : Vector3d(1.01, 0.98, 1.005);
  bench.reads(bias, scale);
  obey(bench);
  ASSERT_TRUE(bench.guide.done());
  EXPECT_EQ(bench.guide.poses().size(), 12U);
  EXPECT_EQ(bench.count(GuideKind::captured), 12U);
  EXPECT_EQ(bench.count(GuideKind::redo), 0U);
  EXPECT_EQ(bench.steps.back().kind, GuideKind::done);
  const MultiPosition fit =
      calibrate_positions(bench.guide.poses(), {.gravity_mps2 = g, .noise_dof = 100.0}).value();
  ASSERT_TRUE(fit.misalignment_rad[0]);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<Eigen::Index>(axis);
    EXPECT_NEAR(fit.bias[axis]->value, bias(i), 4.0 * fit.bias[axis]->std);
    EXPECT_NEAR(fit.scale[axis]->value, scale(i), 4.0 * fit.scale[axis]->std);
    EXPECT_LT(fit.bias[axis]->std / (g * scale(i)), 1e-3);
    EXPECT_LT(fit.scale[axis]->std / scale(i), 1e-3);
  }
}

INSTANTIATE_TEST_SUITE_P(Units, PoseGuideInUnits, testing::Bool());

TEST(PoseGuide, AsksForNoPositionTwice) {
  Bench bench(options_of(GuideProcedure::multi_position));
  obey(bench);
  std::vector<Vector3d> asked;
  for (const GuideStep& step : bench.steps)
    if (step.kind == GuideKind::prompt) asked.push_back(asked_for(step.text));
  ASSERT_EQ(asked.size(), 12U);
  for (std::size_t k = 0; k < asked.size(); ++k)
    for (std::size_t j = 0; j < k; ++j) EXPECT_LT(asked[k].dot(asked[j]), 0.95) << j << " " << k;
}

TEST(PoseGuide, GoesOnUntilNoPositionIsOver) {
  GuideOptions options = options_of(GuideProcedure::multi_position);
  options.target_std_g = 1e-5;
  options.longest_rest_s = 2.0;
  Bench bench(options);
  obey(bench);
  ASSERT_TRUE(bench.guide.done());
  EXPECT_GE(bench.guide.poses().size(), 20U);
  EXPECT_NE(bench.last(GuideKind::prompt)->text.find("the target is 0.01 mg"), std::string::npos)
      << bench.last(GuideKind::prompt)->text;
}

TEST(PoseGuide, RecognisesARepeatedPosition) {
  for (const bool volts : {false, true}) {
    GuideOptions options = options_of(GuideProcedure::multi_position);
    if (volts) options.one_g.reset();
    Bench bench(options);
    bench.reads(Vector3d::Constant(1.65), Vector3d::Constant(0.033));
    if (!volts) bench.reads(Vector3d::Zero(), Vector3d::Ones());
    bench.rest({0.0, 0.0, 1.0}, 6.0);
    bench.move_to({0.0, 0.0, -1.0});
    bench.rest({0.0, 0.0, -1.0}, 4.0);
    bench.move_to({0.0, 0.05, 1.0});
    bench.rest({0.0, 0.05, 1.0}, 4.0);
    EXPECT_EQ(bench.guide.poses().size(), 2U);
    ASSERT_EQ(bench.count(GuideKind::redo), 1U);
    EXPECT_NE(bench.last(GuideKind::redo)->text.find("pose 1 again"), std::string::npos);
  }
}

TEST(PoseGuide, RepeatsThePositionThatContradictsTheOthers) {
  GuideOptions options = options_of(GuideProcedure::multi_position);
  options.target_std_g = 1e-5;  // not reached
  Bench bench(options);
  bench.rest(Vector3d::UnitZ(), 4.0);
  constexpr std::size_t bad = 6;
  Vector3d bad_up = Vector3d::Zero();
  for (int k = 0; k < 40 && bench.guide.poses().size() < 13; ++k) {
    const Vector3d up = asked_for(bench.last(GuideKind::prompt)->text);
    const bool is_bad = bench.guide.poses().size() + 1 == bad;
    bench.reads(is_bad ? Vector3d::Constant(0.3) : Vector3d::Zero(), Vector3d::Ones());
    if (is_bad) bad_up = up;
    bench.move_to(up);
    bench.rest(up, 22.0);
  }
  ASSERT_TRUE(bench.guide.picture().poses[bad - 1].suspect);
  EXPECT_TRUE(bench.guide.live().can_repeat);
  const std::vector<GuideStep> asked = bench.guide.repeat();
  ASSERT_EQ(asked.size(), 1U);
  EXPECT_NE(asked[0].text.find("place it as for pose 6 again"), std::string::npos) << asked[0].text;
  EXPECT_GT(bench.guide.picture().next->dot(bad_up), 0.99);
  EXPECT_FALSE(bench.guide.picture().next_gain);
  bench.move_to(bad_up);
  bench.rest(bad_up, 22.0);
  ASSERT_EQ(bench.guide.poses().size(), 14U);
  const GuidePicture after = bench.guide.picture();
  EXPECT_TRUE(after.poses[bad - 1].suspect);
  EXPECT_FALSE(after.poses[13].suspect);
  EXPECT_TRUE(after.next_gain);
  // Without a request, the same position once more is refused.
  bench.move_to(Vector3d(1.0, 0.2, 0.4));
  bench.move_to(bad_up);
  bench.rest(bad_up, 22.0);
  EXPECT_EQ(bench.guide.poses().size(), 14U);
}

TEST(PoseGuide, RepeatsNothingWhereNothingContradicts) {
  Bench bench(options_of(GuideProcedure::multi_position));
  bench.rest(Vector3d::UnitZ(), 6.0);
  EXPECT_FALSE(bench.guide.live().can_repeat);
  const std::vector<GuideStep> said = bench.guide.repeat();
  ASSERT_EQ(said.size(), 1U);
  EXPECT_EQ(said[0].text, "No position contradicts the others.");
}

// The scatter of |f| over many fits, in four directions, against what the maps say of one of them.
TEST(GuideFit, MapsShowTheScatterOfAMeasurementOf1G) {
  constexpr double noise_g = 1e-3;
  constexpr int fits = 400;
  const Vector3d bias(0.02, -0.01, 0.03), scale(1.01, 0.98, 1.0);
  const auto output = [&](const Vector3d& up) -> Vector3d { return bias + scale.cwiseProduct(up); };
  const std::vector<Vector3d> ups{{0, 0, 1},  {0, 0, -1}, {1, 0, 0}, {-1, 0, 0}, {0, 1, 0},
                                  {0, -1, 0}, {1, 1, 0},  {1, 0, 1}, {0, 1, 1},  {-1, 1, 0},
                                  {1, 0, -1}, {0, -1, 1}, {1, 1, 1}};
  constexpr auto middle = GuideMaps::size / 2;
  const std::array<Vector3d, 4> places{
      {{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, Vector3d(-1, -1, 0).normalized()}};
  std::array<double, 4> squares{};
  std::optional<GuideMaps> maps;
  Random random(7, "fits");
  for (int k = 0; k < fits; ++k) {
    std::vector<Pose> poses;
    for (const Vector3d& up : ups) {
      Pose pose;
      pose.mean = output(up.normalized());
      for (Eigen::Index a = 0; a < 3; ++a) pose.mean(a) += noise_g * random.normal();
      pose.mean_covariance = noise_g * noise_g * Eigen::Matrix3d::Identity();
      pose.samples = 100;
      poses.push_back(pose);
    }
    const std::optional<GuideFit> fit = GuideFit::of(poses, 1e6);
    ASSERT_TRUE(fit && fit->has_nine());
    if (!maps) maps = fit->maps();
    for (std::size_t p = 0; p < places.size(); ++p)
      squares[p] += std::pow(fit->reader().force(output(places[p])).norm() - 1.0, 2);
  }
  // r = 1 is the equator: u = 1 is +x on the map of +z; (−1, −1)/√2 lies between two columns.
  const auto std_at = [&](std::size_t p) {
    if (p == 0) return maps->plus_z_g(middle, middle);
    if (p == 1) return maps->minus_z_g(middle, middle);
    if (p == 2) return maps->plus_z_g(middle, GuideMaps::size - 1);
    const double at = middle * (1.0 - std::sqrt(0.5));
    const auto low = static_cast<Eigen::Index>(at);
    const double part = at - static_cast<double>(low);
    return (1.0 - part) * maps->plus_z_g(low, low) + part * maps->plus_z_g(low + 1, low + 1);
  };
  for (std::size_t p = 0; p < places.size(); ++p) {
    const double scatter = std::sqrt(squares[p] / fits);
    EXPECT_NEAR(std_at(p) / scatter, 1.0, 0.15) << p << ": " << scatter;
  }
  EXPECT_NEAR(maps->plus_z_g(middle, 0), maps->minus_z_g(middle, GuideMaps::size - 1), 1e-12);
}

TEST(PoseGuide, IgnoresADisturbanceThatLeavesThePositionUnchanged) {
  Bench bench(options_of(GuideProcedure::multi_position));
  bench.rest({0.0, 0.0, 1.0}, 6.0);
  bench.shock();
  bench.rest({0.0, 0.0, 1.0}, 4.0);
  EXPECT_EQ(bench.guide.poses().size(), 1U);
  EXPECT_EQ(bench.count(GuideKind::redo), 0U);
  EXPECT_NE(bench.guide.live().words.find("from the next position"), std::string::npos);
}

TEST(PoseGuide, RestartsARestThatEndsTooEarly) {
  Bench bench(options_of(GuideProcedure::multi_position));
  bench.rest({0.0, 0.0, 1.0}, 6.0);
  bench.move_to({0.0, 0.0, -1.0});
  bench.rest({0.0, 0.0, -1.0}, 2.0);
  EXPECT_EQ(bench.guide.live().phase, RestPhase::resting);
  ASSERT_TRUE(bench.guide.live().seconds_left);
  EXPECT_GT(*bench.guide.live().seconds_left, 0.0);
  bench.shock();
  bench.rest({0.0, 0.0, -1.0}, 4.0);
  ASSERT_EQ(bench.count(GuideKind::redo), 1U);
  EXPECT_NE(bench.last(GuideKind::redo)->text.find("It moved after"), std::string::npos);
  ASSERT_EQ(bench.guide.poses().size(), 2U);
  EXPECT_GE(*bench.guide.poses()[1].end_s - *bench.guide.poses()[1].start_s, 2.0);
  EXPECT_GE(*bench.guide.poses()[1].start_s, 9.5);  // after the shock
}

TEST(PoseGuide, SaysTheSameHoweverTheSamplesAreCut) {
  Bench bench(options_of(GuideProcedure::multi_position));
  obey(bench);
  for (const std::size_t cut : {std::size_t{7}, std::size_t{1000}, bench.samples[0].size()}) {
    PoseGuide guide(options_of(GuideProcedure::multi_position));
    std::vector<GuideStep> steps;
    for (std::size_t first = 0; first < bench.samples[0].size(); first += cut) {
      Block block{first, {}};
      for (const std::vector<double>& axis : bench.samples)
        block.channels.push_back(
            View<double>(axis).subspan(first, std::min(cut, axis.size() - first)));
      for (GuideStep& step : guide.add(block)) steps.push_back(std::move(step));
    }
    ASSERT_EQ(steps.size(), bench.steps.size()) << cut;
    for (std::size_t k = 0; k < steps.size(); ++k) {
      EXPECT_EQ(steps[k].text, bench.steps[k].text);
      EXPECT_EQ(steps[k].time_s, bench.steps[k].time_s);
    }
  }
}

TEST(PoseGuide, RestsLongerWhereThereIsMoreNoise) {
  // Averaging white noise of σ per sample to half the target takes 4 σ²/(target² rate).
  GuideOptions options = options_of(GuideProcedure::multi_position);
  Bench bench(options, 0.1);
  bench.rest({0.0, 0.0, 1.0}, 25.0);
  ASSERT_EQ(bench.guide.poses().size(), 1U);
  const Pose& pose = bench.guide.poses()[0];
  const double expected_s = 4.0 * 0.01 / (1e-6 * g * g * rate_hz);
  EXPECT_NEAR(*pose.end_s - *pose.start_s, expected_s, 0.4 * expected_s);
  Bench endless(options, 1.0);
  endless.rest({0.0, 0.0, 1.0}, 25.0);
  ASSERT_EQ(endless.guide.poses().size(), 1U);
  const Pose& longest = endless.guide.poses()[0];
  EXPECT_NEAR(*longest.end_s - *longest.start_s, 20.0, 0.2);
}

TEST(PoseGuide, LeavesOutWhatIsSkipped) {
  Bench bench(options_of(GuideProcedure::multi_position));
  bench.rest({0.0, 0.0, 1.0}, 6.0);
  const std::string before = bench.last(GuideKind::prompt)->text;
  const std::vector<GuideStep> steps = bench.guide.skip();
  ASSERT_EQ(steps.size(), 1U);
  EXPECT_NE(asked_for(steps[0].text), asked_for(before));
}

Vector3d on_table(double angle_deg) {
  return {std::sin(angle_deg * rad_per_deg), std::cos(angle_deg * rad_per_deg), 0.02};
}

void turn(Bench& bench, double angle_deg, double seconds = 4.0) {
  if (!bench.steps.empty()) bench.move_to(on_table(angle_deg));
  bench.rest(on_table(angle_deg), seconds);
}

TEST(PoseGuide, GoesRoundATableAndClosesTheTurn) {
  for (const bool volts : {false, true}) {
    GuideOptions options = options_of(GuideProcedure::tumble);
    if (volts) options.one_g.reset();
    Bench bench(options);
    if (volts) bench.reads({1.62, 1.68, 1.65}, {0.0333, 0.0341, 0.0328});
    for (int k = 0; k <= 12; ++k) turn(bench, 30.0 * k, k == 0 ? 6.0 : 4.0);
    ASSERT_TRUE(bench.guide.done()) << volts;
    const std::vector<double> angles = bench.guide.angles_deg();
    ASSERT_EQ(angles.size(), 13U);
    for (int k = 0; k <= 12; ++k) EXPECT_EQ(angles[static_cast<std::size_t>(k)], 30.0 * k);
    EXPECT_EQ(bench.count(GuideKind::redo), 0U);
    EXPECT_NE(bench.last(GuideKind::prompt)->text.find("0° once more"), std::string::npos);
  }
}

TEST(PoseGuide, SaysHowFarATableIsOff) {
  Bench bench(options_of(GuideProcedure::tumble));
  bench.reads({0.2, -0.1, 0.1}, {1.01, 0.99, 1.0});
  for (int k = 0; k <= 4; ++k) turn(bench, 30.0 * k, k == 0 ? 6.0 : 4.0);
  turn(bench, 141.0);
  ASSERT_EQ(bench.count(GuideKind::redo), 1U);
  EXPECT_NE(bench.last(GuideKind::redo)->text.find("turn it on by 9."), std::string::npos)
      << bench.last(GuideKind::redo)->text;
  EXPECT_NE(bench.guide.live().words.find("to go to 150°"), std::string::npos);
  turn(bench, 150.0);
  EXPECT_EQ(bench.guide.angles_deg().size(), 6U);
}

TEST(PoseGuide, CountsTheRestsOfOneAxisOnATable) {
  GuideOptions options = options_of(GuideProcedure::tumble);
  options.channels = {0};
  options.positions = 4;
  Bench bench(options);
  turn(bench, 0.0, 6.0);
  bench.shock();
  bench.rest(on_table(0.0), 4.0);
  EXPECT_EQ(bench.guide.poses().size(), 1U);
  for (int k = 1; k <= 4; ++k) turn(bench, 90.0 * k);
  EXPECT_TRUE(bench.guide.done());
  EXPECT_EQ(bench.guide.poses().size(), 5U);
}

TEST(PoseGuide, RestartsTheTimeIfAStaticSensorIsMoved) {
  GuideOptions options = options_of(GuideProcedure::still);
  options.still_s = 30.0;
  Bench bench(options);
  bench.rest({0.0, 0.0, 1.0}, 20.0);
  bench.shock();
  bench.rest({0.0, 0.0, 1.0}, 29.0);
  EXPECT_FALSE(bench.guide.done());
  EXPECT_EQ(bench.count(GuideKind::redo), 1U);
  bench.rest({0.0, 0.0, 1.0}, 3.0);
  ASSERT_TRUE(bench.guide.done());
  EXPECT_GT(*bench.guide.poses()[0].start_s, 20.0);
}

TEST(PoseGuide, SitsStillUntilTheFloorOfTheNoiseShows) {
  // A level with random steps every 2 s has a noise floor; white noise does not.
  for (const bool drifts : {false, true}) {
    PoseGuide guide(options_of(GuideProcedure::still));
    Random random(3, "floor");
    double level = 0.0;
    std::size_t k = 0;
    for (; k < static_cast<std::size_t>(1000.0 * rate_hz) && !guide.done(); ++k) {
      level = drifts ? level + 0.005 * (0.01 * random.normal() - 0.01 * level) : 0.0;
      const double x = 0.01 * random.normal() + 50.0 * level;
      const View<double> one(&x, 1);
      (void)guide.add({k, {one, one, one}});
    }
    EXPECT_EQ(guide.done(), drifts);
    EXPECT_GE(static_cast<double>(k) / rate_hz, 300.0);
  }
}

TEST(PoseGuide, WaitsWhereNothingIsMeasured) {
  PoseGuide guide(options_of(GuideProcedure::multi_position));
  const std::vector<double> nothing(2000, std::numeric_limits<double>::quiet_NaN());
  const std::vector<GuideStep> steps = guide.add({0, {nothing, nothing, nothing}});
  EXPECT_EQ(steps.size(), 1U);
  EXPECT_TRUE(guide.poses().empty());
  EXPECT_EQ(guide.live().phase, RestPhase::listening);
}

TEST(TurnedAxes, DetermineTheAngleOfAnySensorAfterAQuarterTurn) {
  const Vector3d c(1.62, 1.68, 1.65), a(0.33, 0.01, 0.02), b(-0.01, 0.32, 0.01);
  const auto reading = [&](double angle) {
    return Vector3d(c + std::sin(angle) * a + std::cos(angle) * b);
  };
  TurnedAxes axes(3, std::nullopt);
  for (int k = 0; k < 4; ++k) {
    EXPECT_FALSE(axes.angle_rad(reading(0.3))) << k;
    axes.add(30.0 * k * rad_per_deg, reading(30.0 * k * rad_per_deg));
  }
  for (const double angle : {-2.0, -0.3, 0.4, 2.9})
    EXPECT_NEAR(*axes.angle_rad(reading(angle)), angle, 1e-6);
  EXPECT_NEAR(*axes.one_g(), std::hypot(0.33, 0.01), 1e-6);
}

}  // namespace
}  // namespace proofmass::calibrate::pose_guide_test
