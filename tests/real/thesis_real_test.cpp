// The thesis's static test on recordings without warm-up: a static ADIS16405 (100 Hz, 10 000 s)
// whose bias changes in steps, and a minute after the power-up of an MPU-9250 (180 Hz).
#include <algorithm>
#include <filesystem>
#include <gtest/gtest.h>
#include <string>
#include <utility>
#include <vector>

#include "proofmass/io/read_recording.hpp"
#include "proofmass/signal/even_grid.hpp"
#include "proofmass/thesis/static_bias.hpp"
#include "published_data.hpp"

namespace proofmass::thesis_real_test {
namespace {

using thesis::Finding;
using thesis::Item;
using thesis::StaticAxis;

const Item& item_of(const std::vector<Item>& items, const std::string& id) {
  const auto found = std::ranges::find(items, id, &Item::id);
  EXPECT_NE(found, items.end()) << id;
  return found == items.end() ? items.front() : *found;
}

const Finding& finding_of(const Item& item, const std::string& key) {
  const auto found = std::ranges::find(item.findings, key, &Finding::key);
  EXPECT_NE(found, item.findings.end()) << key;
  return found == item.findings.end() ? item.findings.front() : *found;
}

std::vector<StaticAxis> axes_of(const Recording& recording) {
  std::vector<StaticAxis> axes;
  for (const Channel& channel : recording.channels) {
    if (channel.unit.quantity != Quantity::acceleration) continue;
    axes.push_back({.name = channel.name, .accel_mps2 = channel.values.copy()});
    for (double& value : axes.back().accel_mps2) value *= standard_gravity_mps2;
  }
  return axes;
}

/// Neither a1 nor T nor the settled bias has a value; the initial bias has one, that of the drift
/// analysis of the second axis.
void expect_no_warm_up(const thesis::StaticTest& test) {
  const std::vector<Item> items = thesis::static_items(test);
  const Item& fit = item_of(items, "table 4.1");
  for (const char* key : {"a1", "time_constant", "settled"}) {
    EXPECT_FALSE(finding_of(fit, key).ours.has_value()) << key;
    EXPECT_FALSE(finding_of(fit, key).reason.empty()) << key;
  }
  const Finding& a2 = finding_of(fit, "a2");
  ASSERT_TRUE(a2.ours && test.axes[1].drift);
  EXPECT_EQ(a2.ours->value, test.axes[1].drift->fit.a2.value);
  for (const Item& item : items)
    for (const Finding& finding : item.findings)
      EXPECT_EQ(finding.ours.has_value(), finding.reason.empty()) << item.id << ' ' << finding.key;
}

TEST(StaticItemsOfPublishedData, TellNoWarmUpOfABiasThatMovesBySteps) {
  const auto file = published_data() / "adis16405-static" / "adis16405_run1_acc_g.csv.xz";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << absent(file);
  constexpr double rate_hz = 100.0;
  const Recording recording = io::read_recording(file.string(), {.rate_hz = rate_hz}).value();
  auto record = thesis::static_record(file.string(), rate_hz, 0.0, axes_of(recording));
  ASSERT_EQ(record.axes.size(), 3U);
  const auto test = thesis::analyse_static(std::move(record), {});
  ASSERT_TRUE(test) << test.error().message;
  for (const thesis::AxisTest& axis : test->axes) {
    ASSERT_TRUE(axis.drift.has_value());
    EXPECT_EQ(axis.drift->fit.why, characterise::DriftReason::steps);
  }
  expect_no_warm_up(*test);
}

TEST(StaticItemsOfPublishedData, TellNoWarmUpOfAMinuteAfterAPowerUp) {
  const auto file = published_data() / "uca-mpu9250" / "start-up" / "start_up_data_1.csv.xz";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << absent(file);
  const Recording recording = io::read_recording(file.string(), {}).value();
  const auto grid = signal::even_grid(recording.time, recording.samples()).value();
  std::vector<StaticAxis> axes = axes_of(recording);
  ASSERT_EQ(axes.size(), 3U);
  for (StaticAxis& axis : axes)
    axis.accel_mps2 = signal::on_even_grid(axis.accel_mps2, grid).take();
  const auto test = thesis::analyse_static(
      thesis::static_record(file.string(), grid.rate_hz, 0.0, std::move(axes)), {});
  ASSERT_TRUE(test) << test.error().message;
  expect_no_warm_up(*test);
}

}  // namespace
}  // namespace proofmass::thesis_real_test
