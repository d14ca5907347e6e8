#include "proofmass/thesis/wheel_runs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <set>
#include <string>

#include "proofmass/core/units.hpp"
#include "proofmass/thesis/wheel/first_turn.hpp"
#include "proofmass/thesis/wheel/rig.hpp"
#include "proofmass/thesis/wheel/run_errors.hpp"

namespace proofmass::thesis::wheel_runs_test {
namespace {

constexpr double g = standard_gravity_mps2;

/// A simulated run in the form of a user's recording: no truth, no knowledge of the sensors.
WheelRecord as_own(WheelRecord record, std::size_t sensors) {
  record.simulated = false;
  record.source = "mine.csv";
  record.sensors.resize(sensors);
  record.bias.clear();
  record.true_angle_rad.clear();
  record.true_speed_radps.clear();
  record.true_accel_radps2.clear();
  return record;
}

void expect_complete(const std::vector<Item>& items) {
  const std::set<std::string> wanted{"figure 5.12", "figure 5.13", "figure 5.14", "figure 5.15",
                                     "figure 5.16", "figure 5.17", "figure 5.18", "figure 5.19",
                                     "section 6.1", "table A.1"};
  std::set<std::string> found;
  for (const Item& item : items) {
    found.insert(item.id);
    EXPECT_FALSE(item.thesis.empty() || item.ours.empty() || item.note.empty()) << item.id;
    std::set<std::string> keys;
    for (const Finding& finding : item.findings) {
      EXPECT_TRUE(keys.insert(finding.key).second) << item.id << " " << finding.key;
      EXPECT_NE(finding.ours.has_value(), !finding.reason.empty()) << item.id << " " << finding.key;
      const Uncertain ours = finding.ours.value_or(Uncertain{});
      EXPECT_TRUE(std::isfinite(ours.value) && std::isfinite(ours.std))
          << item.id << " " << finding.key;
    }
    for (const report::Figure& figure : item.figures)
      EXPECT_FALSE(figure.curves.empty()) << figure.title;
  }
  EXPECT_EQ(found, wanted);
}

const Finding& finding(const std::vector<Item>& items, const char* id, const char* key) {
  const auto item = std::ranges::find(items, id, &Item::id);
  return *std::ranges::find(item->findings, key, &Finding::key);
}

TEST(WheelItems, AreCompleteAndTheSameForOneSeed) {
  const WheelRunsOptions options{.seed = 2, .seeds = 2, .gravity_mps2 = g};
  const std::vector<Item> items = wheel_items({}, options).value();
  expect_complete(items);
  const std::vector<Item> again = wheel_items({}, options).value();
  for (std::size_t i = 0; i < items.size(); ++i) {
    EXPECT_EQ(items[i].ours, again[i].ours);
    for (std::size_t k = 0; k < items[i].findings.size(); ++k)
      EXPECT_EQ(items[i].findings[k].ours.value_or(Uncertain{}).value,
                again[i].findings[k].ours.value_or(Uncertain{}).value);
  }
}

TEST(WheelItems, OfARecordingMeasureItsSpeedAndCountFromTheSmoother) {
  const WheelRecord record = simulate_wheel({.seed = 4, .turns = 1.6}).value();
  const std::vector<Item> items = wheel_items({as_own(record, 2)}, {.gravity_mps2 = g}).value();
  expect_complete(items);
  EXPECT_NEAR(finding(items, "table A.1", "speed_1").ours->value, 11.0 * radps_per_rpm, 0.003);
  EXPECT_TRUE(finding(items, "figure 5.13", "filtered").ours);
  EXPECT_FALSE(finding(items, "figure 5.13", "wheel_smoothed").ours);
  EXPECT_GT(finding(items, "figure 5.13", "gravity_integrated").ours->value, 1.0);
}

TEST(WheelItems, OfOneSensorSayWhatTakesTwo) {
  const WheelRecord record = simulate_wheel({.seed = 4}).value();
  const std::vector<Item> items = wheel_items({as_own(record, 1)}, {.gravity_mps2 = g}).value();
  expect_complete(items);
  EXPECT_NE(finding(items, "figure 5.13", "filtered").reason.find("two opposite"),
            std::string::npos);
  EXPECT_TRUE(finding(items, "figure 5.13", "gravity_filtered").ours);
}

TEST(WheelItems, SayThatNoRadiusMeansNoPath) {
  WheelRecord record = as_own(simulate_wheel({.seed = 4}).value(), 2);
  record.radius_m.reset();
  const std::vector<Item> items = wheel_items({record}, {.gravity_mps2 = g}).value();
  expect_complete(items);
  EXPECT_FALSE(finding(items, "figure 5.13", "filtered").reason.empty());
}

TEST(WheelItems, NameTheRecordingThatIsNone) {
  WheelRecord record;
  record.source = "flat.csv";
  record.sensors.push_back({.name = "acc", .time_s = {0.0, 0.1}, .accel_mps2 = {}});
  for (auto& axis : record.sensors[0].accel_mps2) axis = {0.0, 0.0};
  const auto items = wheel_items({record}, {.gravity_mps2 = g});
  ASSERT_FALSE(items);
  EXPECT_NE(items.error().message.find("flat.csv"), std::string::npos) << items.error().message;
}

TEST(SimulatedWheel, StartsAtRestAndTurnsOnce) {
  const WheelRecord record = simulate_wheel({.speed_radps = 21.0 * radps_per_rpm}).value();
  EXPECT_EQ(record.true_speed_radps.front(), 0.0);
  EXPECT_GE(record.true_angle_rad.back() - record.true_angle_rad.front(), 0.99 * rad_per_turn);
}

/// 40 runs with or without datasheet errors.
std::vector<RunErrors> forty_runs(bool datasheet_errors) {
  std::vector<RunErrors> runs;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const RigRun run{.seed = seed, .turns = 1.25, .datasheet_errors = datasheet_errors};
    const WheelRecord record = simulate_wheel(run).value();
    runs.push_back(run_errors(first_turn(run, record), Detail::tangential).value());
  }
  return runs;
}

std::size_t inside(const std::vector<RunErrors>& runs,
                   std::optional<PathError> RunErrors::* which) {
  return static_cast<std::size_t>(std::ranges::count_if(runs, [&](const RunErrors& run) {
    return std::abs((run.*which)->end) <= 1.96 * (run.*which)->end_std;
  }));
}

TEST(WheelModel, HoldsAFewHundredthsOfAMillimetreOverOneTurn) {
  const std::vector<RunErrors> runs = forty_runs(false);
  const auto end = [](const RunErrors& run) { return std::optional(run.wheel_smoothed->end); };
  EXPECT_LT(rms_over(runs, end)->value, 0.1e-3);
  EXPECT_GE(inside(runs, &RunErrors::wheel_smoothed), 36U);
  EXPECT_GE(inside(runs, &RunErrors::wheel_moved), 36U);
  // The thesis's filter, with gravity cancelled, is a thousand times worse, and its covariance
  // shows it.
  const auto thesis = [](const RunErrors& run) { return std::optional(run.roll->filtered.end); };
  EXPECT_NEAR(rms_over(runs, thesis)->value, runs.front().roll->filtered.end_std, 0.06);
  const auto smoother = [](const RunErrors& run) {
    return std::optional(run.roll->smoothed.rms / run.roll->filtered.rms - 1.0);
  };
  EXPECT_LT(rms_over(runs, smoother)->value, 0.01);
}

// Misalignment is not observable by accelerometers on the wheel; it affects the angle, not the
// rotation since the start.
TEST(WheelModel, WithDatasheetErrorsItsBandHoldsForTheWayAndNotForThePlace) {
  const std::vector<RunErrors> runs = forty_runs(true);
  EXPECT_LT(inside(runs, &RunErrors::wheel_smoothed), 20U);
  EXPECT_GE(inside(runs, &RunErrors::wheel_moved), 34U);
}

// Scale errors of 10 % make the first predictions wrong by many times the noise.
TEST(WheelModel, FollowsEveryRunWithDatasheetErrors) {
  for (const double rpm : {16.0, 21.0})
    for (std::uint64_t seed = 1; seed <= 50; ++seed) {
      const RigRun run{.seed = seed,
                       .speed_radps = rpm * radps_per_rpm,
                       .turns = 1.25,
                       .datasheet_errors = true};
      const FirstTurn turn = first_turn(run, simulate_wheel(run).value());
      const RunErrors errors = run_errors(turn, Detail::tangential).value();
      EXPECT_LT(std::abs(errors.wheel_moved->end), 0.5e-3) << rpm << " rpm, seed " << seed;
    }
}

TEST(RmsOver, HasTheScatterOfTheSquaresBehindIt) {
  std::vector<RunErrors> runs(4);
  const std::array ends{1.0, -1.0, 1.0, -1.0};
  for (std::size_t k = 0; k < 4; ++k) runs[k].wheel_moved = PathError{.end = ends[k]};
  const Pick end = [](const RunErrors& run) -> std::optional<double> {
    return run.wheel_moved ? std::optional(run.wheel_moved->end) : std::nullopt;
  };
  EXPECT_DOUBLE_EQ(rms_over(runs, end)->value, 1.0);
  EXPECT_DOUBLE_EQ(rms_over(runs, end)->std, 0.0);
  runs[0].wheel_moved.reset();
  EXPECT_FALSE(rms_over(runs, end));
}

}  // namespace
}  // namespace proofmass::thesis::wheel_runs_test
