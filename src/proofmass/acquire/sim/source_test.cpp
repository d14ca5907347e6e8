#include "proofmass/acquire/source.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <optional>
#include <string>
#include <unistd.h>
#include <vector>

#include "proofmass/simulate/procedure.hpp"
#include "proofmass/simulate/rig.hpp"
#include "proofmass/simulate/rig_file.hpp"

namespace proofmass::acquire::sim_source_test {
namespace {

using std::chrono::milliseconds;
using Columns = std::vector<std::vector<double>>;
constexpr milliseconds patient{60'000};

std::unique_ptr<Source> opened(const std::string& uri) {
  return open_source(uri).value();
}

/// Everything received until the end, or until an error.
struct Taken {
  Columns channels;
  std::vector<std::int64_t> device_ns;
  std::vector<std::uint64_t> lost_before;  ///< per row
  std::uint64_t lost = 0;
  std::size_t longest = 0;  ///< longest read, in rows
  /// Number of rows before each read that returned nothing.
  std::vector<std::size_t> waits;
  std::optional<Error> error{};
};

void append(const Arrival& arrival, Taken& taken) {
  taken.channels.resize(arrival.channels.size());
  for (std::size_t c = 0; c < arrival.channels.size(); ++c)
    taken.channels[c].insert(taken.channels[c].end(), arrival.channels[c].begin(),
                             arrival.channels[c].end());
  taken.lost_before.resize(taken.device_ns.size() + arrival.rows());
  taken.lost_before[taken.device_ns.size()] = arrival.lost_before;
  taken.device_ns.insert(taken.device_ns.end(), arrival.device_ns.begin(), arrival.device_ns.end());
  taken.lost += arrival.lost_before;
  taken.longest = std::max(taken.longest, arrival.rows());
}

Taken taken_of(Source& source, milliseconds patience = patient) {
  Taken taken;
  Arrival arrival;
  while (true) {
    const auto arrived = source.read(arrival, patience);
    if (!arrived) {
      taken.error = arrived.error();
      return taken;
    }
    if (*arrived == Arrived::ended) return taken;
    if (*arrived == Arrived::rows)
      append(arrival, taken);
    else
      taken.waits.push_back(taken.device_ns.size());
  }
}

Taken taken_of(const std::string& uri) {
  return taken_of(*opened(uri));
}

/// The first rows of a simulated rig.
Columns rig_rows(simulate::RigOptions options, double seconds) {
  options.wheel.profile.back().duration_s = seconds;
  Columns columns;
  for (Channel& channel : simulate::simulate_rig(options).value().recording.channels)
    columns.push_back(std::move(channel.values).take());
  return columns;
}

std::string refusal(const std::string& uri) {
  const auto source = open_source(uri);
  EXPECT_FALSE(source) << uri;
  return source ? "" : source.error().message;
}

TEST(SimSource, IsTheSimulatedRigToTheLastBit) {
  const Taken taken = taken_of("sim:wheel?seconds=5&speed=max&seed=7&rate=333");
  simulate::RigOptions options;
  options.seed = 7;
  options.rate_hz = 333.0;
  EXPECT_EQ(taken.channels, rig_rows(options, 5.0));
}

TEST(SimSource, IsTheThesissWheelUnlessToldOtherwise) {
  const auto source = opened("sim:");
  const SourceHead& head = source->head();
  EXPECT_EQ(head.recording.source, "sim:");
  EXPECT_EQ(head.recording.time.rate_hz, 200.0);
  ASSERT_EQ(head.recording.channels.size(), 6U);
  EXPECT_EQ(head.recording.channels[5].name, "acc2_z");
  EXPECT_EQ(head.recording.channels[5].unit, parse_unit("m/s^2").value());
  EXPECT_TRUE(head.is_paced);
  EXPECT_TRUE(head.has_device_clock);
  EXPECT_FALSE(opened("sim:?speed=max")->head().is_paced);
  EXPECT_FALSE(opened("sim:?speed=2")->head().is_paced) << "its clock is not the host's";
}

TEST(SimSource, AMinuteOfSixChannelsAtAKilohertzArrivesWhole) {
  const Taken taken = taken_of("sim:wheel?rate=1000&seconds=60&speed=max");
  ASSERT_EQ(taken.device_ns.size(), 60'000U);
  EXPECT_EQ(taken.lost, 0U);
  EXPECT_LE(taken.longest, 100U);
  for (std::size_t k = 0; k < taken.device_ns.size(); ++k)
    ASSERT_EQ(taken.device_ns[k], static_cast<std::int64_t>(k) * 1'000'000);
  for (const std::vector<double>& channel : taken.channels) EXPECT_EQ(channel.size(), 60'000U);
}

TEST(SimSource, KeepsItsSpeedForAsLongAsItIsAsked) {
  simulate::RigOptions options;
  options.wheel.profile.front().speed_radps = 30.0 * radps_per_rpm;
  EXPECT_EQ(taken_of("sim:wheel?rpm=30&seconds=120&speed=max").channels, rig_rows(options, 120.0));
}

TEST(SimSource, HasAsManySensorsAndAxesAsAskedFor) {
  const auto source = opened("sim:wheel?sensors=4&axes=2&rate=48000&output=voltage");
  const std::vector<Channel>& channels = source->head().recording.channels;
  ASSERT_EQ(channels.size(), 8U);
  EXPECT_EQ(channels.back().name, "acc4_y");
  EXPECT_EQ(channels.back().unit.quantity, Quantity::voltage);
}

TEST(SimSource, ItsSensorsStandEvenlyAboutTheAxle) {
  EXPECT_EQ(taken_of("sim:wheel?seconds=1&speed=max&sensors=2").channels,
            taken_of("sim:wheel?seconds=1&speed=max").channels);
}

TEST(SimSource, InCountsHasAConverter) {
  const Taken taken = taken_of("sim:static?seconds=1&speed=max&output=counts");
  ASSERT_EQ(taken.channels.size(), 3U);
  for (const double count : taken.channels[1]) {
    ASSERT_EQ(count, std::round(count));
    ASSERT_GT(count, 32768.0);  // gravity along y, zero at half of 16 bits
  }
}

TEST(SimSource, AtRestReadsGravity) {
  const Taken taken = taken_of("sim:static?seconds=10&speed=max");
  double sum = 0.0;
  for (const double y : taken.channels[1]) sum += y;
  // Bias within 0.3 and warm-up within 0.1 m/s² of it.
  EXPECT_NEAR(sum / static_cast<double>(taken.channels[1].size()), standard_gravity_mps2, 0.41);
}

TEST(SimSource, IsTheRigThatAFileDescribes) {
  const std::string path =
      testing::TempDir() + "sim_source_test." + std::to_string(::getpid()) + ".toml";
  simulate::RigOptions options;
  options.axes = 2;
  options.sensors.resize(1);
  options.sensors[0].radius_m = 0.25;
  std::ofstream(path) << simulate::format_rig_file(options);
  const Taken taken = taken_of("sim:wheel?speed=max&seconds=1&file=" + path);
  EXPECT_EQ(taken.channels, rig_rows(options, 1.0));
  EXPECT_NE(refusal("sim:wheel?axes=3&file=" + path).find("are given in the rig's file"),
            std::string::npos);
  std::filesystem::remove(path);
}

TEST(SimSource, PlaysAProcedureAndEnds) {
  const auto source = opened("sim:slide?speed=max&seed=3");
  EXPECT_EQ(source->head().recording.samples(), 0U);
  const Taken taken = taken_of(*source);
  simulate::ProcedureOptions options = simulate::default_options(simulate::Procedure::slide);
  options.seed = 3;
  const Recording whole = simulate::simulate_procedure(options).value().recording;
  ASSERT_EQ(taken.channels.size(), whole.channels.size());
  for (std::size_t c = 0; c < whole.channels.size(); ++c)
    EXPECT_EQ(taken.channels[c], whole.channels[c].values);
  EXPECT_EQ(taken_of("sim:tumble?speed=max&seconds=2").device_ns.size(), 200U);
}

TEST(SimSource, NeverBringsARowBeforeItsTime) {
  const auto source = opened("sim:wheel?seconds=2&speed=20");
  Arrival arrival;
  std::int64_t first_ns = 0;
  for (std::size_t rows = 0; rows < 400;) {
    const std::int64_t asked_ns = host_now_ns();
    if (first_ns == 0) first_ns = asked_ns;
    if (source->read(arrival, milliseconds(5)).value() == Arrived::nothing) continue;
    rows += arrival.rows();
    EXPECT_GE(host_now_ns() - first_ns, arrival.device_ns.back() / 20);
    EXPECT_GE(arrival.host_ns, asked_ns);
    EXPECT_LE(arrival.rows(), 20U);
  }
  EXPECT_EQ(source->read(arrival, patient).value(), Arrived::ended);
}

TEST(SimSource, ComesInBlocks) {
  const auto source = opened("sim:wheel?rate=100&block=25&speed=max&seconds=0.6");
  Arrival arrival;
  for (const std::size_t rows : {25, 25, 10}) {
    ASSERT_EQ(source->read(arrival, patient).value(), Arrived::rows);
    EXPECT_EQ(arrival.rows(), rows);
  }
}

TEST(SimSource, KeepsTheMemoryOfAnArrival) {
  const auto source = opened("sim:wheel?rate=1000&speed=max");
  Arrival arrival;
  ASSERT_TRUE(source->read(arrival, patient));
  const double* const before = arrival.channels[3].data();
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(source->read(arrival, patient));
  EXPECT_EQ(arrival.channels[3].data(), before);
}

TEST(SimFaults, ADroppedBlockIsCountedAndItsRowsAreMissing) {
  const Taken taken = taken_of("sim:wheel?rate=1000&seconds=20&speed=max&drop=0.2&block=10");
  simulate::RigOptions options;
  options.rate_hz = 1000.0;
  const Columns whole = rig_rows(options, 20.0);
  std::uint64_t row = 0;
  for (std::size_t k = 0; k < taken.device_ns.size(); ++k, ++row) {
    ASSERT_EQ(taken.lost_before[k] % 10, 0U);
    row += taken.lost_before[k];
    ASSERT_EQ(taken.device_ns[k], static_cast<std::int64_t>(row) * 1'000'000);
    ASSERT_EQ(taken.channels[4][k], whole[4][row]);
  }
  // 2000 blocks: five standard deviations of a binomial count.
  EXPECT_NEAR(static_cast<double>(taken.lost), 4000.0, 10.0 * 5.0 * std::sqrt(2000.0 * 0.2 * 0.8));
}

TEST(SimFaults, WhatWasMeasuredInAStallComesLater) {
  const std::int64_t began_ns = host_now_ns();
  const auto source = opened("sim:wheel?rate=1000&seconds=2&speed=max&stall=1.0045,0.05");
  const Taken taken = taken_of(*source, milliseconds(1));
  ASSERT_FALSE(taken.waits.empty());
  EXPECT_EQ(taken.waits.front(), 1005U);
  EXPECT_EQ(taken.waits.back(), 1005U);
  EXPECT_GE(host_now_ns() - began_ns, 50'000'000);
  EXPECT_EQ(taken.device_ns.size(), 2000U);
  EXPECT_EQ(taken.lost, 0U);
}

TEST(SimFaults, UnpluggedItIsGoneForGood) {
  const auto source = opened("sim:wheel?rate=1000&speed=max&unplug=0.5004");
  const Taken taken = taken_of(*source);
  ASSERT_TRUE(taken.error);
  EXPECT_EQ(taken.error->code, Errc::device);
  EXPECT_EQ(taken.error->message, "disconnected after 0.5004 s, as requested by unplug=");
  EXPECT_EQ(taken.device_ns.size(), 501U);
  EXPECT_TRUE(taken_of(*source).error);
}

TEST(SimFaults, ItsClockJumps) {
  const Taken taken = taken_of("sim:wheel?rate=100&speed=max&seconds=2&clock-jump=1,-0.5");
  ASSERT_EQ(taken.device_ns.size(), 200U);
  EXPECT_EQ(taken.device_ns[99], 990'000'000);
  EXPECT_EQ(taken.device_ns[100], 500'000'000);
  EXPECT_EQ(taken.device_ns[199], 1'490'000'000);
}

TEST(SimFaults, ItsClockDoesNotMove) {
  const Taken taken = taken_of("sim:wheel?speed=max&seconds=1&dead-clock=1");
  EXPECT_EQ(taken.device_ns, std::vector<std::int64_t>(200, 0));
}

TEST(SimFaults, StandInTheSettingsOfTheRecording) {
  const auto source = opened("sim:wheel?drop=0.5&unplug=9");
  const auto& settings = source->head().settings;
  const auto has = [&](const std::string& name, const std::string& value) {
    return std::ranges::find(settings, std::pair(name, value)) != settings.end();
  };
  EXPECT_TRUE(has("fault drop", "0.5"));
  EXPECT_TRUE(has("fault unplug", "9"));
  EXPECT_TRUE(has("rate", "200 Hz"));
}

TEST(SimSource, SaysWhatIsWrongWithASetting) {
  EXPECT_EQ(refusal("sim:whell"),
            "sim:whell: whell: expected wheel, static, tumble, four-position, six-position, "
            "multi-position or slide");
  EXPECT_EQ(refusal("sim:wheel?speed=fast"),
            "sim:wheel?speed=fast: speed=fast: expected a number above 0, or max");
  EXPECT_EQ(refusal("sim:wheel?axes=4"),
            "sim:wheel?axes=4: axes=4: expected a whole number from 2 to 3");
  EXPECT_EQ(refusal("sim:wheel?output=mV"),
            "sim:wheel?output=mV: output=mV: expected acceleration, voltage or counts");
  EXPECT_NE(refusal("sim:wheel?file=/no/such.toml").find("/no/such.toml"), std::string::npos);
  EXPECT_NE(refusal("sim:slide?rpm=11").find("rpm: no such setting"), std::string::npos);
  EXPECT_NE(refusal("sim:static?rpm=11").find("rpm: no such setting"), std::string::npos);
  for (const char* bad :
       {"rate=0", "sensors=0", "sensors=10", "seed=-1", "seconds=0", "block=0", "drop=1", "drop=-1",
        "stall=5", "stall=5,0", "stall=5,x", "stall=-1,1", "unplug=soon", "clock-jump=1",
        "clock-jump=1,1e10", "clock-jump=1,nan", "dead-clock=2", "rpm=x", "rpm=1e7"})
    EXPECT_FALSE(open_source(std::string("sim:wheel?") + bad)) << bad;
}

TEST(SimSource, IsFound) {
  for (const SourceKind& kind : source_kinds()) {
    if (kind.scheme != "sim") continue;
    const auto found = kind.find({}).value();
    ASSERT_EQ(found.size(), 1U);
    EXPECT_TRUE(open_source(found.front().uri));
    return;
  }
  FAIL() << "no kind of source is sim:";
}

}  // namespace
}  // namespace proofmass::acquire::sim_source_test
