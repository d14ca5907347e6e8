#include "proofmass/estimate/track/pva.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <random>

#include "proofmass/core/statistics.hpp"
#include "proofmass/estimate/track/jerk.hpp"
#include "proofmass/estimate/track_test_support.hpp"

namespace proofmass::estimate::track_pva_test {
namespace {

TrackSolution solved(const TrackSensor& sensor, const TrackOptions& options) {
  auto solution = estimate_track(sensor, options);
  EXPECT_TRUE(solution) << solution.error().message;
  return solution ? std::move(solution).value() : TrackSolution{};
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) most = std::max(most, std::abs(a[k] - b[k]));
  return most;
}

// A second sensor on the same carriage with another level and independent noise.
ParallelAccelerometer beside(const CarriageRecord& motion, double noise_std, std::uint64_t seed) {
  ParallelAccelerometer other{.name = "beside", .accel_mps2 = {}};
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> noise(0.0, noise_std);
  for (std::size_t a = 0; a < 3; ++a)
    for (const double accel : motion.accel_mps2)
      other.accel_mps2[a].push_back((a == 2 ? standard_gravity_mps2 : 0.3) +
                                    (a == 0 ? accel : 0.0) + noise(engine));
  return other;
}

TEST(TrackPva, GoesWhereTheInertialFilterGoes) {
  const CarriageRecord made = record({});
  const TrackSolution inertial = solved(made.sensor, {});
  const TrackSolution pva = solved(made.sensor, {.model = TrackModel::pva});
  EXPECT_EQ(pva.model, TrackModel::pva);
  EXPECT_EQ(pva.rests.size(), inertial.rests.size());
  EXPECT_EQ(pva.closures.size(), inertial.closures.size());
  ASSERT_EQ(pva.strokes.size(), inertial.strokes.size());
  const double std = inertial.smoother->displacement_m.std;
  EXPECT_NEAR(pva.smoother->displacement_m.value, inertial.smoother->displacement_m.value, std);
  EXPECT_NEAR(pva.smoother->displacement_m.std, std, 0.15 * std);
  EXPECT_LT(largest_difference(pva.series.position_m, made.position_m), 0.02);
}

// As at the limit of a range: the acceleration that is missing is the largest of the motion, not
// between the neighbours within what white jerk explains.
TEST(TrackPva, IsAsUncertainAcrossMissingMeasurementsAsTheInertialFilter) {
  CarriageRecord made = record({});
  double largest = 0.0;
  for (const double accel : made.accel_mps2) largest = std::max(largest, std::abs(accel));
  for (std::size_t k = 0; k < made.accel_mps2.size(); ++k)
    if (std::abs(made.accel_mps2[k]) > 0.7 * largest)
      for (auto& axis : made.sensor.accel_mps2) axis[k] = no_value;
  const TrackSolution pva = solved(made.sensor, {.model = TrackModel::pva});
  for (std::size_t k = 0; k < made.position_m.size(); ++k)
    EXPECT_NEAR(pva.series.position_m[k], made.position_m[k],
                4.0 * pva.series.position_std_m[k] + 1e-9)
        << k;
  const double std_m = solved(made.sensor, {}).smoother->displacement_m.std;
  EXPECT_GT(pva.smoother->displacement_m.std, 0.5 * std_m);
  EXPECT_LT(pva.smoother->displacement_m.std, 2.0 * std_m);
}

TEST(TrackPva, FindsTheJerkThatDroveTheMotion) {
  // Acceleration as a random walk of known density in white noise; then rest.
  constexpr double psd = 4.0, h = 0.01;
  std::mt19937_64 engine(5);
  std::normal_distribution<double> normal;
  std::vector<double> time_s, accel;
  double a = 0.0;
  for (int k = 0; k < 6000; ++k) {
    const bool moving = k >= 500 && k < 5500;
    a = moving ? a + std::sqrt(psd * h) * normal(engine) : 0.0;
    time_s.push_back(k * h);
    accel.push_back(a + 0.1 * normal(engine));
  }
  std::vector<PvaSample> samples(time_s.size());
  for (std::size_t k = 0; k < samples.size(); ++k) samples[k].resting = k < 500 || k >= 5500;
  const PvaAxis<1> axis(time_s, {{accel, 0.01, 0.0}}, samples);
  const JerkDensity found = likeliest_jerk(axis, 10.0);
  ASSERT_TRUE(found.determined);
  EXPECT_NEAR(found.psd_m2ps5, psd, 3.0 * found.std_m2ps5);
  EXPECT_LT(found.std_m2ps5, 0.1 * psd);
}

TEST(TrackPva, DoesNotEstimateTheJerkWithoutMotion) {
  std::vector<double> time_s, accel;
  for (int k = 0; k < 100; ++k) time_s.push_back(0.01 * k), accel.push_back(0.0);
  const std::vector<PvaSample> samples(100, {.resting = true});
  EXPECT_FALSE(likeliest_jerk(PvaAxis<1>(time_s, {{accel, 0.01, 0.0}}, samples), 10.0).determined);
}

TEST(TrackPva, TakesTheJerkThatIsGiven) {
  const CarriageRecord made = record({});
  const TrackSolution pva = solved(made.sensor, {.model = TrackModel::pva, .jerk_psd_m2ps5 = 33.0});
  EXPECT_EQ(pva.jerk_psd_m2ps5->value, 33.0);
  EXPECT_EQ(pva.jerk_psd_m2ps5->std, 0.0);
  EXPECT_FALSE(estimate_track(made.sensor, {.model = TrackModel::pva, .jerk_psd_m2ps5 = 0.0}));
}

TEST(TrackPva, TakesFixesAndTheSamePlace) {
  const CarriageRecord made = record({});
  const TrackSolution back =
      solved(made.sensor, {.model = TrackModel::pva, .same_place = true, .same_place_std_m = 1e-4});
  EXPECT_LT(std::abs(back.smoother->displacement_m.value), 3e-4);
  EXPECT_LT(back.smoother->displacement_m.std, 1.01e-4);
  const TrackSolution fixed = solved(made.sensor, {.model = TrackModel::pva,
                                                   .axis = {{1.0, 0.0, 0.0}},
                                                   .fixes = {{4.0, 0.4, 1e-3}, {4.0, 0.4, 1e-3}},
                                                   .scale_std = 0.0});
  EXPECT_LT(fixed.series.position_std_m[400], 2e-3);
  EXPECT_NEAR(fixed.series.position_m[400], 0.4, 3e-3);
}

TEST(TrackPva, OutlivesMissingReadingsAndReadingsWithoutNoise) {
  CarriageRecord made = record({});
  for (std::size_t k = 260; k < 266; ++k) made.sensor.accel_mps2[0][k] = std::nan("");
  const TrackSolution gap = solved(made.sensor, {.model = TrackModel::pva});
  EXPECT_LT(largest_difference(gap.series.position_m, made.position_m), 0.03);
  const CarriageRecord exact = record({.noise_std_mps2 = 0.0});
  const TrackSolution pva = solved(exact.sensor, {.model = TrackModel::pva});
  EXPECT_LT(largest_difference(pva.series.position_m, exact.position_m), 1e-3);
  for (const double std : pva.series.position_std_m) EXPECT_TRUE(std::isfinite(std));
}

TEST(TrackPva, ForgetsTheBiasInTheTimeOfTheWarmUp) {
  const CarriageRecord made = record({});
  TrackOptions options{.model = TrackModel::pva, .jerk_psd_m2ps5 = 100.0};
  const TrackSolution walks = solved(made.sensor, options);
  options.warm_up_time_s = {1e9, std::nullopt, std::nullopt};
  const TrackSolution settles = solved(made.sensor, options);
  EXPECT_LT(largest_difference(walks.series.position_m, settles.series.position_m), 1e-6);
  options.warm_up_time_s = {5.0, std::nullopt, std::nullopt};
  EXPECT_GT(
      largest_difference(walks.series.position_m, solved(made.sensor, options).series.position_m),
      1e-6);
}

TEST(TrackFused, TwoSensorsHalveTheVarianceAndListTheResultOfEach) {
  CarriageRecord made = record({.noise_std_mps2 = 0.05});
  made.sensor.beside = {beside(made, 0.05, 9)};
  const TrackSolution fused = solved(
      made.sensor, {.model = TrackModel::fused, .axis = {{1.0, 0.0, 0.0}}, .scale_std = 0.0});
  ASSERT_TRUE(fused.fused);
  ASSERT_EQ(fused.fused->sensors.size(), 2U);
  EXPECT_GT(fused.fused->variance_gain, 1.1);
  EXPECT_LT(fused.fused->variance_gain, 2.2);
  EXPECT_NEAR(fused.fused->sensors[0].bias_mps2.value, 0.1, 0.03);
  EXPECT_NEAR(fused.fused->sensors[1].bias_mps2.value, 0.3, 0.03);
  for (const FusedSensor& one : fused.fused->sensors)
    EXPECT_GT(one.displacement_m.std, fused.smoother->displacement_m.std);
  const TrackSolution alone =
      solved(made.sensor, {.model = TrackModel::pva, .axis = {{1.0, 0.0, 0.0}}, .scale_std = 0.0});
  EXPECT_DOUBLE_EQ(fused.fused->sensors[0].displacement_m.value,
                   alone.smoother->displacement_m.value);
}

TEST(TrackFused, ADeadSecondSensorCostsOnlyItself) {
  CarriageRecord made = record({});
  made.sensor.beside = {beside(made, 0.02, 9)};
  for (auto& axis : made.sensor.beside[0].accel_mps2)
    std::fill(axis.begin() + 150, axis.end(), std::nan(""));
  const TrackSolution fused =
      solved(made.sensor, {.model = TrackModel::fused, .axis = {{1.0, 0.0, 0.0}}});
  const TrackSolution alone =
      solved(made.sensor, {.model = TrackModel::pva, .axis = {{1.0, 0.0, 0.0}}});
  EXPECT_NEAR(fused.smoother->displacement_m.value, alone.smoother->displacement_m.value, 1e-3);
}

TEST(TrackFused, RefusesASensorThatIsNotParallel) {
  CarriageRecord made = record({});
  const TrackOptions options{.model = TrackModel::fused, .axis = {{1.0, 0.0, 0.0}}};
  EXPECT_EQ(estimate_track(made.sensor, options).error().code, Errc::invalid_argument);
  made.sensor.beside = {beside(made, 0.02, 9)};
  for (double& x : made.sensor.beside[0].accel_mps2[0]) x = -x;
  EXPECT_NE(estimate_track(made.sensor, options).error().message.find("parallel"),
            std::string::npos);
  // Rotated by 30° about z it measures 0.87 times as much along x, as if its scale differed.
  made.sensor.beside[0] = beside(made, 0.02, 9);
  auto& turned = made.sensor.beside[0].accel_mps2;
  for (std::size_t k = 0; k < turned[0].size(); ++k) {
    const double x = turned[0][k], y = turned[1][k];
    turned[0][k] = std::cos(0.5236) * x - std::sin(0.5236) * y;
    turned[1][k] = std::sin(0.5236) * x + std::cos(0.5236) * y;
  }
  EXPECT_NE(estimate_track(made.sensor, options).error().message.find("turned by 30 deg"),
            std::string::npos);
  made.sensor.beside[0].accel_mps2[0].clear();
  const auto without_axis = estimate_track(made.sensor, options);
  EXPECT_NE(without_axis.error().message.find("no axis along the motion"), std::string::npos);
  ASSERT_EQ(without_axis.error().advice.size(), 1u);
  EXPECT_EQ(without_axis.error().advice[0].option, "axis");
  made.sensor.beside[0].accel_mps2[0] = {1.0, 2.0};
  EXPECT_FALSE(estimate_track(made.sensor, options));
  made.sensor.beside.assign(4, beside(made, 0.02, 9));
  EXPECT_FALSE(estimate_track(made.sensor, options));
}

}  // namespace
}  // namespace proofmass::estimate::track_pva_test
