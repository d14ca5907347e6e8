#include "proofmass/serve/live/monitor.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>
#include <string>
#include <thread>
#include <vector>

namespace proofmass::serve::live_monitor_test {
namespace {

using nlohmann::json;

constexpr double rate_hz = 100.0;

Recording head_of_one_channel(double rate = rate_hz) {
  Recording head;
  head.source = "test";
  head.time.source = TimeSource::stamps;
  head.time.rate_hz = rate;
  head.channels = {{"x", *parse_unit("m/s^2"), {}}};
  return head;
}

// A second of samples from `first` on, shifted in time.
void add_second(LiveMonitor& monitor,
                std::size_t first,
                double shift_s,
                const std::function<double(double t)>& value) {
  std::vector<double> t, x;
  for (std::size_t k = first; k < first + 100; ++k) {
    t.push_back(static_cast<double>(k) / rate_hz + shift_s);
    x.push_back(value(t.back()));
  }
  monitor.add({first, {x}, t});
}

// The first line of this kind for which a condition holds.
template <class Condition>
json wait_for(LiveMonitor& monitor, const char* kind, Condition holds) {
  for (int k = 0; k < 6000; ++k) {
    for (const std::string& line : monitor.take()) {
      const json found = json::parse(line);
      if (found.contains(kind) && holds(found[kind])) return found[kind];
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  ADD_FAILURE() << "no line " << kind;
  return {};
}

TEST(LiveMonitor, CharacterisesAllSamplesSoFarAndStartsAnewAfterALongGap) {
  LiveMonitor monitor(head_of_one_channel());
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  const auto noise = [&](double) { return normal(random); };
  for (std::size_t s = 0; s < 60; ++s) add_second(monitor, 100 * s, 0.0, noise);
  const json first =
      wait_for(monitor, "noise", [](const json& one) { return one["seconds"] > 59.0; });
  EXPECT_EQ(first["channel"], 0);
  EXPECT_FALSE(first["page"]["sections"].empty());
  // 999 samples are missing, then 1500.
  for (std::size_t s = 60; s < 70; ++s) add_second(monitor, 100 * s, 9.99, noise);
  (void)wait_for(monitor, "noise", [](const json& one) { return one["seconds"] > 79.0; });
  for (std::size_t s = 70; s < 100; ++s) add_second(monitor, 100 * s, 24.99, noise);
  const json anew =
      wait_for(monitor, "noise", [](const json& one) { return one["seconds"] < 31.0; });
  EXPECT_NEAR(anew["seconds"].get<double>(), 29.99, 0.01);
}

// Otherwise the memory would grow for as long as a source is watched.
TEST(LiveMonitor, StartsTheNoiseAnewAfterSoManySamples) {
  LiveMonitor monitor(head_of_one_channel(), 2000);
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  const auto noise = [&](double) { return normal(random); };
  for (std::size_t s = 0; s < 30; ++s) add_second(monitor, 100 * s, 0.0, noise);
  const json anew =
      wait_for(monitor, "noise", [](const json& one) { return one["seconds"] < 10.0; });
  EXPECT_NEAR(anew["seconds"].get<double>(), 8.99, 0.01);
}

TEST(LiveMonitor, CountsClippedSamplesAndMeasuresTheJitter) {
  LiveMonitor monitor(head_of_one_channel());
  std::size_t clipped = 0;
  const auto limited = [&](double t) {
    const double value = 3.0 * std::sin(2.0 * std::numbers::pi * 0.7 * t);
    clipped += std::abs(value) > 2.0 ? 1 : 0;
    return std::clamp(value, -2.0, 2.0);
  };
  for (std::size_t s = 0; s < 6; ++s) add_second(monitor, 100 * s, 0.0, limited);
  const json audit = wait_for(monitor, "audit", [](const json&) { return true; });
  const auto counted = audit["channels"][0]["clipped"].get<double>();
  // Five seconds are over with the sixth.
  EXPECT_NEAR(counted, static_cast<double>(clipped), 0.02 * static_cast<double>(clipped));
  EXPECT_LT(audit["jitter_s"].get<double>(), 1e-9);
}

}  // namespace
}  // namespace proofmass::serve::live_monitor_test
